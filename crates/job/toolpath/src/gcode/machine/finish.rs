//! The line that a program has drawn.

use super::Machine;
use crate::Error;
use crate::path::{Piece, Toolpath};
use cplan_text::counted;

impl Machine<'_> {
    /// Returns the line.
    ///
    /// # Errors
    /// If the program has no line.
    pub fn finish(self) -> Result<Toolpath, Error> {
        let placed = |piece: &Piece| Piece { curve: self.placement.place(&piece.curve), ..*piece };
        // Where a travel leads to nothing, the tip would only leave the line.
        let is_drawn = |piece: &Piece| !piece.is_travel;
        let before = self.pieces.iter().position(is_drawn).unwrap_or(self.pieces.len());
        let after = self.pieces.len() - self.pieces.iter().rposition(is_drawn).map_or(before, |last| last + 1);
        let drawn = &self.pieces[before..self.pieces.len() - after];
        if drawn.iter().all(|piece| piece.curve.length() == 0.0) {
            let hint = "add at least one move (G1) after the first one, which says where the line begins";
            return Err(Error::new(None, None, "the file has no line", hint));
        }
        let path = Toolpath::new(drawn.iter().map(placed).collect())?;
        let mut notes = self.notes.clone();
        if !self.says_unit && self.placement.unit.is_none() {
            notes.push("the file states no unit (G20 or G21): read as mm".to_owned());
        }
        for (left_out, place) in [(before, "before the first piece"), (after, "after the last piece")] {
            if left_out > 0 {
                notes.push(format!("{} (G0) {place} left out", counted(left_out, "travel")));
            }
        }
        notes.extend(self.dwell_note(&path));
        notes.extend(self.remarks.note());
        Ok(path.with_notes(notes))
    }
}
