//! The line as the certificate states it.

use crate::curve::{Arc, Curve};
use cplan_check::decimal::Decimal;
use cplan_check::elbow::Elbow;
use cplan_check::interval::{BITS, Interval, Point, length, minus, rough};
use cplan_check::polygon::Corner;
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;
use serde::Deserialize;
use std::fmt;

/// Number of decimals of the greatest distance between points that count as equal. It is a share of one metre plus the
/// distance from the origin.
const GAP_DECIMALS: u32 = 8;

#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum PieceText {
    Straight([Corner; 2]),
    Cubic([Corner; 4]),
    Arc { center: Corner, radius: Decimal, from: Decimal, by: Decimal, growth: Option<Decimal> },
}

/// The member `line` of a certificate, or of a step in a certificate.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineText {
    pub tolerance: Option<Decimal>,
    pieces: Vec<PieceText>,
    #[serde(default)]
    travels: Vec<usize>,
    #[serde(default)]
    places: Vec<[Decimal; 2]>,
    pub stretch: Option<[Decimal; 2]>,
    pub elbow: Option<Elbow>,
}

impl LineText {
    /// Reads the member's JSON.
    ///
    /// # Errors
    /// If the text is not a line.
    pub fn read(text: &str) -> Result<Self, CheckError> {
        serde_json::from_str(text).map_err(|error| wrong(format!("\"line\": {error}")))
    }
}

/// A line, and the places or the stretch that the evidence states.
pub struct Line {
    /// Greatest distance between the tip and the line, metres.
    pub tolerance: Decimal,
    /// The pieces in order.
    pub pieces: Vec<Curve>,
    /// Number of the pieces that only lead the tip to the next piece.
    travels: usize,
    /// Evidence for "found": pairs of a moment of the motion and a position on the line, at which the tip is near the
    /// line. A moment is a knot plus a share of the time until the next knot. A position is a piece plus its parameter.
    pub places: Vec<[Decimal; 2]>,
    /// Evidence for "infeasible": the positions between which no motion follows the line.
    pub stretch: Option<[Decimal; 2]>,
    /// The side of the elbow all along the line. `None` if either side will do.
    pub elbow: Option<Elbow>,
}

fn wrong(message: String) -> CheckError {
    CheckError::in_file(Input::Certificate, message)
}

fn point(corner: &Corner) -> Point {
    corner.each_ref().map(Interval::from)
}

impl Line {
    /// Makes a line from its text.
    ///
    /// # Errors
    /// If it has no tolerance or no pieces, or if a piece does not begin where the previous one ends.
    pub fn new(text: LineText) -> Result<Self, CheckError> {
        let LineText { tolerance, pieces, travels, places, stretch, elbow } = text;
        let Some(tolerance) = tolerance else { return Err(wrong("\"line\" has no tolerance".into())) };
        let curve = |piece: &PieceText| match piece {
            PieceText::Straight(ends) => Curve::Bezier(ends.iter().map(point).collect()),
            PieceText::Cubic(control) => Curve::Bezier(control.iter().map(point).collect()),
            PieceText::Arc { center, radius, from, by, growth } => {
                let [radius, from, by] = [radius, from, by].map(Interval::from);
                let growth = growth.as_ref().map_or_else(|| Interval::whole(0), Interval::from);
                Curve::Arc(Box::new(Arc { center: point(center), radius, from, by, growth }))
            }
        };
        let (curves, count) = (pieces.iter().map(curve).collect(), travels.len());
        let line = Self { tolerance, pieces: curves, travels: count, places, stretch, elbow };
        if Interval::from(&line.tolerance).lower <= BigInt::ZERO {
            return Err(wrong("\"line\": the tolerance must be above 0".into()));
        }
        if line.pieces.is_empty() {
            return Err(wrong("\"line\" has no pieces".into()));
        }
        let is_piece = |piece: &usize| *piece < pieces.len();
        if !travels.iter().all(is_piece) || travels.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(wrong("\"line\": \"travels\" must be numbers of pieces, in ascending order".into()));
        }
        match line.pieces.windows(2).position(|pair| !is_joined(&pair[0], &pair[1])) {
            Some(before) => {
                CheckError::fails(format!("piece {} of the line does not begin where piece {before} ends", before + 1))
            }
            None => Ok(line),
        }
    }
}

/// Rounds down a number to an index below `count`. Negative numbers become 0.
pub fn index(number: &Decimal, count: usize) -> usize {
    usize::try_from(number.floor(0)).unwrap_or(if *number < Decimal::whole(0) { 0 } else { usize::MAX }).min(count - 1)
}

/// Returns the parameter of a position on a piece, in units of [`Interval`].
pub fn parameter(position: &Decimal, piece: usize) -> BigInt {
    position.floor(BITS) - (BigInt::from(piece) << BITS)
}

/// Returns true if a piece begins where another one ends, apart from rounding.
fn is_joined(before: &Curve, after: &Curve) -> bool {
    is_near(&before.at(&Interval::whole(1)), &after.at(&Interval::whole(0)))
}

/// Returns true if two points are the same, apart from rounding.
pub fn is_near(point: &Point, other: &Point) -> bool {
    let scale = &length(other) + &Interval::whole(1);
    length(&minus(point, other)).upper <= (&scale * &Interval::from(&Decimal::power_of_ten(GAP_DECIMALS))).lower
}

impl fmt::Display for Line {
    /// Describes the line by its number of pieces and its ends.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let count = self.pieces.len();
        let (from, to) = (self.pieces[0].at(&Interval::whole(0)), self.pieces[count - 1].at(&Interval::whole(1)));
        let [[a, b], [c, d]] = [rough(&from), rough(&to)];
        let travels = if self.travels > 0 { format!(", {} of them travels,", self.travels) } else { String::new() };
        let pieces = if count == 1 { "piece" } else { "pieces" };
        let side = self.elbow.map_or_else(String::new, |elbow| format!(" with the elbow on the {}", elbow.name()));
        write!(f, "a line of {count} {pieces}{travels} from ({a:.6}, {b:.6}) to ({c:.6}, {d:.6}){side}")
    }
}
