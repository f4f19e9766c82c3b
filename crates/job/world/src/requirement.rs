//! Conditions on the arm that follow from steps. If a step is repeated, each of its conditions is listed once.

use cplan_geometry::Point;
use cplan_model::Elbow;
use cplan_model::space::Configuration;
use std::collections::BTreeSet;
use std::ops::Range;

/// A condition on the arm that follows from a step.
#[derive(Debug, Clone)]
pub(super) struct Requirement {
    pub required: Required,
    /// The step's number.
    pub step: usize,
    /// Position in the file of the value from which the requirement follows.
    pub at: Range<usize>,
}

/// The kinds of requirements.
#[derive(Debug, Clone, Copy)]
pub(super) enum Required {
    /// The arm must be able to take these joint values.
    Joints(Configuration),
    /// The tip must be able to reach this point, with the elbow on the stated side.
    Tip(Point, Option<Elbow>),
    /// The arm must have an elbow.
    Elbow,
    /// The object with this index must be able to rest on something.
    Rest(usize),
}

/// The requirements of all steps. Repetitions of a step count once.
#[derive(Default)]
pub(super) struct Requirements {
    pub all: Vec<Requirement>,
    /// The listed requirements: number of the step, kind, and bits of the values.
    known: BTreeSet<(usize, u8, [u64; 2])>,
}

impl Requirements {
    /// Adds a requirement of a step, unless the step already has it.
    pub fn add(&mut self, step: usize, required: Required, at: Range<usize>) {
        let (kind, values) = match required {
            Required::Joints(q) => (0, [q[0], q[1]].map(f64::to_bits)),
            Required::Tip(tip, elbow) => {
                let kind = elbow.map_or(1, |elbow| 3 + elbow.solution() as u8);
                (kind, [tip.x, tip.y].map(f64::to_bits))
            }
            Required::Elbow => (5, [0; 2]),
            Required::Rest(object) => (2, [object as u64, at.start as u64]),
        };
        if self.known.insert((step, kind, values)) {
            self.all.push(Requirement { required, step, at });
        }
    }
}
