//! Lines that steps of a task follow.

use crate::curve::Curve;
use crate::text::{Line, LineText, is_near};
use crate::{near, tip};
use cplan_check::arm::Arm;
use cplan_check::curve::Piece;
use cplan_check::decimal::Decimal;
use cplan_check::elbow::Elbow;
use cplan_check::interval::{Interval, Point, length, minus, roughly};
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;
use std::fmt;

/// Number of parts of an arc whose ends are tried as guesses for the point nearest to a given point. Each part is at most a
/// sixth of a radian long. From the best end, [`REFINEMENTS`] steps find the point with an error far below a picometre.
const ARC_PARTS: u32 = 40;

/// Number of steps of Newton's method for a point of an arc.
const REFINEMENTS: usize = 4;

/// A line that a step of a task follows, and the places that the step's motion passes. The tolerance is the world's.
pub struct StepLine(Line);

impl StepLine {
    /// Reads the line of a step from JSON. `tolerance`, in metres, and `elbow` are those of the world.
    ///
    /// # Errors
    /// If the text is not a line, if it states a tolerance, an elbow or a stretch, or if a piece does not begin where
    /// the previous one ends.
    pub fn read(text: &str, tolerance: &Decimal, elbow: Option<Elbow>) -> Result<Self, CheckError> {
        let mut text = LineText::read(text)?;
        if text.tolerance.is_some() || text.stretch.is_some() || text.elbow.is_some() {
            let message = "the \"line\" of a step cannot have a tolerance, an elbow or a stretch; the world states tolerance and elbow";
            return Err(CheckError::in_file(Input::Certificate, message));
        }
        (text.tolerance, text.elbow) = (Some(tolerance.clone()), elbow);
        Line::new(text).map(Self)
    }

    /// Returns true if both lines have the same pieces.
    pub fn has_pieces_of(&self, other: &Self) -> bool {
        self.0.pieces == other.0.pieces
    }

    /// Returns an upper bound on the distance between the tip at a knot and the beginning of the line, in units of
    /// [`Interval`].
    pub fn distance_from_start(&self, arm: &Arm, knot: &[Decimal]) -> BigInt {
        let tip = tip::at(arm, &[1, 2].map(|k| Interval::from(&knot[k])));
        length(&minus(&tip, &self.0.pieces[0].at(&Interval::whole(0)))).upper
    }

    /// Checks that the tip follows the line within the tolerance, for each interpolation of the motion. `motion` is the
    /// motion of the step, from knot to knot.
    ///
    /// # Errors
    /// Places that omit a knot or the end of a piece of the line, and the first part of the motion on which the tip is
    /// not shown to follow the line.
    pub fn check(&self, arm: &Arm, motion: &[Piece]) -> Result<(), CheckError> {
        near::stays_near(arm, &self.0, motion)
    }

    /// Returns true if the line consists of the straight lines that join the points.
    pub fn joins(&self, points: &[Point]) -> bool {
        let is_between = |(piece, ends): (&Curve, &[Point])| {
            let is_straight = matches!(piece, Curve::Bezier(control) if control.len() == 2);
            is_straight && (0..2).all(|end| is_near(&piece.at(&Interval::whole(end)), &ends[end as usize]))
        };
        points.len() == self.0.pieces.len() + 1 && self.0.pieces.iter().zip(points.windows(2)).all(is_between)
    }

    /// Returns true if the line is an arc of at most a whole circle, from the first point through the second to the third.
    pub fn is_arc_through(&self, [from, through, to]: &[Point; 3]) -> bool {
        let [piece @ Curve::Arc(arc)] = &self.0.pieces[..] else { return false };
        let is_circle = arc.growth == Interval::whole(0);
        let is_turn = is_circle && arc.by.magnitude() <= (Interval::pi() + Interval::pi()).lower;
        let between = Interval::exact(nearest(piece, through));
        let ends = [(Interval::whole(0), from), (between, through), (Interval::whole(1), to)];
        is_turn && ends.iter().all(|(u, point)| is_near(&piece.at(u), point))
    }
}

impl fmt::Display for StepLine {
    /// Describes the line by its number of pieces, its ends and its tolerance.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}, within {} of the line and in its order", self.0, self.0.tolerance)
    }
}

/// Guesses the parameter, from 0 to 1, at which a curve is nearest to a point, in units of [`Interval`].
fn nearest(curve: &Curve, point: &Point) -> BigInt {
    let one = Interval::whole(1);
    let samples = (0..=ARC_PARTS).map(|k| Interval::whole(k as i32).over(ARC_PARTS).lower);
    let distance = |u: &BigInt| length(&minus(&curve.at(&Interval::exact(u.clone())), point)).upper;
    let mut u = samples.min_by_key(distance).unwrap_or(BigInt::ZERO);
    for _ in 0..REFINEMENTS {
        let at = Interval::exact(u.clone());
        let [along, _] = curve.derivatives(&at);
        let [off, along] = [minus(point, &curve.at(&at)), along].map(|v| v.map(|c| roughly(&c.lower)));
        let step = (off[0] * along[0] + off[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        u = (u + near::units(step)).clamp(BigInt::ZERO, one.lower.clone());
    }
    u
}
