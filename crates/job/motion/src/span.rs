//! Spans of a motion, and their deviation from the configuration in the middle.

use cplan_handling::Piece;
use cplan_judge::Deviation;
use cplan_model::space::Configuration;

/// Least length of a span, as a share of its piece. For a long piece, it corresponds to a nanosecond. It is far above the
/// rounding error of a share.
const MIN_SPAN: f64 = 1.0 / (1u64 << 40) as f64;

/// A place on the motion: the index of a piece, and the share of the piece before the place.
pub type Place = (usize, f64);

/// A stretch of the motion.
#[derive(Debug, Clone, Copy)]
pub enum Span {
    /// Whole pieces, from the first index up to, but not including, the second.
    Pieces(usize, usize),
    /// A part of the piece with this index, from one share of it to another.
    Part(usize, f64, f64),
}

impl Span {
    /// Returns the place where the span begins.
    pub fn start(self) -> Place {
        self.ends()[0]
    }

    /// Returns the whole motion of this many pieces.
    pub fn all(pieces: usize) -> Self {
        if pieces == 1 { Span::Part(0, 0.0, 1.0) } else { Span::Pieces(0, pieces) }
    }

    /// Returns a span that contains at least the motion from one place to a later one.
    pub fn between(from: Place, to: Place) -> Self {
        if from.0 == to.0 { Span::Part(from.0, from.1, to.1) } else { Span::Pieces(from.0, to.0 + 1) }
    }

    /// Returns the configuration in the middle of the span, and a set that contains all deviations from it within the span.
    pub fn deviation(self, pieces: &[Piece]) -> (Configuration, Deviation) {
        match self {
            Span::Pieces(first, end) => box_about_pieces(&pieces[first..end]),
            Span::Part(index, from, to) => tube_about_part(&pieces[index], from, to, 0.0),
        }
    }

    /// Returns the place in the middle of the span.
    pub fn middle(self) -> Place {
        match self {
            Span::Pieces(first, end) => (first + (end - first) / 2, 0.0),
            Span::Part(piece, from, to) => (piece, (from + to) / 2.0),
        }
    }

    /// Returns the first and the last place of the span.
    pub fn ends(self) -> [Place; 2] {
        match self {
            Span::Pieces(first, end) => [(first, 0.0), (end - 1, 1.0)],
            Span::Part(piece, from, to) => [(piece, from), (piece, to)],
        }
    }

    /// Returns both halves of the span in order. `None` if it has the least length.
    pub fn halves(self) -> Option<[Span; 2]> {
        let whole = |from: usize, to: usize| match to - from {
            1 => Span::Part(from, 0.0, 1.0),
            _ => Span::Pieces(from, to),
        };
        match self {
            Span::Pieces(from, to) => {
                let middle = from + (to - from) / 2;
                Some([whole(from, middle), whole(middle, to)])
            }
            Span::Part(_, from, to) if to - from <= MIN_SPAN => None,
            Span::Part(piece, from, to) => {
                let middle = (from + to) / 2.0;
                Some([Span::Part(piece, from, middle), Span::Part(piece, middle, to)])
            }
        }
    }
}

/// Rounding error of a configuration that is computed from control points, per degree of the piece, relative to the largest
/// control point. It covers three operations per step, and the rounding of the control points.
const ROUNDING: f64 = 6.0 * f64::EPSILON;

/// Returns the rounding error of a piece's configurations in one joint.
fn rounding(piece: &Piece, joint: usize) -> f64 {
    let largest = piece.control().iter().map(|p| p[joint].abs()).fold(0.0, f64::max);
    ROUNDING * piece.degree() as f64 * largest
}

/// Returns the box about several pieces.
fn box_about_pieces(pieces: &[Piece]) -> (Configuration, Deviation) {
    let points = || pieces.iter().flat_map(|p| p.control());
    let mut middle = Configuration::zeros();
    let half = [0, 1].map(|k| {
        let lower = points().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let upper = points().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        middle[k] = (lower + upper) / 2.0;
        (upper - lower) / 2.0 + pieces.iter().map(|piece| rounding(piece, k)).fold(0.0, f64::max)
    });
    (middle, Deviation::Box(half))
}

/// Returns the tube around a part of a piece, from the configuration halfway through it. `beside` is its half width in each
/// joint.
pub(super) fn tube_about_part(piece: &Piece, from: f64, to: f64, beside: f64) -> (Configuration, Deviation) {
    let (first, middle, last) = (piece.at(from), piece.at((from + to) / 2.0), piece.at(to));
    let bend = piece.bend(from, to);
    let off_chord = (first + last) / 2.0 - middle;
    let half =
        [0, 1].map(|k| bend[k] * (to - from) * (to - from) / 8.0 + off_chord[k].abs() + rounding(piece, k) + beside);
    (middle, Deviation::Tube((last - first) / 2.0, half))
}
