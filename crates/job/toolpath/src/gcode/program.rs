//! A program as single moves, for code that rewrites programs.

use crate::{Piece, Point, Source};
use std::ops::Range;

/// The moves of a program in the plane. Travels before the first and after the last line are included.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// All moves with a length, in order. Each begins where the previous one ends, except after a move in [`Self::unstated`].
    pub moves: Vec<ProgramMove>,
    /// Moves whose beginning the program does not state: the first ones, and the first ones after homing.
    pub unstated: Vec<Source>,
    /// Notes for the user about assumptions, and about words without an effect in the plane.
    pub notes: Vec<String>,
}

/// A move of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgramMove {
    /// The move, in the program's initial coordinates.
    pub piece: Piece,
    /// The modes in which the program states it.
    pub modes: Modes,
}

/// The modes in which a line states its move, and the places of its words.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// True for G0, false for G1 to G3.
    pub is_rapid: bool,
    /// Metres per unit of length.
    pub unit: f64,
    /// True if coordinates are displacements (G91).
    pub is_relative: bool,
    /// Place of the origin of coordinates, metres.
    pub origin: Point,
    /// The words X, Y and Z as ranges of characters in the line. `None` for a missing word.
    pub words: [Option<Range<usize>>; 3],
    /// Speed of the last F up to this line, metres per second. `None` if the program has stated none. G0 has it, too.
    pub feed: Option<f64>,
    /// Rise of the tool by the word Z, metres. `None` if it is unknown, or without such a word.
    pub rise: Option<f64>,
}
