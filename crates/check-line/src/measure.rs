//! A measure of the tip's position that depends only on joint 2.
//!
//! If joint 1 turns, it is the distance of the tip from joint 1. If joint 1 slides, it is the distance of the tip to the
//! right of the straight line along which joint 1 slides. So configurations near a line are in narrow ranges of joint 2,
//! however far joint 1 moves.

use crate::tip::jet;
use cplan_check::arm::{Arm, Motion};
use cplan_check::interval::{Interval, Point, dot, double, length, minus};
use num_bigint::BigInt;

/// The measure of an arm.
pub struct Measure<'a> {
    arm: &'a Arm,
}

impl<'a> Measure<'a> {
    pub fn new(arm: &'a Arm) -> Self {
        Self { arm }
    }

    /// Returns the direction to the right of the axis of joint 1. `None` if joint 1 is revolute.
    fn aside(&self) -> Option<Point> {
        match &self.arm.joints[0].motion {
            Motion::Turn(_) => None,
            Motion::Slide([x, y]) => Some([y.clone(), -x]),
        }
    }

    /// Returns the measure of the tip for all values of joint 2 in a range. Let `f` be the measure or its square, `m`
    /// the middle of the range, and `f'` an enclosure of the derivative in the range. Then `f(m) + f' (range - m)`
    /// contains all values of `f`.
    pub fn of_tip(&self, range: &Interval) -> Interval {
        let [zero, one] = [0, 1].map(Interval::whole);
        let state = |value: Interval| {
            let still = [zero.clone(), zero.clone()];
            jet(self.arm, [&[zero.clone(), value], &[zero.clone(), one.clone()], &still])
        };
        let middle = Interval::exact(range.middle().0);
        let ([at, ..], [tip, rate, _]) = (state(middle.clone()), state(range.clone()));
        let [at, tip] = [at, tip].map(|tip| minus(&tip, &self.arm.base));
        let off = range - &middle;
        match self.aside() {
            Some(aside) => &dot(&at, &aside) + &(&dot(&rate, &aside) * &off),
            None => (&dot(&at, &at) + &(&double(&dot(&tip, &rate)) * &off)).sqrt(),
        }
    }

    /// Returns the measures of all points of a segment. A segment without a direction may be a point.
    pub fn of_segment(&self, middle: &Point, direction: Option<&Point>, half: &Interval) -> Interval {
        let off = minus(middle, &self.arm.base);
        let Some(direction) = direction else {
            let measure = self.aside().map_or_else(|| length(&off), |aside| dot(&off, &aside));
            return measure.widened(&half.upper);
        };
        if let Some(aside) = self.aside() {
            return dot(&off, &aside).widened(&(half * &dot(direction, &aside).abs()).upper);
        }
        let along = dot(&off, direction).abs();
        let across = dot(&off, &[-&direction[1], direction[0].clone()]).abs();
        let [mut near, far] = [&along - half, &along + half];
        near.lower = near.lower.max(BigInt::ZERO);
        near.upper = near.upper.max(BigInt::ZERO);
        let [near, far] = [near, far].map(|along| length(&[along, across.clone()]));
        Interval { lower: near.lower, upper: far.upper }
    }
}
