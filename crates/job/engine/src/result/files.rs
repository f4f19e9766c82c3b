//! The result in file formats.

use super::Messages;
use crate::plan::{Plan, joints_in_messages};
use cplan_handling::{Driver, RobotJoint};
use cplan_motion::{Format, JointMotion, Trajectory, csv, csv_of_joints, ros_yaml};
#[cfg(feature = "mcap")]
use cplan_motion::{Stage, mcap};

impl Plan {
    /// Returns the result as a file in this format. `None` if the format has only a trajectory, but there is no motion. All
    /// formats except MCAP are text in UTF-8.
    ///
    /// The table of a task has a column with the number of each sample's step, counted from 1 in the order of execution. If the
    /// tool has joints, the table has all joints. A ROS 2 message has the whole motion. A recording has a message for each step:
    /// its motion, then the turns of the wrist and the strokes of the tool. It lacks a scene to display; see `PlanOutput::bytes`
    /// of the crate `view` for one with a scene.
    pub fn encoded(&self, format: Format) -> Option<Vec<u8>> {
        Some(match format {
            Format::Json => self.to_json().into_bytes(),
            Format::Csv if self.moves_tool() => {
                let Messages { whole, steps } = self.messages()?;
                let step = |time: &f64| steps.partition_point(|(begin, _)| begin <= time);
                let steps: Vec<usize> = whole.time.iter().map(step).collect();
                csv_of_joints(&whole, &self.motors_of(&whole), Some(&steps)).into_bytes()
            }
            Format::Csv => {
                let motion = self.task().and_then(|(_, answer)| answer.outcome.found());
                let steps: Option<Vec<usize>> =
                    motion.map(|motion| motion.sequence.steps().into_iter().map(|step| step + 1).collect());
                self.table(self.trajectory()?, steps.as_deref()).into_bytes()
            }
            Format::Yaml => ros_yaml(&self.messages()?.whole).into_bytes(),
            #[cfg(feature = "mcap")]
            Format::Mcap => self.recording(None)?,
        })
    }

    /// Returns the result as a recording. With `stage`, it includes the scene to display.
    #[cfg(feature = "mcap")]
    pub fn recording(&self, stage: Option<&Stage>) -> Option<Vec<u8>> {
        let steps = self.messages()?.steps;
        Some(mcap(&steps.iter().map(|(begin, motion)| (motion, *begin)).collect::<Vec<_>>(), stage))
    }

    /// Returns the motion of each step of a task as a separate file, without waits, with times from the beginning of the motion.
    /// `None` for a single motion, and for formats that cannot contain single trajectories.
    pub fn encoded_per_step(&self, format: Format) -> Option<Vec<Vec<u8>>> {
        let (_, answer) = self.task()?;
        let text: Vec<String> = match format {
            Format::Csv if self.moves_tool() => {
                let motions = self.messages()?.steps.into_iter().zip(1..);
                motions
                    .map(|((_, motion), number)| {
                        csv_of_joints(&motion, &self.motors_of(&motion), Some(&vec![number; motion.time.len()]))
                    })
                    .collect()
            }
            Format::Csv => {
                let motions = answer.legs.iter().map(|leg| &leg.timed.trajectory).zip(1..);
                motions.map(|(motion, number)| self.table(motion, Some(&vec![number; motion.time.len()]))).collect()
            }
            Format::Yaml => self.messages()?.steps.iter().map(|(_, motion)| ros_yaml(motion)).collect(),
            _ => return None,
        };
        Some(text.into_iter().map(String::into_bytes).collect())
    }

    /// Returns the motion of all joints, without accelerations. `None` unless it is a task whose tool has joints.
    pub(super) fn motion_with_tool(&self) -> Option<JointMotion> {
        if !self.moves_tool() {
            return None;
        }
        Some(self.messages()?.whole.without_accelerations())
    }

    /// Returns true if the motion is that of a task, and the tool has joints of its own.
    fn moves_tool(&self) -> bool {
        let is_tool = |joint: &RobotJoint| matches!(joint.driver, Driver::Stroke | Driver::Wrist);
        self.task().is_some() && self.problem().robot().joints.joints.iter().any(is_tool)
    }

    /// Returns a motion as a table. `steps`, if given, has the number of each sample's step.
    fn table(&self, motion: &Trajectory, steps: Option<&[usize]>) -> String {
        let joints = self.arm().joints.each_ref().map(|joint| joint.name.clone());
        let motors = self.arm().motor_angles(&motion.position);
        csv(&joints, motion, &motors, self.options().accelerations, steps)
    }

    /// Returns the angles of both motors' shafts at the samples of a motion of all joints. Empty if the motors are unknown.
    fn motors_of(&self, motion: &JointMotion) -> Vec<[f64; 2]> {
        let column = |k: usize| motion.joints.iter().position(|name| *name == self.arm().joints[k].name);
        let (Some(first), Some(second)) = (column(0), column(1)) else { return Vec::new() };
        let positions: Vec<[f64; 2]> = motion.position.iter().map(|row| [row[first], row[second]]).collect();
        self.arm().motor_angles(&positions)
    }

    /// Returns the content of ROS messages. A single motion counts as one step.
    fn messages(&self) -> Option<Messages> {
        let robot = joints_in_messages(self.problem(), self.options());
        let messages = match self.task() {
            None => {
                let whole = JointMotion::new(&robot, self.trajectory()?, true);
                Messages { steps: vec![(0.0, whole.clone())], whole }
            }
            // Planning refuses joints that messages cannot name.
            Some((task, answer)) => {
                Messages::new(&robot, task, &answer.legs, &answer.outcome.found()?.sequence).ok()?
            }
        };
        Some(if self.options().accelerations { messages } else { messages.without_accelerations() })
    }
}
