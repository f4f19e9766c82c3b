//! Finds the values of a joint at which a convex part that it moves meets a piece.

use super::{Joint, JointType};
use cplan_geometry::{
    Convex, Features, Hits, Point, Vector, along_and_across, normalized, product, sliding_tracks, turning_from,
};
use std::f64::consts::TAU;

/// A part and the joint that moves it, prepared for the contact equations.
#[derive(Debug, Clone)]
pub struct CarriedPart {
    joint_type: JointType,
    features: Features,
    /// Prismatic joints: the core along and across the direction.
    track: Vec<Vector>,
}

impl CarriedPart {
    /// Prepares a part, given in the frame that `joint_type` moves. `O(n)`.
    #[must_use]
    pub fn new(joint_type: JointType, shape: &Convex) -> Self {
        let track = match joint_type {
            JointType::Revolute { .. } => Vec::new(),
            JointType::Prismatic { direction } => along_and_across(shape.core().iter(), Vector::zeros(), direction),
        };
        Self { joint_type, features: Features::new(shape), track }
    }

    /// Returns the joint's kind of motion.
    #[must_use]
    pub fn joint_type(&self) -> JointType {
        self.joint_type
    }

    /// Returns the part that is carried.
    #[must_use]
    pub fn shape(&self) -> &Convex {
        self.features.shape()
    }

    /// Appends to `out` the joint's values at which the part comes within `grow` of the piece, when the joint sits at
    /// `pivot` on a link turned by `heading` (a unit vector). Exact up to [`cplan_geometry::ROUNDING`]. For angles see
    /// [`Hits::Within`]; lengths form one interval. Limits are not applied. `O(n m)`.
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

/// Calls `f` with the copies of a joint's forbidden intervals within the domain of its axis.
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
                    // If the first copy ends at the limit itself, rounding may put it before the limit, so the next one
                    // may count.
                    if end + shift >= lower {
                        f([(start + shift).max(lower), (end + shift).min(upper)]);
                    }
                    shift += period;
                }
            }
        }
    }
}

/// Returns a shape, in link 1's frame, that contains a part of link 2 at all values of joint 2.
#[must_use]
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

    /// Copies of the intervals on a turning joint's axis.
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
        // Past half a turn, up to one and a half: two turns down it is within the limits still.
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
