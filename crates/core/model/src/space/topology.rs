//! Intervals and circles. Only this module wraps configurations.

use super::{Configuration, Segment};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// The difference between the exact value of 2 pi and the double [`TAU`], to double precision. Over 80 000 turns (half
/// a million radians) it adds up to 2e-11 rad, far more than the margins of certificates.
const TAU_REMAINDER: f64 = 2.449_293_598_294_706_4e-16;

/// Returns the angle of `turns` whole turns as the sum of two doubles. The error is far below one rounding of the
/// second double. `turns` must be an integer.
fn whole_turns(turns: f64) -> [f64; 2] {
    let high = turns * TAU;
    // The multiplication's rounding error, exactly.
    let left_out = turns.mul_add(TAU, -high);
    [high, left_out + turns * TAU_REMAINDER]
}

/// Returns a sum as a double and its rounding error, exactly (Knuth 1969).
fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let of_b = sum - a;
    [sum, (a - (sum - of_b)) + (b - of_b)]
}

/// Returns `value` plus whole turns. The error is at most two roundings of the result, even if the two terms cancel.
fn turned(value: f64, turns: f64) -> f64 {
    if turns == 0.0 {
        return value;
    }
    let [high, low] = whole_turns(turns);
    let [sum, left_out] = two_sum(value, high);
    sum + (left_out + low)
}

/// The values that a joint can take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointRange {
    /// An interval from `lower` to `upper`, both included. The range of a revolute joint may exceed a full turn.
    /// Values that differ by whole turns then have the same pose, but are different configurations.
    Interval {
        /// The least value of the joint.
        lower: f64,
        /// The greatest value of the joint.
        upper: f64,
    },
    /// A joint without limits. Values that differ by whole turns are the same configuration.
    Circle,
}

impl JointRange {
    /// Returns true for a circle.
    pub fn is_circle(self) -> bool {
        matches!(self, JointRange::Circle)
    }

    /// Returns the interval that represents every configuration: the limits, or `[-pi, pi]`, whose ends are the
    /// same.
    pub fn domain(self) -> (f64, f64) {
        match self {
            JointRange::Interval { lower, upper } => (lower, upper),
            JointRange::Circle => (-PI, PI),
        }
    }

    /// Returns the length of [`JointRange::domain`].
    pub fn extent(self) -> f64 {
        let (lower, upper) = self.domain();
        upper - lower
    }

    /// Returns true if `value` is allowed. Circles allow all values.
    pub fn contains(self, value: f64) -> bool {
        match self {
            JointRange::Interval { lower, upper } => lower <= value && value <= upper,
            JointRange::Circle => value.is_finite(),
        }
    }

    /// Returns the nearest value within the range.
    pub fn clamp(self, value: f64) -> f64 {
        match self {
            JointRange::Interval { lower, upper } => value.clamp(lower, upper),
            JointRange::Circle => value,
        }
    }

    /// Returns the representative of `value` in the domain: the value itself on an interval, and its copy in
    /// `[-pi, pi)` on a circle. Turns are subtracted with more digits of pi than a double has, so the error is at most
    /// 1e-15 for magnitudes up to 1e15. Beyond that, a double does not distinguish neighbouring angles.
    pub fn wrap(self, value: f64) -> f64 {
        if self != JointRange::Circle || (-PI..PI).contains(&value) {
            return value;
        }
        let near = turned(value, -(value / TAU).round_ties_even());
        // The quotient is rounded as well, so near the seam one more turn may be needed.
        match near {
            near if near >= PI => turned(near, -1.0).max(-PI),
            near if near < -PI => Some(turned(near, 1.0)).filter(|wrapped| *wrapped < PI).unwrap_or(-PI),
            near => near,
        }
    }

    /// Returns the shortest signed displacement from `from` to `to`. On a circle it is in `[-pi, pi)`, and as exact
    /// as [`JointRange::wrap`].
    pub fn displacement(self, from: f64, to: f64) -> f64 {
        match self {
            JointRange::Interval { .. } => to - from,
            JointRange::Circle => {
                let [difference, left_out] = two_sum(to, -from);
                self.wrap(self.wrap(difference) + left_out)
            }
        }
    }

    /// Returns the copy of `value` nearest to `near`. On an interval, or if no turn is added, this is exactly
    /// `value`. Otherwise the error is at most two roundings of the result. (Half a million radians from zero,
    /// doubles are 6e-11 rad apart.)
    pub fn lift(self, value: f64, near: f64) -> f64 {
        match self {
            JointRange::Interval { .. } => value,
            JointRange::Circle => turned(value, ((near - value) / TAU).round_ties_even()),
        }
    }

    /// Returns `value` plus an integer number of whole turns. The error is at most two roundings of the result.
    pub fn turned(self, value: f64, turns: f64) -> f64 {
        turned(value, turns)
    }

    /// Iterates over the copies of `value` from `lower` to `upper`, in ascending order. On an interval the only copy
    /// is the value itself, even if it lies outside these bounds. The bounds must be finite.
    pub fn copies_within(self, value: f64, (lower, upper): (f64, f64)) -> impl Iterator<Item = f64> {
        let turns = match self {
            JointRange::Interval { .. } => 0..=0,
            JointRange::Circle => ((lower - value) / TAU).ceil() as i64..=((upper - value) / TAU).floor() as i64,
        };
        turns.map(move |turn| turned(value, turn as f64))
    }
}

/// The values that the sum `ratio q1 + q2` can take: an oblique strip of joint space. It is the range of an elbow motor that
/// is mounted on the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointSumRange {
    /// Factor of joint 1's value in the sum.
    pub ratio: f64,
    /// The least sum.
    pub lower: f64,
    /// The greatest sum.
    pub upper: f64,
}

impl JointSumRange {
    /// Returns true if the sum is allowed, up to the rounding of the sum.
    pub fn contains(&self, q: Configuration) -> bool {
        let may = SUM_ROUNDING * (1.0 + (self.ratio * q[0]).abs() + q[1].abs());
        self.lower - may <= self.of(q) && self.of(q) <= self.upper + may
    }

    /// Returns the sum of a configuration's joint values.
    pub fn of(&self, q: Configuration) -> f64 {
        self.ratio * q[0] + q[1]
    }

    /// Returns the range without the outermost sums at both ends.
    #[must_use]
    pub fn narrowed(self, by: f64) -> Self {
        Self { lower: self.lower + by, upper: self.upper - by, ..self }
    }

    /// Returns the values of joint 2 that are allowed at a value of joint 1.
    pub fn second_joint(&self, q1: f64) -> [f64; 2] {
        [self.lower, self.upper].map(|end| end - self.ratio * q1)
    }
}

/// Rounding error of a sum of joint values, relative to their sizes. Paths along the limit have corners whose joint values
/// are differences of the limit and of the other joint's value.
const SUM_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The shape of joint space: a product of two axes, which is a rectangle, cylinder or torus. A rectangle may be cut by an
/// oblique strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Topology {
    /// The ranges of joints 1 and 2.
    pub ranges: [JointRange; 2],
    /// The range of a sum of both joint values. Both joints then have limits.
    pub sum: Option<JointSumRange>,
}

/// A limit of joint space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimitedValue {
    /// The value of a joint, 0 or 1.
    Joint(usize),
    /// The sum of both joint values that [`Topology::sum`] limits.
    Sum,
}

impl Topology {
    /// Creates the product of two axes.
    pub const fn new(ranges: [JointRange; 2]) -> Self {
        Self { ranges, sum: None }
    }

    /// Returns true if both joint values are allowed, and their sum.
    pub fn contains(&self, q: Configuration) -> bool {
        self.violated_limit(q).is_none()
    }

    /// Returns the first violated limit.
    pub fn violated_limit(&self, q: Configuration) -> Option<LimitedValue> {
        let joint = (0..2).find(|&k| !self.ranges[k].contains(q[k])).map(LimitedValue::Joint);
        joint.or_else(|| self.sum.is_some_and(|sum| !sum.contains(q)).then_some(LimitedValue::Sum))
    }

    /// Returns the intervals of joint 2's range in which the sum of joint values is not allowed at either of two values
    /// of joint 1. So it is not allowed for any value between these two.
    pub fn closed_by_sum(&self, q1: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + use<> {
        let (bottom, top) = self.ranges[1].domain();
        let outside = self.sum.map(|sum| {
            let [a, b] = q1.map(|q1| sum.second_joint(q1));
            [[bottom, a[0].min(b[0]).min(top)], [a[1].max(b[1]).max(bottom), top]]
        });
        outside.into_iter().flatten().filter(|[from, to]| from < to)
    }

    /// Returns the value of a configuration to which this limit applies: a joint value, or the sum.
    pub fn value(&self, limited: LimitedValue, q: Configuration) -> f64 {
        match (limited, self.sum) {
            (LimitedValue::Joint(joint), _) => q[joint],
            (LimitedValue::Sum, sum) => sum.map_or(0.0, |sum| sum.of(q)),
        }
    }

    /// Returns the part of a segment on which the sum of joint values is allowed.
    pub fn within_sum(&self, segment: Segment) -> Option<Segment> {
        let Some(sum) = self.sum else { return Some(segment) };
        if segment.ends().into_iter().all(|q| sum.contains(q)) {
            return Some(segment);
        }
        let [from, to] = segment.ends().map(|q| sum.of(q) - sum.lower);
        let above = segment.where_positive(from, to)?;
        let [from, to] = above.ends().map(|q| sum.upper - sum.of(q));
        above.where_positive(from, to)
    }

    /// Returns the representative of `q` in the fundamental domain.
    pub fn wrap(&self, q: Configuration) -> Configuration {
        Configuration::new(self.ranges[0].wrap(q[0]), self.ranges[1].wrap(q[1]))
    }

    /// Returns the shortest displacement from `from` to `to`.
    pub fn displacement(&self, from: Configuration, to: Configuration) -> Configuration {
        Configuration::new(self.ranges[0].displacement(from[0], to[0]), self.ranges[1].displacement(from[1], to[1]))
    }

    /// Returns the Euclidean length of the shortest displacement.
    pub fn distance(&self, from: Configuration, to: Configuration) -> f64 {
        self.displacement(from, to).norm()
    }

    /// Returns the copy of `q` nearest to `near`; each axis follows [`JointRange::lift`].
    pub fn lift(&self, q: Configuration, near: Configuration) -> Configuration {
        Configuration::new(self.ranges[0].lift(q[0], near[0]), self.ranges[1].lift(q[1], near[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use proptest::prelude::*;

    #[test]
    fn lifting_to_where_the_value_is_changes_no_bit() {
        let interval = JointRange::Interval { lower: -7.0, upper: 7.0 };
        for (value, near) in [(0.1, 0.7), (-2.9, 3.0), (6.5, -6.5), (0.3, 1e9)] {
            assert_eq!(interval.lift(value, near), value);
        }
        for (value, near) in [(0.1, 0.7), (1e-17, 0.3), (3.0, 0.1), (-2.0, 1.0), (0.0, PI)] {
            assert_eq!(JointRange::Circle.lift(value, near), value);
        }
        let cylinder = Topology::new([JointRange::Circle, interval]);
        let lifted = cylinder.lift(Configuration::new(-3.0, 0.1), Configuration::new(3.0, -5.0));
        assert!((lifted - Configuration::new(TAU - 3.0, 0.1)).amax() < 1e-15, "{lifted}");
    }

    #[test]
    fn copies_within_a_window_are_whole_turns_apart() {
        let copies = |axis: JointRange, value, window| axis.copies_within(value, window).collect::<Vec<_>>();
        assert_eq!(copies(JointRange::Circle, 1.0, (-TAU, TAU)), [1.0 - TAU, 1.0]);
        assert_eq!(copies(JointRange::Circle, 0.0, (-TAU, TAU)), [-TAU, 0.0, TAU]);
        assert!(copies(JointRange::Circle, 0.0, (1.0, 2.0)).is_empty());
        assert_eq!(copies(JointRange::Interval { lower: 0.0, upper: 1.0 }, 0.5, (2.0, 3.0)), [0.5]);
    }

    fn exact(value: f64) -> BigRational {
        BigRational::from_float(value).expect("a finite number")
    }

    /// Computes 2 pi to more than forty decimals by Machin's formula: `pi / 4 = 4 atan(1/5) - atan(1/239)`.
    fn whole_turn() -> BigRational {
        let atan = |inverse: f64, terms: u8| {
            let (x, square) = (exact(1.0) / exact(inverse), exact(inverse * inverse));
            let term = |k: u8| exact(if k.is_multiple_of(2) { 1.0 } else { -1.0 }) / exact(f64::from(2 * k + 1));
            // The series by Horner's scheme.
            (0..terms).rev().fold(exact(0.0), |sum, k| sum / &square + term(k)) * x
        };
        (atan(5.0, 32) * exact(4.0) - atan(239.0, 10)) * exact(8.0)
    }

    /// Returns true if a difference is an integer number of turns, up to `by`.
    fn is_whole(difference: BigRational, by: f64) -> bool {
        let turn = whole_turn();
        let rest = &difference - (&difference / &turn).round() * turn;
        -exact(by) <= rest && rest <= exact(by)
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Tests that whole turns are taken off exactly: compares with exact arithmetic, for angles of any size that
        /// worlds allow.
        #[test]
        fn turns_are_taken_off_exactly(
            mantissa in -10.0..10.0_f64, decade in 0..6_i32, other in -10.0..10.0_f64, far in -1e6..1e6_f64,
        ) {
            let value = mantissa * 10f64.powi(decade);
            let wrapped = JointRange::Circle.wrap(value);
            prop_assert!((-PI..PI).contains(&wrapped));
            prop_assert!(is_whole(exact(value) - exact(wrapped), 1e-15), "{} wraps to {}", value, wrapped);
            let lifted = JointRange::Circle.lift(other, value);
            prop_assert!(is_whole(exact(lifted) - exact(other), f64::EPSILON * lifted.abs().max(PI)), "{}", lifted);
            let difference = JointRange::Circle.displacement(far, value);
            prop_assert!((-PI..PI).contains(&difference));
            prop_assert!(is_whole(exact(value) - exact(far) - exact(difference), 1e-15), "{} {}: {}", far, value, difference);
        }

        #[test]
        fn copies_are_the_same_pose_and_the_lift_is_the_nearest(value in -50.0..50.0_f64, near in -50.0..50.0_f64) {
            let lifted = JointRange::Circle.lift(value, near);
            for copy in [lifted, JointRange::Circle.wrap(value), near + JointRange::Circle.displacement(near, value)] {
                prop_assert!((copy.sin() - value.sin()).hypot(copy.cos() - value.cos()) < 1e-12);
            }
            prop_assert!((-PI..PI).contains(&JointRange::Circle.wrap(value)));
            prop_assert!((lifted - near).abs() <= PI + 1e-12);
            prop_assert!(((lifted - near).abs() - JointRange::Circle.displacement(near, value).abs()).abs() < 1e-12);
        }
    }
}
