//! Distance between the ends of a motion and the required start or goal.

use super::End;
use crate::arm::Arm;
use crate::decimal::Decimal;
use crate::domain::{Axis, Range};
use crate::error::CheckError;
use crate::free::{Attachment, Chain};
use crate::interval::{BITS, Interval, Point, length, minus};
use crate::world::Goal;
use num_bigint::BigInt;

/// Maximum error of a motion at its start or goal, radians or metres: `10^-5`.
const END_TOLERANCE_DECIMALS: u32 = 5;

impl End {
    /// Describes the end in words, with the distance of a motion's first or last knot from it.
    ///
    /// # Errors
    /// If the distance is too large.
    pub fn reached(&self, arm: &Arm, knot: &[Decimal]) -> Result<String, CheckError> {
        let named = self.named(arm);
        let is_it = |k: usize, range: &Range| range.iter().all(|end| *end == knot[1 + k]);
        match &self.at {
            Goal::Joints(ranges) if (0..2).all(|k| is_it(k, &ranges[k])) => Ok(named),
            at => Ok(named.trim_end_matches(',').to_owned() + &missed(self.what, &arm.away(knot, at))?),
        }
    }
}

/// Describes in words by how much a motion misses an end.
///
/// # Errors
/// If it misses by too much.
pub fn missed(what: &str, off: &BigInt) -> Result<String, CheckError> {
    let is_within = |digits: &u32| Interval::from(&Decimal::power_of_ten(*digits)).lower >= *off;
    match (END_TOLERANCE_DECIMALS..50).rev().find(is_within) {
        Some(digits) => Ok(format!(", within 1e-{digits},")),
        None => CheckError::fails(format!("the motion misses the {what} by more than 1e-{END_TOLERANCE_DECIMALS}")),
    }
}

/// Returns an upper bound on the distance of a place from a rectangle.
fn outside(place: &Point, area: &Point) -> BigInt {
    let zero = Interval::whole(0);
    let beyond = |k: usize| {
        let (is, range) = (&place[k], &area[k]);
        let [below, above] = [&range.lower - &is.lower, &is.upper - &range.upper];
        Interval::exactly(below.max(above).max(zero.lower.clone()))
    };
    length(&[beyond(0), beyond(1)]).upper
}

impl Arm {
    /// Returns an upper bound on the distance of a knot from a goal: the greatest joint error, or the error of the tip.
    pub fn away(&self, knot: &[Decimal], goal: &Goal) -> BigInt {
        let at = [&knot[1], &knot[2]];
        match goal {
            Goal::Joints(ranges) => (0..2).map(|k| self.off(k, at[k], &ranges[k])).max().expect("two joints"),
            Goal::Tip(place) => {
                let is = self.tip_at(&at);
                length(&minus(&is, &place.each_ref().map(Interval::from))).upper
            }
            Goal::Areas(areas) => {
                let is = self.tip_at(&at);
                areas.iter().map(|area| outside(&is, &self.area(area))).min().expect("an area")
            }
        }
    }

    /// Returns the position of the tip.
    fn tip_at(&self, at: &[&Decimal; 2]) -> Point {
        Chain::from(self).point_at(&Attachment::Link(1), &self.tip.shape.points[0], &at.map(Interval::from))
    }

    /// Returns an upper bound on the difference between a joint's value and a target range. Whole turns of a continuous
    /// joint do not count.
    fn off(&self, joint: usize, is: &Decimal, should: &Range) -> BigInt {
        let apart = &Interval::from(is) - &Interval::around(should);
        if !matches!(self.joints[joint].axis, Axis::Circle) {
            return apart.magnitude();
        }
        let turn = Interval::pi() + Interval::pi();
        let turns = &apart.lower / &turn.lower;
        let without = |more: i32| {
            let turns = Interval::exactly((&turns + more) << BITS);
            (&apart - &(&turn * &turns)).magnitude()
        };
        (-1..=1).map(without).min().expect("three")
    }
}
