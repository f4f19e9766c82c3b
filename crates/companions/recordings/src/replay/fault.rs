//! Differences between a recorded task and the requested one.

use cplan_model::Elbow;
use cplan_model::space::Configuration;
use cplan_text::{length, length_up};
use thiserror::Error;

/// A difference between a recorded step and the required one.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Fault {
    /// The first motion does not begin at the task's start.
    #[error("the motion does not begin at the start")]
    Start,
    /// A move of the joints ends elsewhere.
    #[error("the motion ends at ({}, {}), not at ({}, {})", is[0], is[1], target[0], target[1])]
    Joints {
        /// The recorded end.
        is: Configuration,
        /// The required end.
        target: Configuration,
    },
    /// The tip is not at its required place.
    #[error("the tip ends {} from its target", length(*off))]
    Tip {
        /// Distance of the tip from there, metres.
        off: f64,
    },
    /// The elbow is on the wrong side.
    #[error("the elbow is on the {}, not on the {}", elbow.other().name(), elbow.name())]
    Elbow {
        /// The required side.
        elbow: Elbow,
    },
    /// The tip is not proven to stay within the tolerance of the line.
    #[error("after sample {piece} of the step, the tip may be {} from the line, more than {}", length_up(*off), length(*tolerance))]
    Line {
        /// Upper bound on the distance of the tip from the line, metres.
        off: f64,
        /// The tolerance, metres.
        tolerance: f64,
        /// Index of the sample that precedes the part with this bound, counted from the step's first sample.
        piece: usize,
    },
    /// The tip is faster than the line allows.
    #[error("the tip moves along the line at {speed:.6} m/s, faster than {most} m/s")]
    LineSpeed {
        /// The greatest speed that was found, metres per second.
        speed: f64,
        /// The greatest allowed speed.
        most: f64,
    },
    /// The step does not state the motion of the wrist, although the tool must have an angle along the line.
    #[error(
        "the world requires an angle of the tool along the line, but the step does not state the motion of the wrist"
    )]
    NoWristMotion,
    /// The tool is not proven to keep the required angle along the line.
    #[error(
        "after sample {piece} of the step, the angle of the tool may be wrong by {off:.6} rad, more than {tolerance} rad"
    )]
    ToolAngle {
        /// Upper bound on the difference from the angle, radians.
        off: f64,
        /// The tolerance, radians.
        tolerance: f64,
        /// Index of the sample that precedes the part with this bound, counted from the step's first sample.
        piece: usize,
    },
    /// The wrist exceeds a limit along a line.
    #[error("after sample {sample} of the step, the wrist exceeds its {what}: {value:.6}, beyond {allowed}")]
    WristAlongLine {
        /// The limit, in words.
        what: &'static str,
        /// The value that exceeds the limit most, in radians and seconds.
        value: f64,
        /// The limit.
        allowed: f64,
        /// Index of the sample that precedes this value, counted from the step's first sample.
        sample: usize,
    },
    /// A moving object is picked at a time outside its window.
    #[error("the object is picked at {time:.6} s, outside its time window")]
    When {
        /// The recorded time, seconds.
        time: f64,
    },
    /// The placed object is not at its required place.
    #[error("the object's origin ends {} from its target", length(*off))]
    Origin {
        /// Distance of the placed object from its required place, metres.
        off: f64,
    },
    /// The placed object does not have its required orientation.
    #[error("the angle of the released object is wrong by {off:.6} rad")]
    Angle {
        /// The difference, radians.
        off: f64,
    },
    /// The arm rests for too short a time.
    #[error("the arm stands still for {stood:.6} s, not for {asked:.6} s")]
    Rest {
        /// The recorded rest, seconds.
        stood: f64,
        /// Rest that is required for the dwell, the turn of the wrist and the stroke of the tool.
        asked: f64,
    },
    /// The arm rests for too short a time before the step, while the tool is raised.
    #[error("the arm stands still for {stood:.6} s before the step, but raising the tool takes {asked:.6} s")]
    RestBefore {
        /// The recorded rest, seconds.
        stood: f64,
        /// The required rest, seconds.
        asked: f64,
    },
    /// For the lowered tool, the file and the world state different values of the stroke's joint.
    #[error("the tool is lowered to {} {when} the motion, not to {}", value(*is), value(*asked))]
    Lowered {
        /// The value in the file, metres; `None` without a stroke.
        is: Option<f64>,
        /// The value in the world; `None` without a stroke.
        asked: Option<f64>,
        /// `before` or `after`.
        when: &'static str,
    },
    /// The tool is raised at the beginning of the motion, but had not been lowered.
    #[error("the tool is raised during the motion, but was not lowered before")]
    NotLowered,
    /// The wrist turns to a value of its joint, but the step requires none.
    #[error("the wrist turns, but the step does not state the values of the wrist's joint")]
    WristElsewhere,
    /// The wrist does not turn to the required value of its joint.
    #[error("the wrist does not turn to {to} rad")]
    WristStays {
        /// The required value, radians.
        to: f64,
    },
    /// The wrist turns between wrong values of its joint.
    #[error("the wrist turns from {} to {} rad, not from {} to {} rad", is[0], is[1], asked[0], asked[1])]
    WristEnds {
        /// The recorded values.
        is: [f64; 2],
        /// The required values.
        asked: [f64; 2],
    },
    /// The wrist turns before the record begins, or after the step ends.
    #[error("the wrist turns from {begin:.6} s to {until:.6} s, but the step ends at {end:.6} s")]
    WristOutside {
        /// The recorded beginning of the turn, seconds.
        begin: f64,
        /// The recorded end of the turn, seconds.
        until: f64,
        /// The end of the step, seconds.
        end: f64,
    },
    /// The arm moves during a stroke, but the world has no arch motions.
    #[error("the arm moves while the tool is lowered or raised, which the world forbids")]
    NoArch,
    /// The tool is lower during a motion than the world allows.
    #[error("the arm moves during {overlap:.6} s of a stroke, but the tool is high enough only for {most:.6} s")]
    TooLow {
        /// Time in which stroke and motion overlap in the record, seconds.
        overlap: f64,
        /// Longest overlap during which the tool stays as high as the world requires, seconds.
        most: f64,
    },
    /// The strokes and turns at both ends of a motion overlap with each other.
    #[error("strokes and turns overlap with the motion for {shared:.6} s, but the motion takes only {seconds:.6} s")]
    NotRaised {
        /// Sum of the overlaps at both ends, seconds.
        shared: f64,
        /// Duration of the motion, seconds.
        seconds: f64,
    },
    /// A stroke or a turn overlaps with a next motion, but the task has no further motion.
    #[error("a stroke or a turn overlaps with the next motion, but the task ends")]
    MustRest,
    /// The wrist turns while the tool is not completely raised.
    #[error("the wrist turns while the tool is not raised completely")]
    TurnsLowered,
    /// The arm moves during a turn of the wrist, but the world forbids that.
    #[error("the arm moves while the wrist turns, which the world forbids")]
    NoTurnOnTheWay,
    /// The arm moves during a turn of the wrist that follows no pick and precedes no place.
    #[error("the arm moves while the wrist turns, but the turn is neither after a pick nor before a place")]
    TurnElsewhere,
    /// The wrist exceeds its limits, because it compensates the rotation of link 2 during the turn.
    #[error(
        "the wrist exceeds its limits while the arm moves, because it turns the object and compensates the rotation of link 2"
    )]
    WristLimits,
    /// The recorded turn of the wrist begins at an orientation that the object does not have.
    #[error("the recorded turn of the wrist begins {off:.6} rad away from the object's orientation")]
    Turn {
        /// Difference from that orientation, radians.
        off: f64,
    },
    /// The wrist turns faster than it can.
    #[error("the wrist turns in {seconds:.6} s, but needs at least {least:.6} s")]
    TooFast {
        /// The recorded duration.
        seconds: f64,
        /// The least possible duration.
        least: f64,
    },
    /// The turn needs a wrist, but the world has none.
    #[error("the wrist turns, but the world has no wrist")]
    NoWrist,
    /// The turn needs a carried object, but the gripper is empty.
    #[error("the wrist turns, but holds no level object")]
    Nothing,
}

fn value(lowered: Option<f64>) -> String {
    lowered.map_or_else(|| "no value".to_owned(), |value| format!("{value} m"))
}

/// The point at which the recorded steps deviate from the sequence of the task.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OrderDeviation {
    /// Another step was required.
    #[error("steps[{index}] is step {number} (cycle {cycle}), but the world requires {expected}")]
    Order {
        /// Index of the recorded step.
        index: usize,
        /// The recorded step's number.
        number: usize,
        /// Number of the repetition to which the record assigns the step.
        cycle: usize,
        /// Description of the expected step.
        expected: String,
    },
    /// The record ends before the task does.
    #[error("after {count} steps the world requires {expected}, but the file ends")]
    Missing {
        /// The number of steps.
        count: usize,
        /// Description of the expected step.
        expected: String,
    },
    /// A step begins before the previous one ends.
    #[error("steps[{index}] begins with sample {first}, but the previous step ends with sample {last}")]
    Overlap {
        /// Index of the recorded step.
        index: usize,
        /// The step's first sample.
        first: usize,
        /// The last sample of the previous step.
        last: usize,
    },
    /// The arm moves between steps.
    #[error("the arm moves between samples {sample} and {}, outside all steps", sample + 1)]
    Moves {
        /// Index of the recorded step that follows the motion, or the number of steps.
        index: usize,
        /// Sample at which the arm moves, or after which it is at another place.
        sample: usize,
    },
}

impl OrderDeviation {
    /// Returns the number of recorded steps before the deviation.
    pub fn index(&self) -> usize {
        match *self {
            OrderDeviation::Order { index, .. }
            | OrderDeviation::Overlap { index, .. }
            | OrderDeviation::Moves { index, .. } => index,
            OrderDeviation::Missing { count, .. } => count,
        }
    }
}
