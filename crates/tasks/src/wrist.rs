//! The turn of the wrist to a value of its joint, with an empty gripper.

use super::least_time::least_of_tool;
use cplan_handling::Wrist;
use cplan_motion::single;

/// A turn of the wrist from the start to the goal of a task with a single move. The shapes that the wrist turns count as
/// the discs that they sweep, so it may turn at any time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristMotion {
    /// Signed angle, radians.
    pub angle: f64,
    /// Time from the beginning of the task to that of the turn, in seconds.
    pub begin: f64,
    /// Duration, in seconds. The wrist turns with its fastest motion, or with that motion stretched evenly in time.
    pub seconds: f64,
    /// Time for which the arm and the tool wait at the end until the wrist is at rest, in seconds.
    pub waiting: f64,
}

impl WristMotion {
    /// Creates the turn for an arm that moves from `departure` to `arrival`, and a tool that is at rest from `end` on, all
    /// in seconds. The wrist turns while the arm moves. If it needs longer, it begins earlier, and then also ends later.
    pub(super) fn new(wrist: &Wrist, angle: f64, departure: f64, [arrival, end]: [f64; 2]) -> Self {
        let fastest = single(angle.abs(), &wrist.limits());
        let least = fastest.last().map_or(0.0, |[seconds, ..]| *seconds);
        let begin = (arrival - least).clamp(0.0, departure);
        let seconds = if angle == 0.0 { 0.0 } else { least.max(arrival - begin) };
        Self { angle, begin, seconds, waiting: (begin + seconds - end).max(0.0) }
    }
}

/// Returns a lower bound on the duration of a turn, in seconds.
pub(super) fn least_turn(wrist: &Wrist, angle: f64) -> f64 {
    least_of_tool(angle.abs(), &wrist.limits())
}
