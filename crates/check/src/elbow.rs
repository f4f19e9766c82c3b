//! The side of the elbow.

use crate::arm::{Arm, Motion};
use crate::curve::{FRACTION_BITS, Piece};
use crate::decimal::Decimal;
use crate::domain::Range;
use crate::error::{CheckError, Input};
use crate::free::{Attachment, Chain};
use crate::interval::{BITS, Interval, length, minus};
use num_bigint::BigInt;
use serde::Deserialize;

/// Number of decimals of the greatest sine of the angle by which an arm may be bent to the wrong side: `10^-5`, like
/// the greatest error at the ends of a motion.
const BEND_DECIMALS: u32 = 5;

/// Greatest range of joint 2, radians, in which the sides at both ends decide. It must be less than half a turn.
const MAX_RANGE: i32 = 3;

/// The side of the straight line from joint 1 to the tip on which the elbow is. A straight arm is on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Elbow {
    /// The elbow is to the left.
    Left,
    /// The elbow is to the right.
    Right,
}

impl Elbow {
    /// Returns the side with this name.
    pub fn named(name: &str) -> Option<Self> {
        [Self::Left, Self::Right].into_iter().find(|elbow| elbow.name() == name)
    }

    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Checks that the arm has an elbow.
    ///
    /// # Errors
    /// If a joint is prismatic.
    pub fn of_arm(self, arm: &Arm) -> Result<(), CheckError> {
        let turns = arm.joints.iter().all(|joint| matches!(joint.motion, Motion::Turn(_)));
        match turns {
            true => Ok(()),
            false => Err(CheckError::in_file(Input::World, "only arms with two revolute joints have an elbow")),
        }
    }

    /// Returns two enclosures for all values of joint 2 in a range. The first is the product of both links' lengths,
    /// times the sine of the angle by which the arm is bent to the other side. The second is the product alone.
    fn bend(self, arm: &Arm, second: &Interval) -> [Interval; 2] {
        let values = [Interval::whole(0), second.clone()];
        let tip = Chain::from(arm).point_at(&Attachment::Link(1), &arm.tip.shape.points[0], &values);
        let [x, y] = minus(&minus(&tip, &arm.base), &arm.offset);
        // The elbow is on the left if link 2 points to the right of link 1.
        let product = &(&arm.offset[0] * &y) - &(&arm.offset[1] * &x);
        let bend = if self == Self::Left { product } else { -&product };
        [bend, &length(&arm.offset) * &length(&[x, y])]
    }

    /// Returns true if the elbow is certainly on the other side for all values of joint 2 in a range.
    pub fn excludes(self, arm: &Arm, second: &Range) -> bool {
        self.bend(arm, &Interval::enclosing(second))[0].lower > BigInt::ZERO
    }

    /// Checks that the elbow is on this side at a knot, up to the error that is allowed at the ends of motions.
    ///
    /// # Errors
    /// If it is not.
    pub fn check_knot(self, arm: &Arm, knot: &[Decimal]) -> Result<(), CheckError> {
        match self.is_near(arm, &Interval::from(&knot[2])) {
            true => Ok(()),
            false => CheckError::fails(format!("the elbow is not on the {}", self.name())),
        }
    }

    /// Checks that the elbow is on this side all along the pieces of a motion, up to the same error.
    ///
    /// # Errors
    /// The first piece for which this is not shown.
    pub fn check_pieces(self, arm: &Arm, pieces: &[Piece]) -> Result<(), CheckError> {
        for Piece { knot, curves, .. } in pieces {
            let values = || curves.iter().flatten().map(|[_, second]| *second);
            let ends = [values().min(), values().max()].map(|end| end.expect("a curve has points"));
            let [from, to] = ends.map(|end| Interval::exact(BigInt::from(end) << (BITS - FRACTION_BITS)));
            let is_short = (&to - &from).upper <= Interval::whole(MAX_RANGE).lower;
            // Between two angles less than half a turn apart, a sine is positive only if it is positive at one of them.
            if !(is_short && [from, to].iter().all(|end| self.is_near(arm, end))) {
                return CheckError::fails(format!("after knot {knot}, the elbow does not stay on the {}", self.name()));
            }
        }
        Ok(())
    }

    fn is_near(self, arm: &Arm, second: &Interval) -> bool {
        let [bend, lengths] = self.bend(arm, second);
        bend.upper <= (&lengths * &Interval::from(&Decimal::power_of_ten(BEND_DECIMALS))).lower
    }
}
