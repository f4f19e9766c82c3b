//! What a record says of the steps of a task.

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
