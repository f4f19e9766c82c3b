//! A line as a sequence of pieces.

use crate::curve::{minus, norm};
use crate::{Curve, Error, Placement, Point, cusps};
use serde::{Deserialize, Serialize};

/// Greatest number of pieces of a line.
pub const MAX_PIECES: usize = 1_000_000;

/// Greatest absolute value of a coordinate, metres. It is the same for obstacles.
const MAX_COORDINATE: f64 = 1e6;

/// The next piece may begin this far from the end of a piece, metres. A smaller gap is rounding.
const MAX_GAP: f64 = 1e-9;

/// A place in a file, both numbers from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Number of the line.
    pub line: usize,
    /// Number of the character in the line; `None` if only the line is known.
    pub column: Option<usize>,
}

impl Source {
    /// Returns the place of a whole line.
    pub fn of_line(line: usize) -> Self {
        Self { line, column: None }
    }
}

/// A piece of a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// The curve.
    pub curve: Curve,
    /// Speed of the tip that the file states, metres per second; `None` without one.
    pub speed: Option<f64>,
    /// True if the tip only travels to the beginning of the next piece (G0). The file's speed does not apply then.
    pub is_travel: bool,
    /// Time for which the tip rests at the end of the piece, seconds. `None` if it need not stop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dwell: Option<f64>,
    /// Place of the piece in the file.
    pub source: Source,
}

impl Piece {
    /// Checks that no coordinate is too large.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let Source { line, column } = self.source;
        if self.curve.is_within(MAX_COORDINATE) {
            return Ok(());
        }
        let message = format!("the line has a coordinate beyond {MAX_COORDINATE:.0e} m");
        Err(Error::new(line, column, message, "check the unit of the file, and --scale and --move"))
    }
}

/// A line in the plane: a sequence of at least one piece. Each piece begins where the previous one ends, and has a length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Piece>", into = "Vec<Piece>")]
pub struct Toolpath {
    pieces: Vec<Piece>,
    notes: Vec<String>,
}

impl Toolpath {
    /// Creates a line. Omits pieces without a length. Cuts cubic curves at cusps, where they reverse or almost do, so that cusps
    /// are ends of pieces.
    ///
    /// # Errors
    /// No piece with a length, gaps between pieces, more than [`MAX_PIECES`] pieces, and numbers that are too large or not
    /// finite.
    pub fn new(pieces: Vec<Piece>) -> Result<Self, Error> {
        let mut kept: Vec<Piece> = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let Source { line, column } = piece.source;
            piece.check()?;
            let last = kept.last().map(|before| before.curve.end());
            let gap = last.map_or(0.0, |end| norm(minus(end, piece.curve.start())));
            if gap > MAX_GAP * (1.0 + norm(piece.curve.start())) {
                let message = "this piece does not begin where the previous piece ends";
                return Err(Error::new(line, column, message, "add a travel between the two pieces"));
            }
            let parts = cusps::parts(&piece.curve).into_iter().filter(|curve| curve.length() > 0.0);
            kept.extend(parts.map(|curve| Piece { curve, dwell: None, ..piece }));
            // A dwell before the first piece is at the start of the line, where the tip rests anyway.
            if let Some((seconds, last)) = piece.dwell.zip(kept.last_mut()) {
                last.dwell = Some(last.dwell.unwrap_or(0.0) + seconds);
            }
        }
        if kept.len() > MAX_PIECES {
            let hint = "split the file into several";
            return Err(Error::new(None, None, format!("the line has more than {MAX_PIECES} pieces"), hint));
        }
        if kept.is_empty() {
            return Err(Error::new(None, None, "the file has no line", "add at least one piece with a length"));
        }
        Ok(Self { pieces: kept, notes: Vec::new() })
    }

    /// Adds notes about omissions and assumptions.
    #[must_use]
    pub fn with_notes(self, notes: Vec<String>) -> Self {
        Self { notes, ..self }
    }

    /// Returns the line, placed in the plane.
    ///
    /// # Errors
    /// If a coordinate becomes too large.
    pub fn placed(&self, placement: &Placement) -> Result<Self, Error> {
        let place = |piece: &Piece| Piece { curve: placement.place(&piece.curve), ..*piece };
        Self::new(self.pieces.iter().map(place).collect()).map(|path| path.with_notes(self.notes.clone()))
    }

    /// Returns the pieces, in order.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Returns notes for the user about omissions and assumptions of the reader.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the length, metres.
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.curve.length()).sum()
    }

    /// Returns the point where the line begins.
    pub fn start(&self) -> Point {
        self.pieces[0].curve.start()
    }

    /// Returns the point where the line ends.
    pub fn end(&self) -> Point {
        self.pieces[self.pieces.len() - 1].curve.end()
    }

    /// Returns points on the line, for pictures. The chords between them are within `tolerance` metres of the curves. A travel
    /// separates one inner list from the next.
    pub fn outlines(&self, tolerance: f64) -> Vec<Vec<Point>> {
        const MAX_CHORDS: f64 = 1e4;
        let mut outlines: Vec<Vec<Point>> = Vec::new();
        let mut is_joined = false;
        for piece in &self.pieces {
            if !piece.is_travel {
                if !is_joined {
                    outlines.push(vec![piece.curve.start()]);
                }
                let count = (piece.curve.bend() / (8.0 * tolerance)).sqrt().ceil().clamp(1.0, MAX_CHORDS);
                let points = (1..=count as u32).map(|k| piece.curve.at(f64::from(k) / count));
                outlines.last_mut().expect("one was begun").extend(points);
            }
            is_joined = !piece.is_travel;
        }
        outlines
    }
}

impl TryFrom<Vec<Piece>> for Toolpath {
    type Error = Error;

    fn try_from(pieces: Vec<Piece>) -> Result<Self, Error> {
        Self::new(pieces)
    }
}

impl From<Toolpath> for Vec<Piece> {
    fn from(path: Toolpath) -> Self {
        path.pieces
    }
}
