//! Claims: what a file states about its motion or task, in addition to the samples.

use cplan_model::Arm;
use cplan_model::space::{Configuration, Metric};
use serde::Deserialize;
use std::ops::RangeInclusive;

/// A recorded turn of the wrist.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RecordedTurn {
    /// The object's orientation at the beginning, radians.
    pub from: f64,
    /// The object's orientation at the end, radians. The wrist turns from `from` to `to` without wrapping, so the sign
    /// of the difference is the direction.
    pub to: f64,
    /// Duration, seconds. The wrist turns with its fastest profile, or with that profile stretched evenly in time.
    pub seconds: f64,
    /// The parts of the turn during which the arm moves. The beginning of a turn before a place overlaps with the step's own
    /// motion; the end of a turn after a pick overlaps with the next motion.
    pub overlap: RecordedOverlap,
}

/// The parts of a stroke or a turn during which the arm moves, seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RecordedOverlap {
    /// Time from the beginning of the lowering, or of the turn, to the arrival of the arm.
    pub before_arrival: f64,
    /// Time from the departure of the arm to the end of the raising, or of the turn.
    pub after_departure: f64,
}

/// A recorded turn of the wrist to a value of its joint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
pub struct RecordedWrist {
    /// The joint's value at the beginning, radians.
    pub from: f64,
    /// The joint's value at the end, radians.
    pub to: f64,
    /// Time from the beginning of the recording to the beginning of the turn, seconds.
    pub begin: f64,
    /// Duration, seconds.
    pub seconds: f64,
}

/// A recorded step of a task. Its action is that of the step with this number in the task.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedStep {
    /// Number of the step in the world file, from 1.
    pub number: usize,
    /// Number of the step's repetition, from 1.
    pub cycle: usize,
    /// Range of the motion's samples within the whole recording.
    pub samples: RangeInclusive<usize>,
    /// The turn of the wrist after the motion.
    pub turn: Option<RecordedTurn>,
    /// The parts of the step's stroke during which the arm moves; zero if the arm rests during the whole stroke.
    pub overlap: RecordedOverlap,
    /// Only if the tool is lowered when the step begins: time from the departure of the arm to the end of the stroke up, seconds.
    /// Zero if the arm rests during that stroke.
    pub raising: f64,
    /// Values of the stroke's joint while the tool is lowered, before and after the motion, metres. `None` if the file states no
    /// such stroke.
    pub lowered: [Option<f64>; 2],
    /// The turn of the wrist to the value of its joint that the step states.
    pub wrist: Option<RecordedWrist>,
    /// Value, velocity and acceleration of the wrist's joint at the motion's samples, radians and seconds, along a line that
    /// states the tool's angle. `None` if the file does not state them.
    pub wrist_motion: Option<Vec<[f64; 3]>>,
}

/// The claims of a result about its motion. A claim that the file does not make is `None`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Claims {
    /// Outcome in one word: `found` if there is a motion.
    pub status: Option<String>,
    /// True if the motion was certified to be free.
    pub certified: Option<bool>,
    /// Units of both joints' values, base to tip.
    pub units: Option<Vec<String>>,
    /// The waypoints that the motion follows.
    pub path: Option<Vec<Configuration>>,
    /// Length of the path in joint space.
    pub length: Option<f64>,
    /// Distance from obstacles that the motion keeps, metres. The outer `None` means not stated, the inner `None` that no
    /// obstacle is within reach.
    pub clearance: Option<Option<f64>>,
    /// The corners that the motion rounds off.
    pub blends: Option<BlendsClaim>,
    /// Duration of the motion, seconds.
    pub duration: Option<f64>,
    /// Length of the path in some metric, with a lower bound.
    pub optimum: Option<OptimumClaim>,
    /// Claims about the task.
    pub task: TaskClaims,
    /// Members of the file that are not checked, in the order of the file.
    pub unjudged: Vec<String>,
}

/// The corners of a path that a motion rounds off.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct BlendsClaim {
    /// Number of rounded corners.
    pub count: usize,
    /// Greatest distance of the ends of a rounded piece from its corner, in joint space.
    pub largest_radius: f64,
}

/// Claims about the optimality of a path.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct OptimumClaim {
    /// Name of the metric: `euclidean`, `weighted`, `time` or `motor`.
    pub metric: String,
    /// Weights of the joints, for the metric `weighted`.
    pub weights: Option<[f64; 2]>,
    /// Length of the path in the metric.
    pub length: f64,
    /// Lower bound on the length of every motion.
    pub lower_bound: f64,
    /// Gap: `length / lower_bound - 1`; `None` if the bound is 0.
    pub gap: Option<f64>,
}

impl OptimumClaim {
    /// Returns the metric for an arm. `None` if its name is unknown, or if the arm lacks motors.
    pub fn metric(&self, arm: &Arm) -> Option<Metric> {
        match (self.metric.as_str(), self.weights) {
            ("euclidean", _) => Some(Metric::Euclidean),
            ("weighted", Some(weights)) => Some(Metric::Weighted { weights }),
            ("time", _) => Some(arm.time_metric()),
            ("motor", _) => Some(Metric::Motor { ratio: arm.motors?.ratio }),
            _ => None,
        }
    }
}

/// Claims about a task.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TaskClaims {
    /// Lower bound on the duration of the task, seconds.
    pub lower_bound: Option<f64>,
    /// Gap: `duration / lower_bound - 1`.
    pub gap: Option<f64>,
    /// For each sample, the number of the step, from 0, that contains the interval from this sample to the next.
    pub step_of_sample: Option<Vec<usize>>,
    /// Claims about each recorded step.
    pub steps: Vec<StepClaims>,
    /// Actions of the gripper.
    pub events: Option<Vec<EventClaim>>,
}

/// Claims about a step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepClaims {
    /// Kind of action: `pick`, `place` or `move`.
    pub action: Option<String>,
    /// Name of the object that is picked or placed. The inner value is `None` if the step has no object.
    pub object: Option<Option<String>>,
    /// Name of the object that is carried during the motion. The inner value is `None` if the gripper is empty.
    pub carried: Option<Option<String>>,
    /// Seconds from the beginning of the task to the beginning of the motion.
    pub begin: Option<f64>,
    /// Seconds from the beginning of the task to the end of the motion.
    pub arrival: Option<f64>,
    /// Seconds from the beginning of the task to the end of the step.
    pub end: Option<f64>,
    /// The waypoints that the motion follows.
    pub path: Option<Vec<Configuration>>,
    /// Length of the path in joint space.
    pub length: Option<f64>,
    /// Distance from obstacles that the step's motion keeps, metres. The outer `None` means not stated, the inner `None` that no
    /// obstacle is within reach.
    pub clearance: Option<Option<f64>>,
    /// The corners that the motion rounds off.
    pub blends: Option<BlendsClaim>,
    /// Distance from obstacles that the object keeps while the wrist turns, metres. The outer `None` means not stated, the inner
    /// `None` that no obstacle is within reach.
    pub turn_clearance: Option<Option<f64>>,
}

/// A claimed action of the gripper.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct EventClaim {
    /// Seconds from the beginning of the task.
    pub time: f64,
    /// `grasp` or `release`.
    pub event: String,
    /// Name of the object.
    pub object: String,
    /// Number of the step in the world file, from 1.
    pub step: usize,
    /// Number of the step's repetition, from 1.
    pub cycle: usize,
    /// Position of the tip, metres.
    pub tip: [f64; 2],
    /// Pose of the object from this event on.
    pub pose: Option<PoseClaim>,
}

/// A claimed pose of an object.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct PoseClaim {
    /// Origin of the object, metres.
    pub at: [f64; 2],
    /// Orientation of the object, radians.
    pub angle: f64,
}
