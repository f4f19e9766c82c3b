//! The searches that companion crates provide: for tasks, and among moving obstacles. Plans contain the data of their answers;
//! the program states which searches it has.

use cplan_geometry::Interval;
use cplan_handling::{ObstacleTrajectory, Task, TimedScene};
use cplan_judge::CertifiedPath;
use cplan_legs::{TaskAnswer, TaskReplay};
use cplan_model::MotionProblem;
use cplan_model::space::Configuration;
use cplan_motion::{TimedMotion, Timing, TimingError};
use cplan_solver::Options;
use std::fmt::Debug;

/// The searches other than that for a single motion among static obstacles.
#[derive(Debug, Clone, Copy)]
pub struct Searches {
    /// The search for tasks. Without it, tasks are refused.
    pub tasks: Option<&'static dyn TaskSearch>,
    /// The search among moving obstacles. Without it, single motions among them are refused.
    pub movers: Option<&'static dyn MoverSearch>,
}

impl Searches {
    /// No further searches: only single motions among static obstacles can be planned.
    pub const NONE: Self = Self { tasks: None, movers: None };
}

/// A search for the motions of a task.
pub trait TaskSearch: Debug + Sync {
    /// Plans a task. Passes lines of text about long computations.
    fn plan(&self, task: &Task, options: &Options, progress: &mut dyn FnMut(&str)) -> TaskAnswer;

    /// Returns how the motions of an answer, planned with the same options, were found. For tasks without moving obstacles.
    fn replay(&self, task: &Task, options: &Options, answer: &TaskAnswer) -> TaskReplay;
}

/// A motion among moving obstacles with its figures, or the reason, in words, why there is none.
pub type MotionAmongMovers = Result<(TimedMotion, Timing), String>;

/// A search for motions among moving obstacles.
pub trait MoverSearch: Debug + Sync {
    /// Returns the motion that arrives first, along a certified path or along other paths. The loose obstacles of the problem's
    /// scene follow the trajectories. `first` is the motion along the path without moving obstacles.
    ///
    /// # Errors
    /// A path that cannot be timed.
    fn plan(
        &self,
        problem: &MotionProblem,
        trajectories: &[ObstacleTrajectory],
        certified: &CertifiedPath,
        first: TimedMotion,
        options: &Options,
    ) -> Result<MotionAmongMovers, TimingError>;

    /// Returns the intervals of time, in seconds, during which moving obstacles block the arm: for each configuration, a list for
    /// each loose obstacle of the scene, ordered and disjoint. Less than the world's clearance counts as blocked.
    fn blocked_times(&self, timed: TimedScene, configurations: &[Configuration]) -> Vec<Vec<Vec<Interval>>>;
}
