//! Contact intervals of one joint, their copies on its axis, and the sweep of a part over all values of joint 2.

use super::{Joint, JointType};
use cplan_geometry::{
    Convex, Features, Hits, Point, Vector, along_and_across, normalized, product, sliding_tracks, turning_from,
};
use std::f64::consts::TAU;

/// A convex part prepared for the contact equations of the joint that moves it.
#[derive(Debug, Clone)]
pub struct CarriedPart {
    joint_type: JointType,
    features: Features,
    /// Corners of the core as (along, across) the sliding direction; empty for revolute joints.
    track: Vec<Vector>,
}

impl CarriedPart {
    /// Prepares a part, given in the frame that `joint_type` moves. `O(n)`.
    pub fn new(joint_type: JointType, shape: &Convex) -> Self {
        let track = match joint_type {
            JointType::Revolute { .. } => Vec::new(),
            JointType::Prismatic { direction } => along_and_across(shape.core().iter(), Vector::zeros(), direction),
        };
        Self { joint_type, features: Features::new(shape), track }
    }

    /// Returns the joint's kind of motion.
    pub fn joint_type(&self) -> JointType {
        self.joint_type
    }

    /// Returns the part's shape, in the frame that the joint moves.
    pub fn shape(&self) -> &Convex {
        self.features.shape()
    }

    /// Appends to `out` the values of the joint at which the part is within `grow` of the piece. The joint is at
    /// `pivot`, on a link whose x axis points along the unit vector `heading`.
    pub fn hits(&self, pivot: Point, heading: Vector, piece: &Features, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        match self.joint_type {
            JointType::Revolute { sign } => {
                let from = out.len();
                let hits = turning_from(&self.features, pivot, heading, piece, grow, out);
                if sign < 0.0 {
                    out[from..].iter_mut().for_each(|arc| *arc = normalized([-arc[1], -arc[0]]));
                    out[from..].sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
                }
                hits
            }
            JointType::Prismatic { direction } => {
                let radius = self.features.shape().radius() + piece.shape().radius() + grow;
                let direction = product(heading, direction);
                let track = along_and_across(piece.shape().core().iter(), pivot, direction);
                match sliding_tracks(&self.track, &track, radius) {
                    Some(interval) => {
                        out.push(interval);
                        Hits::Within
                    }
                    None => Hits::Never,
                }
            }
        }
    }
}

/// Calls `f` with every copy of the intervals, by whole turns, that meets the joint's range, clipped to the range. For
/// [`Hits::Always`] calls `f` once, with the whole range.
pub fn on_axis(joint: &Joint, hits: Hits, intervals: &[[f64; 2]], mut f: impl FnMut([f64; 2])) {
    let (lower, upper) = joint.range.domain();
    match hits {
        Hits::Never => {}
        Hits::Always => f([lower, upper]),
        Hits::Within => {
            let period = if joint.joint_type.is_revolute() { TAU } else { f64::INFINITY };
            for &[start, end] in intervals {
                let mut shift = if period.is_finite() { ((lower - end) / period).ceil() * period } else { 0.0 };
                while start + shift <= upper {
                    // Rounding may put the end of the first copy just below `lower`; then skip it.
                    if end + shift >= lower {
                        f([(start + shift).max(lower), (end + shift).min(upper)]);
                    }
                    shift += period;
                }
            }
        }
    }
}

/// Returns a shape, in link 1's frame, that contains a part of link 2 at all values of joint 2. `shape` is the part
/// in link 2's frame, `offset` the position of joint 2 in link 1's frame.
pub fn swept(shape: &Convex, joint: &Joint, offset: Vector) -> Convex {
    match joint.joint_type {
        JointType::Revolute { .. } => Convex::trusted(vec![offset], shape.reach_from(Point::zeros())),
        JointType::Prismatic { direction } => {
            let center = shape.core().iter().sum::<Vector>() / shape.core().len() as f64;
            let (lower, upper) = joint.range.domain();
            let [from, to] = [lower, upper].map(|q| center + offset + direction * q);
            let core = if from == to { vec![from] } else { vec![from, to] };
            Convex::trusted(core, shape.reach_from(center))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::JointRange;

    /// Returns the copies of an interval on the axis of a revolute joint.
    fn copies(axis: JointRange, interval: [f64; 2]) -> Vec<[f64; 2]> {
        let joint = Joint {
            name: "turn".into(),
            joint_type: JointType::Revolute { sign: 1.0 },
            range: axis,
            velocity: 1.0,
            acceleration: 1.0,
            jerk: None,
        };
        let mut copies = Vec::new();
        on_axis(&joint, Hits::Within, &[interval], |copy| copies.push(copy));
        copies
    }

    #[test]
    fn a_range_of_more_than_a_turn_has_an_interval_more_than_once() {
        let axis = JointRange::Interval { lower: -4.0, upper: 4.5 };
        assert_eq!(copies(axis, [2.0, 3.0]), [[2.0 - TAU, 3.0 - TAU], [2.0, 3.0]].map(|[a, b]| [a.max(-4.0), b]));
        // The interval is longer than half a turn. Its copy two turns lower still overlaps the limits.
        assert_eq!(copies(axis, [3.0, 9.0]), [[-4.0, 9.0 - 2.0 * TAU], [3.0 - TAU, 9.0 - TAU], [3.0, 4.5]]);
    }

    #[test]
    fn an_interval_that_ends_a_turn_from_the_limit_is_kept() {
        for lower in [-4.2, -3.5, -8.042] {
            for turns in [1.0, 2.0] {
                let end: f64 = lower + turns * TAU;
                for end in [end.next_down(), end, end.next_up()] {
                    let copies = copies(JointRange::Interval { lower, upper: 6.0 }, [end - 0.5, end]);
                    let is_there =
                        copies.iter().any(|[start, to]| (start - (end - 0.5)).abs() < 1e-12 && *to == end.min(6.0));
                    assert!(is_there || end - 0.5 > 6.0, "[{}, {end}] from {lower} on: {copies:?}", end - 0.5);
                }
            }
        }
    }
}
