//! Limit on the speed of the tip.

use cplan_handling::{Derivative, Piece};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};

/// Greatest share of the tip's speed limit that is lost because one bound holds for a whole part of a curve. It determines how
/// finely curves are cut.
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
    /// For each leg of the path, the share of the speed that it allows, above 0 and at most 1; empty if all legs allow the whole
    /// speed. Only [`super::time`] uses them. On a blend, the lower share of its two legs applies.
    pub legs: &'a [f64],
}

/// A part of a curve `q(s)` with a constant third derivative: all values of the parameter `s` within `half` of the middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// The configuration in the middle.
    pub(super) middle: Configuration,
    /// First derivative by the parameter in the middle.
    pub(super) slope: Configuration,
    /// Second derivative by the parameter in the middle.
    pub(super) bend: Configuration,
    /// Third derivative by the parameter.
    pub(super) third: Configuration,
    /// Half the range of the parameter.
    pub(super) half: f64,
}

impl Part {
    /// Returns the configuration and its first two derivatives at a distance of the parameter from the middle.
    pub(super) fn at(&self, by: f64) -> [Configuration; 3] {
        let Self { middle, slope, bend, third, .. } = *self;
        let square = by * by / 2.0;
        let q = middle + slope * by + bend * square + third * (square * by / 3.0);
        [q, slope + bend * by + third * square, bend + third * by]
    }
}

impl<'a> TipSpeed<'a> {
    /// Returns the limit with one speed, metres per second, for the whole path.
    pub fn new(arm: &'a Arm, speed: f64) -> Self {
        Self { arm, speed, legs: &[] }
    }

    /// Returns the share of the speed that a leg allows.
    pub(super) fn share_of_leg(&self, leg: usize) -> f64 {
        self.legs.get(leg).copied().unwrap_or(1.0)
    }

    /// Returns a bound on the overestimate of the tip's derivative on a part, in metres per unit of the parameter.
    pub(super) fn slack(&self, part: &Part) -> f64 {
        self.change(part) * part.half
    }

    /// Returns a speed of the parameter at which the tip is within its limit on the whole part. The tip's derivative by the
    /// parameter is `J q'`, which changes at most at the rate [`TipSpeed::change`].
    pub(super) fn speed_within_limit(&self, part: &Part) -> f64 {
        let [first, second] = self.arm.jacobian(1, self.arm.tip, part.middle);
        let rate = (first * part.slope[0] + second * part.slope[1]).norm();
        self.speed / (rate + self.slack(part))
    }

    /// Returns a number for each end of a part. If the speeds of the parameter at both ends are at most the limit divided by
    /// these numbers, and the squared speed is linear in between, the tip is within its limit on the whole part.
    ///
    /// Between the ends, the tip's derivative by the parameter differs from its chord by at most `h^2 / 8` times its second
    /// derivative. If its magnitude were linear, the squared speed would exceed the limit by less than two squares of its
    /// relative change.
    pub(super) fn rates(&self, part: &Part) -> [f64; 2] {
        let off = part.half * part.half / 2.0 * self.change_of_rate(part);
        let [first, last] = self.rates_at_ends(part).map(|rate| rate + off);
        let change = (last - first) / first.min(last);
        [first, last].map(|rate| rate * (1.0 + change * change))
    }

    /// Returns a bound on the overestimate of [`TipSpeed::rates`], in metres per unit of the parameter.
    pub(super) fn slack_of_rates(&self, part: &Part) -> f64 {
        let (known, bounds) = (self.rates_at_ends(part), self.rates(part));
        (bounds[0] - known[0]).max(bounds[1] - known[1])
    }

    /// Returns the magnitudes of the tip's derivative by the parameter at both ends of a part.
    fn rates_at_ends(&self, part: &Part) -> [f64; 2] {
        [-part.half, part.half].map(|by| {
            let [q, slope, _] = part.at(by);
            let [first, second] = self.arm.jacobian(1, self.arm.tip, q);
            (first * slope[0] + second * slope[1]).norm()
        })
    }

    /// Returns the factor by which the tip may exceed its limit on pieces of a motion. `None` if it is proven to be within the
    /// limit.
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
                third: Configuration::zeros(),
                half: duration / f64::from(2 * count),
            };
            // The acceleration is linear, so in any direction it is greatest at an end.
            let ends = [0.0, 1.0].map(|end| piece.derivative(Derivative::Acceleration, end));
            (0..count).flat_map(move |i| ends.map(|end| part((f64::from(i) + 0.5) / f64::from(count), end)))
        };
        let slack = parts(1).map(|part| self.slack(&part)).fold(0.0, f64::max);
        let count = (slack / (TIP_SPEED_STEP * self.speed)).ceil().clamp(1.0, MAX_TIP_PARTS) as u32;
        parts(count).map(|part| 1.0 / self.speed_within_limit(&part)).fold(0.0, f64::max)
    }

    /// Returns bounds on the magnitudes of the first three derivatives by the parameter on a part: for each joint, and for the
    /// rotation of link 2.
    fn derivatives(&self, part: &Part) -> [[f64; 3]; 3] {
        let turns = self.arm.joints.each_ref().map(|joint| joint.joint_type.turn());
        let along = |of: &dyn Fn(Configuration) -> f64| {
            let [slope, bend, third] = [part.slope, part.bend, part.third].map(|v| of(v).abs());
            let half = part.half;
            [slope + bend * half + third * (half * half / 2.0), bend + third * half, third]
        };
        [along(&|v| v[0]), along(&|v| v[1]), along(&|v| turns[0] * v[0] + turns[1] * v[1])]
    }

    /// Returns the greatest magnitude of the second derivative of the tip's position by the parameter.
    fn change(&self, part: &Part) -> f64 {
        use JointType::{Prismatic, Revolute};
        let (arm, tip) = (self.arm, self.arm.tip);
        let [[w1, b1, _], [w2, b2, _], [w, b, _]] = self.derivatives(part);
        match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (Revolute { .. }, Revolute { .. }) => arm.offset.norm() * (w1 * w1 + b1) + tip.norm() * (w * w + b),
            (Revolute { .. }, Prismatic { direction }) => {
                let radius = (arm.offset + direction * part.middle[1] + tip).norm() + w2 * part.half;
                radius * (w1 * w1 + b1) + 2.0 * w1 * w2 + b2
            }
            (Prismatic { .. }, Revolute { .. }) => b1 + tip.norm() * (w2 * w2 + b2),
            (Prismatic { .. }, Prismatic { .. }) => b1 + b2,
        }
    }

    /// Returns the greatest magnitude of the third derivative of the tip's position by the parameter.
    fn change_of_rate(&self, part: &Part) -> f64 {
        use JointType::{Prismatic, Revolute};
        let (arm, tip) = (self.arm, self.arm.tip);
        let [[w1, b1, j1], [w2, b2, j2], [w, b, j]] = self.derivatives(part);
        // The third derivative of a unit vector that rotates with these derivatives.
        let turned = |w: f64, b: f64, j: f64| w * w * w + 3.0 * w * b + j;
        match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (Revolute { .. }, Revolute { .. }) => arm.offset.norm() * turned(w1, b1, j1) + tip.norm() * turned(w, b, j),
            (Revolute { .. }, Prismatic { direction }) => {
                let radius = (arm.offset + direction * part.middle[1] + tip).norm() + w2 * part.half;
                radius * turned(w1, b1, j1) + 3.0 * (w2 * (w1 * w1 + b1) + b2 * w1) + j2
            }
            (Prismatic { .. }, Revolute { .. }) => j1 + tip.norm() * turned(w2, b2, j2),
            (Prismatic { .. }, Prismatic { .. }) => j1 + j2,
        }
    }
}
