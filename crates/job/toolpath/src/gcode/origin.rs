//! The position of the tip, and the coordinate origin that G92 moves.

use crate::Point;

/// The tip's position and the coordinate origin, metres, both in the program's initial coordinates.
#[derive(Default)]
pub(super) struct Origin {
    pub at: Point,
    /// Position of the current origin.
    shift: Point,
    /// The last origin that G92 stated, for G92.3.
    stored: Point,
    /// For each coordinate of the tip: true if the program has stated it.
    pub is_known: [bool; 2],
    /// True if G92 replaced coordinates although the program had not stated them.
    is_unstated: bool,
}

impl Origin {
    /// Returns true if the program has stated where the tip is.
    pub fn is_known(&self) -> bool {
        self.is_known == [true; 2]
    }

    /// Returns true if the program has moved the tip, or has stated one of its coordinates.
    pub fn has_begun(&self) -> bool {
        self.is_known != [false; 2]
    }

    /// Returns the position with these coordinates.
    pub fn place(&self, coordinates: Point) -> Point {
        [0, 1].map(|k| self.shift[k] + coordinates[k])
    }

    /// Moves the tip.
    pub fn advance(&mut self, to: Point) {
        (self.at, self.is_known) = (to, [true; 2]);
    }

    /// Moves the origin so that the tip has these coordinates (G92).
    pub fn state(&mut self, coordinates: [Option<f64>; 2]) {
        for (k, value) in coordinates.into_iter().enumerate() {
            let Some(value) = value else { continue };
            if self.is_known[k] {
                self.shift[k] = self.at[k] - value;
            } else {
                self.at[k] = self.shift[k] + value;
                (self.is_known[k], self.is_unstated) = (true, true);
            }
        }
        self.stored = self.shift;
    }

    /// Moves the origin back to where it was before G92. The moved origin can be restored later if `is_kept`. Returns false if
    /// the program has not stated the earlier origin.
    pub fn reset(&mut self, is_kept: bool) -> bool {
        self.shift = [0.0; 2];
        if !is_kept {
            self.stored = [0.0; 2];
        }
        !self.is_unstated
    }

    /// Moves the origin to where the last G92 had moved it (G92.3).
    pub fn restore(&mut self) {
        self.shift = self.stored;
    }
}
