//! The line that a program has drawn.

use super::Machine;
use crate::gcode::program::{Program, ProgramMove};
use crate::path::{Piece, Toolpath};
use crate::{Error, MAX_PIECES};
use cplan_text::counted;

impl Machine {
    /// Returns the line.
    ///
    /// # Errors
    /// If the program has no line.
    pub fn finish(self) -> Result<Toolpath, Error> {
        let placed = |piece: &Piece| Piece { curve: self.placement.place(&piece.curve), ..*piece };
        // A travel with nothing drawn before or after it would only lead away from the line.
        let is_drawn = |piece: &Piece| !piece.is_travel;
        let before = self.pieces.iter().position(is_drawn).unwrap_or(self.pieces.len());
        let after = self.pieces.len() - self.pieces.iter().rposition(is_drawn).map_or(before, |last| last + 1);
        let drawn = &self.pieces[before..self.pieces.len() - after];
        if drawn.iter().all(|piece| piece.curve.length() == 0.0) {
            return Err(no_line());
        }
        let path = Toolpath::new(drawn.iter().map(placed).collect())?;
        let mut own = Vec::new();
        for (left_out, place) in [(before, "before the first piece"), (after, "after the last piece")] {
            if left_out > 0 {
                own.push(format!("{} (G0) {place} left out", counted(left_out, "travel")));
            }
        }
        own.extend(self.dwell_note(&path));
        let notes = self.notes_with(own);
        Ok(path.with_notes(notes))
    }

    pub fn program(self) -> Result<Program, Error> {
        let notes = self.notes_with(Vec::new());
        let moves = self.pieces.into_iter().zip(self.modes).map(|(piece, modes)| ProgramMove { piece, modes });
        let moves: Vec<ProgramMove> = moves.filter(|own| own.piece.curve.length() > 0.0).collect();
        moves.iter().try_for_each(|own| own.piece.check())?;
        if moves.len() > MAX_PIECES {
            let message = format!("the program has more than {MAX_PIECES} moves");
            return Err(Error::new(None, None, message, "split the file into several"));
        }
        if let (true, Some(first)) = (moves.is_empty(), self.unstated.first()) {
            let message = "the file does not state where its moves begin";
            let hint = "state the place of the tip at the beginning (--home), or begin with coordinates (G90, G0 X Y)";
            return Err(Error::new(first.line, first.column, message, hint));
        }
        if moves.is_empty() {
            return Err(no_line());
        }
        Ok(Program { moves, unstated: self.unstated, notes })
    }

    /// Returns all notes: `own` ones, then those about words without an effect.
    fn notes_with(&self, own: Vec<String>) -> Vec<String> {
        let mut notes = self.notes.clone();
        if !self.says_unit && self.placement.unit.is_none() {
            notes.push("the file states no unit (G20 or G21): read as mm".to_owned());
        }
        notes.extend(own);
        notes.extend(self.remarks.note());
        notes
    }
}

fn no_line() -> Error {
    let hint = "add at least one move (G1) after the first move, which only states where the line begins";
    Error::new(None, None, "the file has no line", hint)
}
