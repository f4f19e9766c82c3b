//! Portals: intervals of joint 2 on a slice that are not closed.

use cplan_model::space::JointRange;
use std::f64::consts::TAU;

/// An interval of joint 2 on a slice that is not closed. Its ends are infinite if nothing is closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Portal {
    pub lower: f64,
    pub upper: f64,
    /// For the lower and the upper end, true if a closed interval ends there; false if the domain does.
    pub tips: [bool; 2],
}

impl Portal {
    /// Shifts the portal by whole turns of joint 2.
    pub fn turned(self, turns: f64) -> Self {
        Self { lower: self.lower + turns * TAU, upper: self.upper + turns * TAU, ..self }
    }
}

/// Splits an interval that may cross the seam of a circle into pieces within the domain.
pub(super) fn within_domain(axis: JointRange, lower: f64, upper: f64) -> impl Iterator<Item = [f64; 2]> {
    let (bottom, top) = axis.domain();
    let beyond = (axis.is_circle() && upper > top).then(|| [bottom, (upper - TAU).min(top)]);
    [Some([lower, upper.min(top)]), beyond].into_iter().flatten()
}

/// Returns the portals between closed intervals, which must be within the domain, disjoint and ascending.
pub(super) fn free_portals(closed: &[[f64; 2]], axis: JointRange) -> Vec<Portal> {
    let (bottom, top) = axis.domain();
    let round = axis.is_circle();
    let (Some(first), Some(last)) = (closed.first(), closed.last()) else {
        let (lower, upper) = if round { (f64::NEG_INFINITY, f64::INFINITY) } else { (bottom, top) };
        return vec![Portal { lower, upper, tips: [false; 2] }];
    };
    let mut portals = Vec::with_capacity(closed.len() + 1);
    if !round && bottom < first[0] {
        portals.push(Portal { lower: bottom, upper: first[0], tips: [false, true] });
    }
    portals.extend(closed.windows(2).map(|w| Portal { lower: w[0][1], upper: w[1][0], tips: [true; 2] }));
    if !round && last[1] < top {
        portals.push(Portal { lower: last[1], upper: top, tips: [true, false] });
    }
    // Across the seam.
    if round && last[1] < first[0] + TAU {
        portals.push(Portal { lower: last[1], upper: first[0] + TAU, tips: [true; 2] });
    }
    portals
}
