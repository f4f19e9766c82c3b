//! A program move by move, for programs that write it again.

use crate::{Piece, Point, Source};
use std::ops::Range;

/// The moves of a program in the plane. Travels before the first and after the last line are included.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// All moves with a length, in order. Each begins where the one before ends, except after a move in [`Self::unstated`].
    pub moves: Vec<ProgramMove>,
    /// Moves from places that the program does not state: the first ones, and the first ones after homing.
    pub unstated: Vec<Source>,
    /// Notes for the user about assumptions, and about words without an effect in the plane.
    pub notes: Vec<String>,
}

/// A move of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgramMove {
    /// The move in the coordinates with which the program begins.
    pub piece: Piece,
    /// The form in which the line of the file states it.
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
    /// The words X, Y and Z as ranges of characters of the line; `None` for a word that the line does not have.
    pub words: [Option<Range<usize>>; 3],
    /// Speed of the last F up to this line, metres per second; `None` if the program has stated none. It also holds for G0.
    pub feed: Option<f64>,
    /// Difference of the tool's height by the word Z, metres; `None` if it is unknown or there is no such word.
    pub rise: Option<f64>,
}
