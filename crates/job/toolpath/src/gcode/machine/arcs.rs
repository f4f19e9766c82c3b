//! Arcs (G2 and G3).

use super::{INCH, Machine};
use crate::gcode::block::Block;
use crate::gcode::meaning::Slot;
use crate::gcode::words::Word;
use crate::{Curve, Error, Point, arc};

impl Machine {
    /// Returns the arc from the tip's position to a point. `first` is the first coordinate on the program's line.
    ///
    /// # Errors
    /// If the line does not describe an arc to that point.
    pub(super) fn arc(&self, block: &Block, first: &Word, to: Point, is_left: bool) -> Result<Curve, Error> {
        let (at, word) = (self.origin.at, block.get(Slot::Motion).unwrap_or(first));
        let value = |slot: Slot| block.value(slot).map(|value| value * self.unit);
        if let Some(turns) = block.with_letters("P").find(|turns| turns.value != Some(1.0)) {
            return Err(turns.error("gives an arc several turns", "write an arc for each turn"));
        }
        match (value(Slot::I), value(Slot::J), value(Slot::R)) {
            (None, None, None) => Err(word.error("has neither a centre nor a radius", "add I and J, or R")),
            (None, None, Some(radius)) => arc::with_radius(at, to, radius, is_left).ok_or_else(|| {
                if to == at {
                    return word.error("ends where it begins, so R does not determine the centre", "use I and J");
                }
                let chord = (to[0] - at[0]).hypot(to[1] - at[1]);
                let message = format!("has ends {} apart, more than twice its radius", self.shown(chord));
                word.error(&message, format!("give a radius of at least {}", self.shown(chord / 2.0)))
            }),
            (_, _, Some(_)) => Err(word.error("has a centre and a radius", "keep I and J, or R")),
            (Some(i), Some(j), None) if self.has_absolute_centers => {
                self.about(word, to, self.origin.place([i, j]), is_left)
            }
            _ if self.has_absolute_centers => {
                let hint = "write both I and J, the coordinates of the centre (G90.1)";
                Err(word.error("has only one coordinate of the centre", hint))
            }
            (i, j, None) => self.about(word, to, [at[0] + i.unwrap_or(0.0), at[1] + j.unwrap_or(0.0)], is_left),
        }
    }

    fn about(&self, word: &Word, to: Point, center: Point, is_left: bool) -> Result<Curve, Error> {
        arc::about(self.origin.at, to, center, is_left).map_err(|[first, last]| {
            let message = format!(
                "begins at a distance of {} from the centre, but ends at {}",
                self.shown(first),
                self.shown(last)
            );
            let hint = match self.has_absolute_centers {
                true => "write I and J, the coordinates of the centre (G90.1), with more digits",
                false => "write I and J, which count from the start of the arc (G91.1), with more digits",
            };
            word.error(&message, hint)
        })
    }

    /// Formats a length in the unit of the file.
    fn shown(&self, length: f64) -> String {
        let unit = match self.placement.unit {
            Some(unit) => unit.to_string(),
            None if self.unit == INCH => "in".into(),
            None => "mm".into(),
        };
        format!("{} {unit}", (length / self.unit * 1e6).round() / 1e6)
    }
}
