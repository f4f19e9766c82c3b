//! The line as the planner sees it: pieces with distances along it.

use cplan_geometry::Point;
use cplan_toolpath::{Curve, Piece, Source, Toolpath};

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

/// A line with the distance at which each piece begins.
pub(crate) struct Line<'a> {
    pub pieces: &'a [Piece],
    begins: Vec<f64>,
}

impl<'a> Line<'a> {
    pub fn new(path: &'a Toolpath) -> Self {
        let mut at = 0.0;
        let begin = |piece: &Piece| {
            let begin = at;
            at += piece.curve.length();
            begin
        };
        Self { pieces: path.pieces(), begins: path.pieces().iter().map(begin).collect() }
    }

    pub fn curve(&self, piece: usize) -> &'a Curve {
        &self.pieces[piece].curve
    }

    pub fn place(&self, piece: usize, u: f64) -> Place {
        let Piece { curve, source, .. } = &self.pieces[piece];
        let distance = self.begins[piece] + curve.length_to(u);
        Place { piece, u, distance, point: curve.at(u).into(), source: *source }
    }
}
