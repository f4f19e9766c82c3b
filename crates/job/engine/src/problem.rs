//! Problems: a motion, or a sequence of steps, of a robot in a world.

use cplan_handling::{ObstacleTrajectory, RobotJoints, Task, TimedScene, TimedWorkspace};
use cplan_interrupt::Instant;
use cplan_model::space::{Configuration, GoalSet};
use cplan_model::{Arm, MotionProblem, MotionProblemError, Scene, SceneError};
use cplan_robot::{InputError, RobotFile, RobotReport};
use cplan_solver::Options;
use cplan_world::{self, AllowedErrors, LoadedProblem, LoadedScene, Overrides, Rules};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use thiserror::Error;

/// A robot, its world, and its task: a motion from a start to a goal, or a sequence of steps. A problem has been checked, and is
/// cheap to clone. Serde stores the objects of which it consists, not the files. Deserialised problems are checked like those
/// created in code, and their numbers keep all bits.
#[derive(Debug, Clone)]
pub struct Problem {
    /// Scene, start and goals. A task has no goals, and its objects are at their initial places.
    pub(super) query: Arc<MotionProblem>,
    /// The task. `None` for a single motion.
    pub(super) task: Option<Arc<Task>>,
    /// The trajectories of the scene's loose obstacles.
    trajectories: Arc<[ObstacleTrajectory]>,
    robot: Arc<RobotReport>,
    notes: Arc<[String]>,
    /// The errors for which the motion must be free. `None` without errors, and for a deserialised problem.
    errors: Option<AllowedErrors>,
    /// Time that reading the files took. `None` if the problem was created in code.
    read_in: Option<Duration>,
}

/// The reason why an arm, a workspace, a start and goals do not form a valid problem.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProblemError {
    /// The arm or the workspace is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The start or a goal is invalid.
    #[error(transparent)]
    Ends(#[from] MotionProblemError),
}

impl Problem {
    /// Reads a robot (URDF) and a world (TOML).
    ///
    /// # Errors
    /// All defects of the files, with line, column and hint; a start or goal that is out of reach or not free.
    pub fn load(robot: impl Into<RobotFile>, world: impl AsRef<Path>) -> Result<Self, InputError> {
        Self::load_with(robot, world, &Overrides::default())
    }

    /// Reads a robot and a world. Start, goal and clearance of `overrides` replace those of the world.
    ///
    /// # Errors
    /// The errors of [`Problem::load`].
    pub fn load_with(
        robot: impl Into<RobotFile>,
        world: impl AsRef<Path>,
        overrides: &Overrides,
    ) -> Result<Self, InputError> {
        let begun = Instant::now();
        let problem = Self::of_scene(cplan_world::load_scene(robot, world.as_ref())?, overrides)?;
        Ok(problem.read_since(begun))
    }

    /// Returns the problem of a scene that has been read.
    ///
    /// # Errors
    /// A start or goal that is missing, out of reach or not free, and a step that this kind of arm cannot perform.
    pub fn of_scene(loaded: LoadedScene, overrides: &Overrides) -> Result<Self, InputError> {
        Ok(loaded.resolve(overrides, Rules::Plan)?.into())
    }

    /// Creates the problem of moving an arm in a workspace from `start` to any of `goals`. Moving obstacles are at
    /// their places at time 0.
    ///
    /// # Errors
    /// Invalid numbers of the arm or the workspace, and a start or goal that is outside the limits or not free.
    pub fn new(
        arm: Arm,
        workspace: impl Into<TimedWorkspace>,
        start: impl Into<Configuration>,
        goals: impl Into<GoalSet>,
    ) -> Result<Self, ProblemError> {
        let workspace = workspace.into();
        let trajectories = workspace.trajectories();
        Ok(Self::of_motion(motion_among(workspace.scene(arm)?, &trajectories, start.into(), goals)?, trajectories))
    }

    /// Sets the time of reading to the time since `begun`.
    #[must_use]
    pub fn read_since(self, begun: Instant) -> Self {
        Self { read_in: Some(begun.elapsed()), ..self }
    }

    /// Returns the problem with the limits of these options.
    pub(super) fn with_limits(mut self, options: &Options) -> Self {
        options.override_limits(Arc::make_mut(&mut self.query).arm_mut());
        if let Some(task) = &mut self.task {
            options.override_limits(&mut Arc::make_mut(task).arm);
        }
        self
    }

    /// Returns the time that reading the files took. `None` if the problem was made in code.
    pub(crate) fn read_in(&self) -> Option<Duration> {
        self.read_in
    }

    /// Returns the arm among its obstacles. For a task, objects are at their initial places.
    pub fn scene(&self) -> &Scene {
        self.query.scene()
    }

    /// Returns scene, start and goals. A task has no goals, and its objects are at their initial places.
    pub fn query(&self) -> &MotionProblem {
        &self.query
    }

    /// Returns the problem of a single motion. `None` for a task.
    pub fn motion(&self) -> Option<&MotionProblem> {
        self.task.is_none().then_some(&self.query)
    }

    /// Returns the task. `None` for a single motion.
    pub fn task(&self) -> Option<&Task> {
        self.task.as_deref()
    }

    /// Returns the report on how the robot was read.
    pub fn robot(&self) -> &RobotReport {
        &self.robot
    }

    /// Returns notes for the user on how the world was read: defaults, and blocked IK solutions of the goal.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the errors of the robot and the world for which the motion must be free; `None` without errors.
    pub fn errors(&self) -> Option<&AllowedErrors> {
        self.errors.as_ref()
    }

    /// Returns the scene with the trajectories of its loose obstacles.
    pub fn timed(&self) -> TimedScene<'_> {
        TimedScene { scene: self.scene(), trajectories: &self.trajectories }
    }

    /// Creates the problem of a robot whose two joints are its only movable ones.
    fn of_motion(problem: MotionProblem, trajectories: Vec<ObstacleTrajectory>) -> Self {
        let names = problem.scene().arm().joints.each_ref().map(|joint| joint.name.clone());
        let robot = RobotReport { joints: RobotJoints::only_planned(&names), ..RobotReport::default() };
        let (stated_goals, notes) = (Vec::new(), Vec::new());
        LoadedProblem { problem, stated_goals, task: None, trajectories, robot, notes, errors: None }.into()
    }
}

/// Creates a motion problem among moving obstacles.
///
/// # Errors
/// The errors of [`MotionProblem::new`], and a moving obstacle at the start at time 0.
pub(super) fn motion_among(
    scene: Scene,
    trajectories: &[ObstacleTrajectory],
    start: Configuration,
    goals: impl Into<GoalSet>,
) -> Result<MotionProblem, MotionProblemError> {
    let problem = MotionProblem::new(scene, start, goals)?;
    let scene = problem.scene();
    match (TimedScene { scene, trajectories }).obstructions(start, 0.0).first() {
        Some(found) => Err(MotionProblemError::StartBlocked { why: scene.explain(found) }),
        None => Ok(problem),
    }
}

impl From<LoadedProblem> for Problem {
    fn from(LoadedProblem { problem, task, trajectories, robot, notes, errors, .. }: LoadedProblem) -> Self {
        let (query, task, robot) = (Arc::new(problem), task.map(Arc::new), Arc::new(robot));
        Self { query, task, trajectories: trajectories.into(), robot, notes: notes.into(), errors, read_in: None }
    }
}

impl From<MotionProblem> for Problem {
    /// Creates the problem of a robot whose two joints are its only movable ones, without loose obstacles.
    fn from(motion: MotionProblem) -> Self {
        Self::of_motion(motion, Vec::new())
    }
}
