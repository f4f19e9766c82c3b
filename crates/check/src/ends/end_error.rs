//! Distance between the ends of a motion and the required start or goal.
//!
//! A knot is `(time, joint 1, joint 2)`. Distances are in units of `2^-BITS` radians or metres; see [`BITS`].

use super::End;
use crate::arm::Arm;
use crate::decimal::Decimal;
use crate::domain::{Axis, Range};
use crate::error::CheckError;
use crate::free::{Attachment, Chain};
use crate::interval::{BITS, Interval, Point, length, minus};
use crate::world::Goal;
use num_bigint::BigInt;

/// Number of decimals of the maximum error of a motion at its start or goal: `10^-5` radians or metres. For joints
/// several metres from the tip, rounding to six decimals causes about this error.
const END_TOLERANCE_DECIMALS: u32 = 5;

impl End {
    /// Describes the end in words. `knot` is the first or the last knot of a motion. If it is not exactly at the end,
    /// adds a power of ten that bounds its distance.
    ///
    /// # Errors
    /// If the distance exceeds `10^-5`.
    pub fn reached(&self, arm: &Arm, knot: &[Decimal]) -> Result<String, CheckError> {
        let named = self.named(arm);
        self.at.check_elbow(arm, knot)?;
        let equals_knot = |k: usize, range: &Range| range.iter().all(|end| *end == knot[1 + k]);
        match &self.at {
            Goal::Joints(ranges) if (0..2).all(|k| equals_knot(k, &ranges[k])) => Ok(named),
            at => Ok(named.trim_end_matches(',').to_owned() + &missed(self.what, &arm.error_bound(knot, at))?),
        }
    }
}

/// Describes the distance between a motion and an end in words: as a power of ten that is at least the error `off`.
///
/// # Errors
/// If the error exceeds `10^-5`.
pub fn missed(what: &str, off: &BigInt) -> Result<String, CheckError> {
    let is_within = |digits: &u32| Interval::from(&Decimal::power_of_ten(*digits)).lower >= *off;
    match (END_TOLERANCE_DECIMALS..50).rev().find(is_within) {
        Some(digits) => Ok(format!(", within 1e-{digits},")),
        None => CheckError::fails(format!("the motion misses the {what} by more than 1e-{END_TOLERANCE_DECIMALS}")),
    }
}

/// Returns an upper bound on the distance of a place from a rectangle; 0 inside.
fn distance_outside(place: &Point, area: &Point) -> BigInt {
    let zero = Interval::whole(0);
    let beyond = |k: usize| {
        let (actual, range) = (&place[k], &area[k]);
        let [below, above] = [&range.lower - &actual.lower, &actual.upper - &range.upper];
        Interval::exact(below.max(above).max(zero.lower.clone()))
    };
    length(&[beyond(0), beyond(1)]).upper
}

impl Goal {
    /// Checks that the elbow is on the required side at a knot, if the goal requires one.
    ///
    /// # Errors
    /// If it is on the other side, or if the arm has no elbow.
    pub fn check_elbow(&self, arm: &Arm, knot: &[Decimal]) -> Result<(), CheckError> {
        let Self::Tip(_, Some(elbow)) = self else { return Ok(()) };
        elbow.of_arm(arm)?;
        elbow.check_knot(arm, knot)
    }
}

impl Arm {
    /// Returns an upper bound on the distance of a knot from a goal. For joint values it is the greater error of the
    /// two joints. For a position or area it is the distance of the tip.
    pub fn error_bound(&self, knot: &[Decimal], goal: &Goal) -> BigInt {
        let at = [&knot[1], &knot[2]];
        match goal {
            Goal::Joints(ranges) => (0..2).map(|k| self.joint_error(k, at[k], &ranges[k])).max().expect("two joints"),
            Goal::Tip(place, _) => {
                let actual = self.tip_at(&at);
                length(&minus(&actual, &place.each_ref().map(Interval::from))).upper
            }
            Goal::Areas(areas) => {
                let actual = self.tip_at(&at);
                areas.iter().map(|area| distance_outside(&actual, &self.area(area))).min().expect("an area")
            }
        }
    }

    /// Returns the position of the tip with the joints at these values.
    fn tip_at(&self, at: &[&Decimal; 2]) -> Point {
        Chain::from(self).point_at(&Attachment::Link(1), &self.tip.shape.points[0], &at.map(Interval::from))
    }

    /// Returns an upper bound on the difference between a joint's value and any number of a target range. For a
    /// continuous joint, whole turns are ignored.
    fn joint_error(&self, joint: usize, actual: &Decimal, target: &Range) -> BigInt {
        let apart = &Interval::from(actual) - &Interval::enclosing(target);
        if !matches!(self.joints[joint].axis, Axis::Circle) {
            return apart.magnitude();
        }
        let turn = Interval::pi() + Interval::pi();
        let turns = &apart.lower / &turn.lower;
        let without = |more: i32| {
            let turns = Interval::exact((&turns + more) << BITS);
            (&apart - &(&turn * &turns)).magnitude()
        };
        (-1..=1).map(without).min().expect("three")
    }
}
