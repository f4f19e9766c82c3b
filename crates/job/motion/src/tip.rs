//! Limit on the speed of the tip.

use cplan_handling::{Derivative, Piece};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};

/// Greatest share of the tip's speed limit that is lost because one bound holds for a whole part of a curve. It
/// determines how finely curves are cut.
pub(super) const TIP_SPEED_STEP: f64 = 0.01;

/// Greatest number of parts into which a piece is cut to bound the tip's speed.
const MAX_TIP_PARTS: f64 = 64.0;

/// Greatest speed of an arm's tip in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipSpeed<'a> {
    /// The arm with the tip.
    pub arm: &'a Arm,
    /// Greatest speed, metres per second, positive.
    pub speed: f64,
    /// For each leg of the path, the share of the speed that it allows, greater than 0 and at most 1; empty if all legs
    /// allow the whole speed. Only [`super::time`] uses them, and a blend has the lower speed of its two legs.
    pub legs: &'a [f64],
}

/// A part of a curve `q(s)` with a constant second derivative: all values of the parameter `s` within `half` of the
/// middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// The configuration in the middle.
    pub(super) middle: Configuration,
    /// First derivative by the parameter in the middle.
    pub(super) slope: Configuration,
    /// Second derivative by the parameter.
    pub(super) bend: Configuration,
    /// Half the range of the parameter.
    pub(super) half: f64,
}

impl<'a> TipSpeed<'a> {
    /// Returns the limit to one speed, metres per second, on the whole path.
    pub fn new(arm: &'a Arm, speed: f64) -> Self {
        Self { arm, speed, legs: &[] }
    }

    /// Returns the share of the speed that a leg allows.
    pub(super) fn share_of_leg(&self, leg: usize) -> f64 {
        self.legs.get(leg).copied().unwrap_or(1.0)
    }

    /// Returns a bound, in metres per unit of the parameter, on the overestimate of the tip's derivative on a part.
    pub(super) fn slack(&self, part: &Part) -> f64 {
        self.change(part) * part.half
    }

    /// Returns a speed of the parameter at which the tip keeps its limit on the whole part. The tip's derivative by the
    /// parameter is `J q'`, and changes at most at the rate [`TipSpeed::change`].
    pub(super) fn speed_within_limit(&self, part: &Part) -> f64 {
        let [first, second] = self.arm.jacobian(1, self.arm.tip, part.middle);
        let rate = (first * part.slope[0] + second * part.slope[1]).norm();
        self.speed / (rate + self.slack(part))
    }

    /// Returns the factor by which the tip may exceed its limit on pieces of a motion. `None` if the limit is proven to
    /// be satisfied.
    pub(super) fn excess(&self, pieces: &[Piece]) -> Option<f64> {
        let excess = pieces.iter().map(|piece| self.excess_on(piece)).fold(1.0, f64::max);
        (excess > 1.0).then_some(excess)
    }

    fn excess_on(&self, piece: &Piece) -> f64 {
        let duration = piece.to - piece.from;
        let parts = |count: u32| {
            let part = move |u: f64, acceleration: Configuration| Part {
                middle: piece.at(u),
                slope: piece.derivative(Derivative::Velocity, u),
                bend: acceleration,
                half: duration / f64::from(2 * count),
            };
            // The acceleration is linear, so it is greatest at an end, in any direction.
            let ends = [0.0, 1.0].map(|end| piece.derivative(Derivative::Acceleration, end));
            (0..count).flat_map(move |i| ends.map(|end| part((f64::from(i) + 0.5) / f64::from(count), end)))
        };
        let slack = parts(1).map(|part| self.slack(&part)).fold(0.0, f64::max);
        let count = (slack / (TIP_SPEED_STEP * self.speed)).ceil().clamp(1.0, MAX_TIP_PARTS) as u32;
        parts(count).map(|part| 1.0 / self.speed_within_limit(&part)).fold(0.0, f64::max)
    }

    /// Returns the greatest magnitude of the second derivative of the tip's position by the parameter.
    fn change(&self, part: &Part) -> f64 {
        use JointType::{Prismatic, Revolute};
        let arm = self.arm;
        let [w1, w2] = [0, 1].map(|k| part.slope[k].abs() + part.bend[k].abs() * part.half);
        let [b1, b2] = [part.bend[0].abs(), part.bend[1].abs()];
        let tip = arm.tip;
        match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (Revolute { sign: s1 }, Revolute { sign: s2 }) => {
                // Turning rate of link 2.
                let turn = |rate: Configuration| (s1 * rate[0] + s2 * rate[1]).abs();
                let w = turn(part.slope) + turn(part.bend) * part.half;
                arm.offset.norm() * (w1 * w1 + b1) + tip.norm() * (w * w + turn(part.bend))
            }
            (Revolute { .. }, Prismatic { direction }) => {
                let radius = (arm.offset + direction * part.middle[1] + tip).norm() + w2 * part.half;
                radius * (w1 * w1 + b1) + 2.0 * w1 * w2 + b2
            }
            (Prismatic { .. }, Revolute { .. }) => b1 + tip.norm() * (w2 * w2 + b2),
            (Prismatic { .. }, Prismatic { .. }) => b1 + b2,
        }
    }
}
