//! What the search asks of boxes.

use crate::check::Cell;
use crate::space::{Configuration, Measure, Metric, Segment};
use std::f64::consts::PI;

impl Cell {
    /// Half of each side; rounded up, so that the box about the middle, which is rounded, too, covers the cell.
    pub(crate) fn half(&self) -> [f64; 2] {
        [0, 1].map(|k| {
            let largest = self.upper[k].abs().max(self.lower[k].abs()).max(PI);
            (self.upper[k] - self.lower[k]) / 2.0 * (1.0 + 4.0 * f64::EPSILON) + 2.0 * f64::EPSILON * largest
        })
    }

    /// The part of a segment that meets the cell; its ends are in the cell, which moves them by rounding.
    pub(crate) fn part(&self, piece: &Segment) -> Segment {
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
