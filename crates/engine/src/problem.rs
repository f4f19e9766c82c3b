//! What is asked: a motion, or a sequence of steps, of a robot in a world.

use cplan_core::model::{Arm, MotionProblem, MotionProblemError, Scene, SceneError, Workspace};
use cplan_core::space::{Configuration, GoalSet};
use cplan_handling::{RobotJoints, Task};
use cplan_interrupt::Instant;
use cplan_robot::{InputError, RobotFile, RobotReport};
use cplan_world::{self, Loaded, LoadedScene, LoadedTask, Overrides};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use thiserror::Error;

/// A robot, its world, and what it is to do there: a motion from a start to a goal, or the steps of a task. Checked, and
/// cheap to clone. For serde it is its model; what is read is checked as what is made in code, and numbers keep all their bits.
#[derive(Debug, Clone)]
pub struct Problem {
    content: Arc<MotionOrTask>,
    robot: Arc<RobotReport>,
    notes: Arc<[String]>,
    /// Time that it took to read.
    read_in: Option<Duration>,
}

/// Why arm, workspace, start and goals make no problem.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProblemError {
    /// The arm or the workspace.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The start or a goal.
    #[error(transparent)]
    Ends(#[from] MotionProblemError),
}

/// A motion, or a task with the arm, empty-handed, among obstacles and objects where they lie initially.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "a problem shares one")]
pub(super) enum MotionOrTask {
    Motion(MotionProblem),
    Task(Task, Scene),
}

impl Problem {
    /// Reads a robot (URDF) and a world (TOML).
    ///
    /// # Errors
    /// Everything that is wrong with the files, with line, column and cure; a start or goal that is out of reach or not free.
    pub fn load(robot: impl Into<RobotFile>, world: impl AsRef<Path>) -> Result<Self, InputError> {
        Self::load_with(robot, world, &Overrides::default())
    }

    /// The same with start, goal and clearance in place of the world's.
    ///
    /// # Errors
    /// As [`Problem::load`].
    pub fn load_with(
        robot: impl Into<RobotFile>,
        world: impl AsRef<Path>,
        overrides: &Overrides,
    ) -> Result<Self, InputError> {
        let begun = Instant::now();
        let problem = Self::of_scene(cplan_world::load_scene(robot, world.as_ref())?, overrides)?;
        Ok(problem.read_since(begun))
    }

    /// What is asked in a scene that has been read.
    ///
    /// # Errors
    /// When start or goal is missing, out of reach or not free, or a step cannot be done by any arm like this.
    pub fn of_scene(loaded: LoadedScene, overrides: &Overrides) -> Result<Self, InputError> {
        Ok(if loaded.has_steps() { loaded.task(overrides)?.into() } else { loaded.problem(overrides)?.into() })
    }

    /// A motion of an arm in a workspace that are made in code, from `start` to any of `goals`.
    ///
    /// # Errors
    /// Arms and workspaces whose numbers make no sense; a start or goal outside the limits or not free.
    pub fn new(
        arm: Arm,
        workspace: Workspace,
        start: impl Into<Configuration>,
        goals: impl Into<GoalSet>,
    ) -> Result<Self, ProblemError> {
        let scene = Scene::new(arm, workspace)?;
        Ok(MotionProblem::new(scene, start.into(), goals)?.into())
    }

    /// The same, with the time since then as that of reading.
    #[must_use]
    pub fn read_since(self, begun: Instant) -> Self {
        Self { read_in: Some(begun.elapsed()), ..self }
    }

    /// Returns the motion or the task that is asked for.
    pub(super) fn content(&self) -> &MotionOrTask {
        &self.content
    }

    /// The time that reading the files took, if it was read from files.
    pub(crate) fn read_in(&self) -> Option<Duration> {
        self.read_in
    }

    /// The arm among its obstacles; of a task as they lie at first.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        match &*self.content {
            MotionOrTask::Motion(motion) => motion.scene(),
            MotionOrTask::Task(_, scene) => scene,
        }
    }

    /// The motion, if it is a single one.
    #[must_use]
    pub fn motion(&self) -> Option<&MotionProblem> {
        if let MotionOrTask::Motion(motion) = &*self.content { Some(motion) } else { None }
    }

    /// The task, if it is one.
    #[must_use]
    pub fn task(&self) -> Option<&Task> {
        if let MotionOrTask::Task(task, _) = &*self.content { Some(task) } else { None }
    }

    /// How the robot was read.
    #[must_use]
    pub fn robot(&self) -> &RobotReport {
        &self.robot
    }

    /// What the user should know of how the world was read: defaults taken, branches of a goal that are blocked.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(super) fn read(content: MotionOrTask, robot: RobotReport, notes: Vec<String>) -> Self {
        Self { content: Arc::new(content), robot: Arc::new(robot), notes: notes.into(), read_in: None }
    }
}

impl From<Loaded> for Problem {
    fn from(Loaded { problem, robot, notes }: Loaded) -> Self {
        Self::read(MotionOrTask::Motion(problem), robot, notes)
    }
}

impl From<LoadedTask> for Problem {
    fn from(LoadedTask { task, scene, robot, notes }: LoadedTask) -> Self {
        Self::read(MotionOrTask::Task(task, scene), robot, notes)
    }
}

impl From<MotionProblem> for Problem {
    /// Of an arm whose two joints are all that moves.
    fn from(motion: MotionProblem) -> Self {
        let names = motion.scene().arm().joints.each_ref().map(|joint| joint.name.clone());
        let robot = RobotReport { joints: RobotJoints::planned(&names), ..RobotReport::default() };
        Self::read(MotionOrTask::Motion(motion), robot, Vec::new())
    }
}
