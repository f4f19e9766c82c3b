//! Stretches of a motion, and how far it deviates in them from where it is halfway.

use cplan_core::check::Deviation;
use cplan_core::space::Configuration;
use cplan_handling::Piece;

/// Spans of a piece are halved down to this share of it: a nanosecond of a long one, and still far above what rounding
/// does to a share.
const FINEST: f64 = 1.0 / (1u64 << 40) as f64;

/// A place on the motion: a piece, and a share of it.
pub type Place = (usize, f64);

/// A stretch of the motion.
#[derive(Debug, Clone, Copy)]
pub enum Span {
    /// Whole pieces, from one to before another.
    Pieces(usize, usize),
    /// From one share of a piece to another.
    Part(usize, f64, f64),
}

impl Span {
    /// The place where it begins.
    pub fn start(self) -> Place {
        self.ends()[0]
    }

    /// All of a motion of so many pieces.
    pub fn all(pieces: usize) -> Self {
        if pieces == 1 { Span::Part(0, 0.0, 1.0) } else { Span::Pieces(0, pieces) }
    }

    /// From one place to a later one, or more.
    pub fn between(from: Place, to: Place) -> Self {
        if from.0 == to.0 { Span::Part(from.0, from.1, to.1) } else { Span::Pieces(from.0, to.0 + 1) }
    }

    /// The configuration in the middle of it, and how far it deviates from that.
    pub fn deviation(self, pieces: &[Piece]) -> (Configuration, Deviation) {
        match self {
            Span::Pieces(first, end) => around(&pieces[first..end]),
            Span::Part(index, from, to) => along(&pieces[index], from, to, 0.0),
        }
    }

    /// The place halfway along it.
    pub fn middle(self) -> Place {
        match self {
            Span::Pieces(first, end) => (first + (end - first) / 2, 0.0),
            Span::Part(piece, from, to) => (piece, (from + to) / 2.0),
        }
    }

    /// Where it begins, and where it ends.
    pub fn ends(self) -> [Place; 2] {
        match self {
            Span::Pieces(first, end) => [(first, 0.0), (end - 1, 1.0)],
            Span::Part(piece, from, to) => [(piece, from), (piece, to)],
        }
    }

    /// Both halves, in order; none of a span that is as fine as can be.
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
            Span::Part(_, from, to) if to - from <= FINEST => None,
            Span::Part(piece, from, to) => {
                let middle = (from + to) / 2.0;
                Some([Span::Part(piece, from, middle), Span::Part(piece, middle, to)])
            }
        }
    }
}

/// Rounding of a configuration that is computed from control points, for each degree of the piece and relative to the
/// largest of them: three operations a step, and some for the control points themselves.
const ROUNDING: f64 = 6.0 * f64::EPSILON;

/// The rounding of a piece's configurations in one joint.
fn rounding(piece: &Piece, joint: usize) -> f64 {
    let largest = piece.control().iter().map(|p| p[joint].abs()).fold(0.0, f64::max);
    ROUNDING * piece.degree() as f64 * largest
}

/// The box about several pieces.
fn around(pieces: &[Piece]) -> (Configuration, Deviation) {
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

/// The tube about a part of a piece, from the configuration halfway through it, and all that is in each joint no more
/// than `beside` off it.
pub(super) fn along(piece: &Piece, from: f64, to: f64, beside: f64) -> (Configuration, Deviation) {
    let (first, middle, last) = (piece.at(from), piece.at((from + to) / 2.0), piece.at(to));
    let bend = piece.bend(from, to);
    let off_chord = (first + last) / 2.0 - middle;
    let half =
        [0, 1].map(|k| bend[k] * (to - from) * (to - from) / 8.0 + off_chord[k].abs() + rounding(piece, k) + beside);
    (middle, Deviation::Tube((last - first) / 2.0, half))
}
