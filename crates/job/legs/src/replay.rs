//! Replays: how the planner found each motion of a task.

use cplan_planners::planner::Trace;
use cplan_solver::Replay;

/// The replay of a task. A repeated motion occurs only once.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskReplay {
    /// The different motions.
    pub motions: Vec<MotionReplay>,
    /// For each leg in order, the index of its motion.
    pub legs: Vec<usize>,
}

/// The replay of one motion, with the planner's trace.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionReplay {
    /// The replay.
    pub replay: Replay,
    /// The trace of which the replay shows parts. `None` for a straight motion, which needs no search.
    pub trace: Option<Trace>,
}
