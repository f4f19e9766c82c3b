//! Figures about a motion among moving obstacles, and its waits.

use serde::Serialize;

/// Figures about a motion among moving obstacles.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Timing {
    /// Number of moving obstacles. In a task, it includes objects that move until they are picked.
    pub obstacles: usize,
    /// Number of paths that were tried.
    pub ways: usize,
    /// Places and times at which the arm waits.
    pub waits: Vec<Wait>,
    /// Proven lower bound on the distance to moving obstacles, metres. `None` if none can meet the arm.
    pub clearance: Option<f64>,
    /// Time until which the arm may stay at the goal, seconds. `None` if it may stay for ever.
    pub free_until: Option<f64>,
}

/// A wait of the arm during a motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Wait {
    /// Beginning of the wait, in seconds since the start.
    pub from: f64,
    /// End of the wait, in seconds since the start.
    pub to: f64,
    /// Configuration of the arm during the wait.
    pub at: [f64; 2],
}
