//! Motions of the tool's own joints: strokes, turns of the wrist, and their overlap with the motion of the arm.

use cplan_handling::Wrist;
use cplan_motion::single;

/// A stroke of the tool. At a pick or a place, the tool is lowered, the gripper acts, and the tool is raised. At the end of a
/// move, it is only lowered; at the beginning of a motion, only raised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolStroke {
    /// The joint's value while the tool is raised, in metres.
    pub raised: f64,
    /// The joint's value while the tool is lowered, in metres.
    pub lowered: f64,
    /// Duration of the stroke down, in seconds, rounded to whole nanoseconds. The stroke up takes as long.
    pub seconds: f64,
    /// Proven lower bound on the distance to obstacles during the stroke, in metres. Infinite if no obstacle is within
    /// reach.
    pub clearance: f64,
}

/// The overlaps of a motion with the stroke up or the turn after the last step, and with the turn or the stroke down of the next
/// one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Time from the departure of the arm to the end of the raising, in seconds.
    pub raising: f64,
    /// Time from the beginning of the lowering to the arrival of the arm, in seconds.
    pub lowering: f64,
    /// Time from the departure of the arm to the end of the turn after a pick, in seconds. The tool is raised before the
    /// turn.
    pub turn_after_departure: f64,
    /// Time from the beginning of the turn before a place to the arrival of the arm, in seconds. The tool is lowered
    /// after the turn.
    pub turn_before_arrival: f64,
    /// Duration of the turn, in seconds, if it overlaps with the motion. It may be longer than at rest, because the wrist also
    /// compensates the rotation of link 2.
    pub turn_seconds: Option<f64>,
    /// Proven lower bound on the distance to obstacles during these overlaps, in metres. Infinite if no obstacle is within reach.
    pub clearance: f64,
}

impl Overlap {
    /// No overlap: the arm is at rest during strokes and turns.
    pub const NONE: Self = Self {
        raising: 0.0,
        lowering: 0.0,
        turn_after_departure: 0.0,
        turn_before_arrival: 0.0,
        turn_seconds: None,
        clearance: f64::INFINITY,
    };

    /// Returns the time from the departure of the arm to the end of the raising and the turn, in seconds.
    pub fn departure(&self) -> f64 {
        self.raising.max(self.turn_after_departure)
    }

    /// Returns the time from the beginning of the turn or the lowering to the arrival of the arm, in seconds.
    pub fn arrival(&self) -> f64 {
        self.lowering.max(self.turn_before_arrival)
    }

    /// Returns the sum of the overlaps at both ends of the motion, in seconds.
    pub fn seconds(&self) -> f64 {
        self.departure() + self.arrival()
    }
}

/// A turn of the wrist during a task with a single move, from start to goal. The shapes that the wrist turns count as the discs
/// that they sweep, so the wrist may turn at any time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristMotion {
    /// Signed angle, radians.
    pub angle: f64,
    /// Time from the beginning of the task to the beginning of the turn, in seconds.
    pub begin: f64,
    /// Duration, in seconds. The wrist turns with its fastest motion, or with that motion stretched evenly in time.
    pub seconds: f64,
    /// Time, in seconds, for which arm and tool wait at the end until the wrist is at rest.
    pub waiting: f64,
}

impl WristMotion {
    /// Creates the turn for an arm that moves from `departure` to `arrival`, and a tool that is at rest from `end` on, all in
    /// seconds. The wrist turns while the arm moves. If that time is too short, the turn begins before the departure, but not
    /// before time 0; it then ends after the arrival if necessary.
    pub fn new(wrist: &Wrist, angle: f64, departure: f64, [arrival, end]: [f64; 2]) -> Self {
        let fastest = single(angle.abs(), &wrist.limits());
        let least = fastest.last().map_or(0.0, |[seconds, ..]| *seconds);
        let begin = (arrival - least).clamp(0.0, departure);
        let seconds = if angle == 0.0 { 0.0 } else { least.max(arrival - begin) };
        Self { angle, begin, seconds, waiting: (begin + seconds - end).max(0.0) }
    }
}
