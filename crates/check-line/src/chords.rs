//! A stretch of the line as straight chords, and distances from it.

use crate::curve::Curve;
use crate::measure::Measure;
use crate::text::{Line, parameter};
use cplan_check::CheckError;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point, dot, length, minus, sum};
use num_bigint::{BigInt, Sign};

/// Maximum number of times that a piece is halved for its chords.
const MAX_HALVINGS: u32 = 12;

/// Maximum number of chords of a stretch. Usual stretches have less than a hundred.
const MAX_CHORDS: usize = 20_000;

/// Negative binary logarithm of the greatest deviation of chords, as a share of the tolerance: a quarter.
const DEVIATION_BITS: u32 = 2;

/// A segment, and a bound on the distance of the line's part from the segment. Numbers are in units of [`Interval`].
pub struct Chord {
    middle: Point,
    /// Direction of unit length. `None` if the segment may be a point.
    direction: Option<Point>,
    /// Half of the segment's length.
    half: Interval,
    sag: BigInt,
}

/// Returns chords for the part of a line between two positions.
///
/// # Errors
/// If there are too many.
pub fn of_stretch(line: &Line, [from, to]: &[Decimal; 2]) -> Result<Vec<Chord>, CheckError> {
    let finest = &Interval::from(&line.tolerance).upper >> DEVIATION_BITS;
    let mut chords = Vec::new();
    let one = Interval::whole(1).lower;
    for (number, curve) in line.pieces.iter().enumerate() {
        let ends = [from, to].map(|end| parameter(end, number));
        if ends[0] > one || ends[1].sign() == Sign::Minus {
            continue;
        }
        let mut open = vec![(ends.map(|u| u.clamp(BigInt::ZERO, one.clone())), 0)];
        while let Some(([from, to], halvings)) = open.pop() {
            if chords.len() >= MAX_CHORDS {
                return CheckError::fails("the stretch of the line is too long for the checker");
            }
            let whole = Interval { lower: from.clone(), upper: to.clone() };
            let size = Interval::exact(&to - &from);
            let [_, second] = curve.derivatives(&whole);
            let sag = (&length(&second) * &(&size * &size)).in_halves(3).upper;
            if sag <= finest || halvings >= MAX_HALVINGS {
                chords.push(Chord::new(curve, [&from, &to], sag));
            } else {
                let middle: BigInt = (&from + &to) >> 1u32;
                open.push(([middle.clone(), to], halvings + 1));
                open.push(([from, middle], halvings + 1));
            }
        }
    }
    Ok(chords)
}

impl Chord {
    fn new(curve: &Curve, ends: [&BigInt; 2], sag: BigInt) -> Self {
        let [a, b] = ends.map(|u| curve.at(&Interval::exact(u.clone())));
        let along = minus(&b, &a);
        let size = length(&along);
        let direction = (size.lower.sign() == Sign::Plus).then(|| along.map(|c| c.divided(&size)));
        Self { middle: sum(&a, &b).map(|c| c.half()), direction, half: size.half(), sag }
    }

    /// Returns the measures of all points within `distance` of the part of the line.
    pub fn measures(&self, measure: &Measure, distance: &BigInt) -> Interval {
        let own = measure.of_segment(&self.middle, self.direction.as_ref(), &self.half);
        own.widened(&(distance + &self.sag))
    }

    /// Returns true if a point is certainly farther than `distance` from the part of the line.
    pub fn is_farther(&self, point: &Point, distance: &BigInt) -> bool {
        let off = minus(point, &self.middle);
        let most = distance + &self.sag;
        let beside = &most + &self.half.upper;
        if off.iter().any(|c| c.abs().lower > beside) {
            return true;
        }
        let Some(along) = &self.direction else { return false };
        let across = dot(&off, &[-&along[1], along[0].clone()]).abs().lower;
        let beyond = (&dot(&off, along).abs() - &self.half).lower.max(BigInt::ZERO);
        &across * &across + &beyond * &beyond > &most * &most
    }
}
