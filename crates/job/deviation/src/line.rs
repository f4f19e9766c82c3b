//! A line as pieces with distances along it.

use cplan_geometry::Point;
use cplan_text::length;
use cplan_toolpath::{Curve, Piece, Source, Toolpath};
use std::fmt;

/// A place on a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Index of the piece, from 0.
    pub piece: usize,
    /// The piece's parameter, from 0 to 1.
    pub u: f64,
    /// Distance along the line, metres.
    pub distance: f64,
    /// The point in the plane, metres.
    pub point: Point,
    /// Place of the piece in the file.
    pub source: Source,
}

impl fmt::Display for Place {
    /// Writes the distance along the line, and the number of the file's line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of the line (line {} of the file)", length(self.distance), self.source.line)
    }
}

/// A line with the distance at which each piece begins.
pub struct Line<'a> {
    /// The pieces, in order.
    pub pieces: &'a [Piece],
    begins: Vec<f64>,
}

impl<'a> Line<'a> {
    /// Measures the pieces of a line. `O(n)` for `n` pieces.
    pub fn new(path: &'a Toolpath) -> Self {
        Self::of(path.pieces())
    }

    /// Does the same as [`Line::new`] for a sequence of at least one piece.
    pub fn of(pieces: &'a [Piece]) -> Self {
        let mut at = 0.0;
        let begin = |piece: &Piece| {
            let begin = at;
            at += piece.curve.length();
            begin
        };
        Self { pieces, begins: pieces.iter().map(begin).collect() }
    }

    /// Returns the curve of a piece.
    pub fn curve(&self, piece: usize) -> &'a Curve {
        &self.pieces[piece].curve
    }

    /// Returns the place at a parameter of a piece.
    pub fn place(&self, piece: usize, u: f64) -> Place {
        let Piece { curve, source, .. } = &self.pieces[piece];
        let distance = self.begins[piece] + curve.length_to(u);
        Place { piece, u, distance, point: curve.at(u).into(), source: *source }
    }
}
