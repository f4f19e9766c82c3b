//! What tables and ROS 2 messages hold, on the command line.

use super::failure::Failure;
use crate::engine::task::{TaskAnswer, TaskReport};
use crate::input::LoadedTask;
use crate::model::RobotJoints;
use crate::motion::Report;
use clap::{Args, ValueEnum};

/// Joints that a message names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum NamedJoints {
    /// Every movable joint of the robot.
    All,
    /// The two that are planned for.
    Planned,
}

/// What tables and messages hold.
#[derive(Debug, Args)]
pub struct MessageArgs {
    /// Joints that ROS 2 files (.yaml, .mcap) name: "all" for every movable joint of the robot, "planned" for the two alone.
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = NamedJoints::All)]
    pub joints: NamedJoints,
    /// Write accelerations into .csv, .yaml and .mcap, too: controllers then join points by quintics instead of cubics.
    /// Refused where the acceleration jumps; limits on the jerk of both joints (--jerk) keep it from that.
    #[arg(long)]
    pub accelerations: bool,
}

impl MessageArgs {
    /// Puts what was asked for into a result.
    ///
    /// # Errors
    /// Accelerations that jump.
    pub fn apply(&self, report: &mut Report, robot: &RobotJoints) -> Result<(), Failure> {
        if self.joints == NamedJoints::All {
            report.robot = robot.clone();
        }
        report.accelerations = self.accelerations;
        match &report.trajectory {
            Some(trajectory) if self.accelerations => Ok(trajectory.check_accelerations()?),
            _ => Ok(()),
        }
    }

    /// The same for a task.
    ///
    /// # Errors
    /// Accelerations that jump, and a wrist that cannot keep up.
    pub fn apply_to_task(
        &self,
        report: &mut TaskReport,
        loaded: &LoadedTask,
        answer: &TaskAnswer,
    ) -> Result<(), Failure> {
        let task = &loaded.task;
        let planned = RobotJoints::planned(report.joints());
        let robot = if self.joints == NamedJoints::All { &loaded.robot.joints } else { &planned };
        Ok(report.name_joints(robot, task, answer, self.accelerations)?)
    }
}
