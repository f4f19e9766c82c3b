//! Intervals of joint 2 at a row: what is closed, and what that leaves.

use crate::space::Axis;
use std::f64::consts::TAU;

/// An interval of joint 2 that is not closed at a row; infinite ends where nothing is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Door {
    pub lower: f64,
    pub upper: f64,
    /// Whether the lower and the upper end are the ends of something closed, not of the domain.
    pub tips: [bool; 2],
}

impl Door {
    /// The same some turns of joint 2 further.
    pub fn turned(self, turns: f64) -> Self {
        Self { lower: self.lower + turns * TAU, upper: self.upper + turns * TAU, ..self }
    }
}

/// An interval that may lead across the seam of a circle, in pieces within its domain.
pub(super) fn within_domain(axis: Axis, lower: f64, upper: f64) -> impl Iterator<Item = [f64; 2]> {
    let (bottom, top) = axis.domain();
    let beyond = (axis.is_circle() && upper > top).then(|| [bottom, (upper - TAU).min(top)]);
    [Some([lower, upper.min(top)]), beyond].into_iter().flatten()
}

/// What closed intervals of the domain, disjoint and ascending, leave of it.
pub(super) fn left_by(closed: &[[f64; 2]], axis: Axis) -> Vec<Door> {
    let (bottom, top) = axis.domain();
    let round = axis.is_circle();
    let (Some(first), Some(last)) = (closed.first(), closed.last()) else {
        let (lower, upper) = if round { (f64::NEG_INFINITY, f64::INFINITY) } else { (bottom, top) };
        return vec![Door { lower, upper, tips: [false; 2] }];
    };
    let mut doors = Vec::with_capacity(closed.len() + 1);
    if !round && bottom < first[0] {
        doors.push(Door { lower: bottom, upper: first[0], tips: [false, true] });
    }
    doors.extend(closed.windows(2).map(|w| Door { lower: w[0][1], upper: w[1][0], tips: [true; 2] }));
    if !round && last[1] < top {
        doors.push(Door { lower: last[1], upper: top, tips: [true, false] });
    }
    // Across the seam.
    if round && last[1] < first[0] + TAU {
        doors.push(Door { lower: last[1], upper: first[0] + TAU, tips: [true; 2] });
    }
    doors
}
