//! The searches that companions bring: for tasks, and among moving obstacles. Plans have the data of their answers, and
//! the program states which searches it has.

use cplan_handling::{ObstacleTrajectory, Task};
use cplan_judge::CertifiedPath;
use cplan_legs::{TaskAnswer, TaskReplay};
use cplan_model::MotionProblem;
use cplan_motion::{BlockedTimes, TimedMotion, Timing, TimingError};
use cplan_solver::Options;

/// The searches beyond those for a single motion among obstacles that stand still.
#[derive(Debug, Clone, Copy)]
pub struct Searches {
    /// The search for tasks. Without it, tasks are refused.
    pub tasks: Option<TaskSearch>,
    /// The search among moving obstacles. Without it, single motions among them are refused.
    pub movers: Option<MoverSearch>,
}

impl Searches {
    /// No search: plans of single motions among obstacles that stand still.
    pub const NONE: Self = Self { tasks: None, movers: None };
}

/// A search for the motions of a task.
#[derive(Debug, Clone, Copy)]
pub struct TaskSearch {
    /// Plans a task. Passes lines of text about long computations.
    pub plan: fn(&Task, &Options, &mut dyn FnMut(&str)) -> TaskAnswer,
    /// Returns how the motions of an answer were found, with the same options. For tasks without moving obstacles.
    pub replay: fn(&Task, &Options, &TaskAnswer) -> TaskReplay,
}

/// A motion among moving obstacles with its figures, or the reason in words why there is none.
pub type MotionAmongMovers = Result<(TimedMotion, Timing), String>;

/// A search for motions among moving obstacles.
#[derive(Debug, Clone, Copy)]
pub struct MoverSearch {
    /// Returns the earliest motion along a certified path, or along others. The loose obstacles of the problem's scene
    /// follow the trajectories. The given motion is the one along the path without moving obstacles.
    pub plan: fn(
        &MotionProblem,
        &[ObstacleTrajectory],
        &CertifiedPath,
        TimedMotion,
        &Options,
    ) -> Result<MotionAmongMovers, TimingError>,
    /// Returns the times at which moving obstacles block places.
    pub blocked_times: BlockedTimes,
}
