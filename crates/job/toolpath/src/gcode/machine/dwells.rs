//! Dwells: the tip rests for a time (G4).

use super::Machine;
use crate::gcode::block::Block;
use crate::gcode::words::Word;
use crate::{Error, Toolpath};
use cplan_text::counted;

const SECONDS_PER_MILLISECOND: f64 = 1e-3;

/// Longest dwell, seconds: a day. A longer one is probably written in another unit.
const MAX_DWELL: f64 = 86_400.0;

/// A smaller sum of dwells is rounding, seconds.
const MIN_DWELL: f64 = 1e-9;

impl Machine {
    /// Rests (G4).
    ///
    /// # Errors
    /// If the line is also a move, or has no valid time.
    pub(super) fn dwell(&mut self, block: &Block, word: &Word) -> Result<(), Error> {
        if let Some(other) = block.with_letters("YIJR").next() {
            return Err(other.error("belongs to a move, but this line is a dwell", "write G4 on a line of its own"));
        }
        let mut times = block.with_letters("PSXUF");
        let (time, another) = (times.next(), times.next());
        if let Some(another) = another {
            return Err(another.error("is a second time for this dwell", "write G4 with one time on a line of its own"));
        }
        let unit = match (time, self.is_firmware) {
            (Some(Word { letter: 'P', .. }), is_firmware) => {
                *self.dwell_unit.insert(if is_firmware { SECONDS_PER_MILLISECOND } else { 1.0 })
            }
            _ => 1.0,
        };
        let seconds = time.and_then(|time| time.value).unwrap_or(0.0) * unit;
        if !(0.0..=MAX_DWELL).contains(&seconds) {
            let message = format!("is not a time from 0 to {MAX_DWELL} s");
            return Err(time.unwrap_or(word).error(&message, "write the time in seconds, such as G4 S0.5"));
        }
        self.dwells += seconds;
        if let Some(last) = self.pieces.last_mut() {
            last.dwell = Some(last.dwell.unwrap_or(0.0) + seconds);
        }
        Ok(())
    }

    pub(super) fn dwell_note(&self, path: &Toolpath) -> Option<String> {
        let inner = path.pieces().split_last().map_or(&[][..], |(_, inner)| inner);
        let rests: Vec<f64> = inner.iter().filter_map(|piece| piece.dwell).collect();
        let rest: f64 = rests.iter().sum();
        let unit = match self.dwell_unit {
            Some(SECONDS_PER_MILLISECOND) => "; P counts milliseconds",
            Some(_) => "; P counts seconds",
            None => "",
        };
        let shown = |seconds: f64| format!("{} s", (seconds * 1e6).round() / 1e6);
        let left_out = self.dwells - rest;
        let inner =
            (!rests.is_empty()).then(|| format!("{} of {} in all (G4)", counted(rests.len(), "stop"), shown(rest)));
        let is_left_out = left_out > MIN_DWELL;
        let ends = is_left_out
            .then(|| format!("stops (G4) before and after the line, {} in all, are left out", shown(left_out)));
        let parts: Vec<String> = inner.into_iter().chain(ends).collect();
        (!parts.is_empty()).then(|| format!("{}{unit}", parts.join("; ")))
    }
}
