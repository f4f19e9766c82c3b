//! In what a recorded task is not the one asked for.

use cplan_core::space::Configuration;
use thiserror::Error;

/// In what a step is not what was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Fault {
    /// The first motion does not begin at the task's start.
    #[error("it does not begin at the start")]
    Start,
    /// A move of the joints ends elsewhere.
    #[error("it ends at ({}, {}), not at ({}, {})", is[0], is[1], target[0], target[1])]
    Joints {
        /// Where it ends.
        is: Configuration,
        /// Where it was to end.
        target: Configuration,
    },
    /// The tip is not where it was to go.
    #[error("the tip ends {off:.6} m from its target")]
    Tip {
        /// How far it is from there, metres.
        off: f64,
    },
    /// What moves is picked at a time at which it may not be.
    #[error("the object is picked at {time:.6} s, outside the times that are asked for")]
    When {
        /// When it is, seconds.
        time: f64,
    },
    /// The object that is placed is not where it was to go.
    #[error("the object's origin ends {off:.6} m from its target")]
    Origin {
        /// How far it is from there, metres.
        off: f64,
    },
    /// The object that is placed is not turned as it was to be.
    #[error("the object is let go of {off:.6} rad from the angle asked for")]
    Angle {
        /// By how much, radians.
        off: f64,
    },
    /// The arm does not stand still for long enough.
    #[error("the arm stands still for {stood:.6} s, not for {asked:.6} s")]
    Rest {
        /// How long it does, seconds.
        stood: f64,
        /// How long it was to: for the step's dwell, the turn of the wrist and the stroke of the tool.
        asked: f64,
    },
    /// The wrist turns from an orientation that the object does not have.
    #[error("the wrist turns from an angle that is {off:.6} rad from the object's")]
    Turn {
        /// How far it is from that, radians.
        off: f64,
    },
    /// The wrist turns faster than it can.
    #[error("the wrist turns in {seconds:.6} s, but needs {least:.6} s")]
    TooFast {
        /// What was recorded.
        seconds: f64,
        /// What it takes at the least.
        least: f64,
    },
    /// The world has no wrist that could turn.
    #[error("the wrist turns, but the world has none")]
    NoWrist,
    /// Nothing is held that a wrist could turn.
    #[error("the wrist turns, but holds nothing level")]
    Nothing,
}

/// Where a record departs from the sequence of its task.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Departure {
    /// Something else was to be done.
    #[error("steps[{index}] is step {number} (cycle {cycle}), where the world asks for {expected}")]
    Order {
        /// Into the recorded steps.
        index: usize,
        /// The recorded step's number.
        number: usize,
        /// The repetition that the record says it belongs to.
        cycle: usize,
        /// What was to be done, in words.
        expected: String,
    },
    /// The record ends before the task does.
    #[error("after {count} steps the world asks for {expected}, but there are no more")]
    Missing {
        /// How many steps there are.
        count: usize,
        /// What was to be done, in words.
        expected: String,
    },
    /// A step begins before the one before it ends.
    #[error("steps[{index}] begins with sample {first}, before sample {last}, with which the step before it ends")]
    Overlap {
        /// Into the recorded steps.
        index: usize,
        /// Its first sample.
        first: usize,
        /// The last sample of the step before.
        last: usize,
    },
    /// The arm moves where no step says so.
    #[error("the arm moves between samples {sample} and {}, which belong to no step", sample + 1)]
    Moves {
        /// Into the recorded steps: that before which it does, or their number.
        index: usize,
        /// The sample at which it does not stand, or after which it stands elsewhere.
        sample: usize,
    },
}

impl Departure {
    /// The number of recorded steps before it.
    #[must_use]
    pub fn index(&self) -> usize {
        match *self {
            Departure::Order { index, .. } | Departure::Overlap { index, .. } | Departure::Moves { index, .. } => index,
            Departure::Missing { count, .. } => count,
        }
    }
}
