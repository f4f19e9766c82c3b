//! Boxes of configurations.

use cplan_model::space::{Configuration, Measure, Metric, Segment};
use std::f64::consts::PI;

/// A closed rectangle of configurations in the fundamental domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Least value of each joint.
    pub lower: [f64; 2],
    /// Greatest value of each joint.
    pub upper: [f64; 2],
}

impl Cell {
    /// Returns the configuration in the middle of the box.
    pub fn center(&self) -> Configuration {
        Configuration::new((self.lower[0] + self.upper[0]) / 2.0, (self.lower[1] + self.upper[1]) / 2.0)
    }

    /// Returns half of each side, rounded up. A box with these half sides about the rounded centre covers the cell.
    pub fn half(&self) -> [f64; 2] {
        [0, 1].map(|k| {
            let largest = self.upper[k].abs().max(self.lower[k].abs()).max(PI);
            (self.upper[k] - self.lower[k]) / 2.0 * (1.0 + 4.0 * f64::EPSILON) + 2.0 * f64::EPSILON * largest
        })
    }

    /// Returns the part of a segment in the cell, with its ends clamped to the cell. If rounding leaves no such part,
    /// returns the point of the segment nearest to the centre.
    pub fn part(&self, piece: &Segment) -> Segment {
        if piece.is_point() {
            return *piece;
        }
        let at_center = || Segment::point(piece.nearest(Measure::from(Metric::Euclidean), self.center()));
        let part = piece.within(self.lower, self.upper).unwrap_or_else(at_center);
        let clamped = |q: Configuration| Configuration::from_fn(|k, _| q[k].clamp(self.lower[k], self.upper[k]));
        let [from, to] = part.ends().map(clamped);
        Segment::new(from, to)
    }
}
