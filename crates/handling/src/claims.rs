//! What a record says of a motion or a task besides its samples.

use cplan_core::space::{Configuration, Metric};
use std::ops::RangeInclusive;

/// A turn of the wrist as a record has it, while the arm stands still.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedTurn {
    /// The object's orientation at the beginning, radians.
    pub from: f64,
    /// At the end; the way from the one to the other is the way of the wrist.
    pub to: f64,
    /// How long it takes.
    pub seconds: f64,
}

/// A step of a task as a record has it. What it does is the task's to say.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedStep {
    /// Its number in the world file, from 1.
    pub number: usize,
    /// Which repetition of it this is, from 1.
    pub cycle: usize,
    /// The samples of its motion in the whole recording, in which they are.
    pub samples: RangeInclusive<usize>,
    /// The turn of the wrist after the motion.
    pub turn: Option<RecordedTurn>,
}

/// What a result says of its motion besides the samples. What it does not say is none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Claims {
    /// `found`, if there is a motion.
    pub status: Option<String>,
    /// That the motion was shown free.
    pub certified: Option<bool>,
    /// Units of both joints' values, base to tip.
    pub units: Option<Vec<String>>,
    /// The waypoints that the motion follows.
    pub path: Option<Vec<Configuration>>,
    /// Of the path, in joint space.
    pub length: Option<f64>,
    /// The distance to obstacles that is kept, metres; none within if nothing can be hit.
    pub clearance: Option<Option<f64>>,
    /// The corners that are cut.
    pub blends: Option<BlendsClaim>,
    /// How long the motion takes, seconds.
    pub duration: Option<f64>,
    /// How long the path is in some metric, and a bound on it.
    pub optimum: Option<OptimumClaim>,
    /// Of a task.
    pub task: TaskClaims,
    /// Members of the file that nobody judges, in its order.
    pub unjudged: Vec<String>,
}

/// The corners of a path that a motion cuts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlendsClaim {
    /// The number of corners that are cut.
    pub count: usize,
    /// Greatest distance of the ends of a cut from its corner.
    pub largest_radius: f64,
}

/// What is said of how short a path is.
#[derive(Debug, Clone, PartialEq)]
pub struct OptimumClaim {
    /// `euclidean`, `weighted` or `time`.
    pub metric: String,
    /// Weights of the joints.
    pub weights: Option<[f64; 2]>,
    /// Of the path in the metric.
    pub length: f64,
    /// No motion is shorter.
    pub lower_bound: f64,
    /// `length / lower_bound - 1`; none where the bound is 0.
    pub gap: Option<f64>,
}

impl OptimumClaim {
    /// How lengths are measured, for an arm with these top speeds; none if the metric has no such name.
    #[must_use]
    pub fn metric(&self, speeds: [f64; 2]) -> Option<Metric> {
        match (self.metric.as_str(), self.weights) {
            ("euclidean", _) => Some(Metric::Euclidean),
            ("weighted", Some(weights)) => Some(Metric::Weighted { weights }),
            ("time", _) => Some(Metric::Time { speeds }),
            _ => None,
        }
    }
}

/// What is said of a task.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TaskClaims {
    /// No way of doing it takes less, seconds.
    pub lower_bound: Option<f64>,
    /// `duration / lower_bound - 1`.
    pub gap: Option<f64>,
    /// Of each sample, the number of the step (from 0) to which the interval belongs that begins there.
    pub step_of_sample: Option<Vec<usize>>,
    /// Of each recorded step.
    pub steps: Vec<StepClaims>,
    /// What the gripper does.
    pub events: Option<Vec<EventClaim>>,
}

/// What is said of a step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepClaims {
    /// `pick`, `place` or `move`.
    pub action: Option<String>,
    /// The object that is picked or placed; none within if there is none.
    pub object: Option<Option<String>>,
    /// The object that is carried during the motion.
    pub carried: Option<Option<String>>,
    /// Seconds from the beginning of the task to that of the motion, ...
    pub begin: Option<f64>,
    /// ... to the end of the motion, ...
    pub arrival: Option<f64>,
    /// ... and to the end of the step.
    pub end: Option<f64>,
    /// The waypoints that the motion follows.
    pub path: Option<Vec<Configuration>>,
    /// Of the path, in joint space.
    pub length: Option<f64>,
    /// The distance to obstacles that is kept, metres; none within if nothing can be hit.
    pub clearance: Option<Option<f64>>,
    /// The corners that are cut.
    pub blends: Option<BlendsClaim>,
    /// The distance that is kept while the wrist turns.
    pub turn_clearance: Option<Option<f64>>,
}

/// What the gripper is said to do.
#[derive(Debug, Clone, PartialEq)]
pub struct EventClaim {
    /// Seconds from the beginning of the task.
    pub time: f64,
    /// `grasp` or `release`.
    pub event: String,
    /// With which object.
    pub object: String,
    /// Number of the step in the world file, from 1.
    pub step: usize,
    /// Which repetition of it this is, from 1.
    pub cycle: usize,
    /// Where the tip is, metres.
    pub tip: [f64; 2],
    /// Where the object lies from then on: its origin, metres, and its orientation, radians.
    pub pose: Option<([f64; 2], f64)>,
}
