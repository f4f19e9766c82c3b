//! The state of a machine that runs G-code.

mod arcs;
mod dwells;
mod finish;

use super::block::Block;
use super::meaning::{self, OPTIONAL, OTHER_SYSTEM, Slot, UNSTATED_ORIGIN};
use super::origin::Origin;
use super::program::Modes;
use super::remarks::Remarks;
use super::words::{Line, Word};
use crate::path::Piece;
use crate::{Curve, Error, Placement, Point, Source};
use cplan_text::Unit;

const INCH: f64 = 0.0254;
const SECONDS_PER_MINUTE: f64 = 60.0;

/// The command of Grbl and its descendants that moves the tip to the machine's home.
const HOMING: &str = "$H";

/// The kinds of moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Move {
    /// G0.
    Travel,
    /// G1.
    Line,
    /// G2 and G3.
    Arc { is_left: bool },
}

/// The state between two lines of a program.
#[derive(Default)]
pub(super) struct Machine {
    placement: Placement,
    /// Metres per unit of length.
    unit: f64,
    says_unit: bool,
    is_relative: bool,
    /// True if the centres of arcs are coordinates (G90.1).
    has_absolute_centers: bool,
    motion: Option<Move>,
    /// Metres per second.
    speed: Option<f64>,
    origin: Origin,
    /// Number of the coordinate system: 54 for G54.
    system: f64,
    /// Seconds per unit of P in dwells; `None` before the first one.
    dwell_unit: Option<f64>,
    /// True for programs of printers and plotters.
    pub is_firmware: bool,
    /// Sum of all dwells, seconds.
    dwells: f64,
    has_begun: bool,
    pieces: Vec<Piece>,
    /// For each piece, the modes of the line that states it.
    modes: Vec<Modes>,
    /// Height of the tool, metres; `None` if the program has not stated it.
    height: Option<f64>,
    /// Position of the tip after homing. `None` if it is unknown.
    home: Option<Point>,
    /// Moves whose beginning the program does not state.
    unstated: Vec<Source>,
    remarks: Remarks,
    /// Notes for the user about assumptions.
    notes: Vec<String>,
}

impl Machine {
    /// Creates a machine that refuses moves to positions of the machine.
    pub fn new(placement: Placement) -> Self {
        let unit = placement.unit.unwrap_or(Unit::MILLIMETER).metres();
        Self { placement, unit, system: 54.0, ..Self::default() }
    }

    /// Allows moves to positions of the machine, such as G28. They lead to `home`, where the program also begins; if `home` is
    /// `None`, they lead to an unknown position.
    pub fn with_homing(mut self, home: Option<Point>) -> Self {
        (self.home, self.remarks.allows_homes) = (home, true);
        self.go_home();
        self
    }

    fn go_home(&mut self) {
        (self.origin.is_known, self.height) = ([false; 2], None);
        self.home.into_iter().for_each(|home| self.origin.advance(home));
    }

    /// Runs a line. Returns true if it ends the program. Records words that cannot be followed.
    ///
    /// # Errors
    /// If a word has no number, or if words contradict each other or describe no move.
    pub fn run(&mut self, line: &Line) -> Result<bool, Error> {
        let is_first = !self.has_begun;
        self.has_begun |= !matches!(line, Line::Words(words) if words.is_empty());
        match line {
            Line::Percent => return Ok(!is_first),
            Line::Optional(source) if self.remarks.allows_homes => self.remarks.refuse("/".into(), OPTIONAL, *source),
            Line::Optional(_) => self.remarks.list("/, left out".into()),
            Line::Command(name, source) => match meaning::of_command(name) {
                Some(reason) => self.remarks.refuse(name.clone(), reason, *source),
                None => {
                    self.remarks.is_home = name == HOMING;
                    self.remarks.list(name.clone());
                }
            },
            Line::Words(words) => {
                if let Some(block) = Block::new(words, &mut self.remarks)? {
                    self.run_block(&block)?;
                    return Ok(block.get(Slot::End).is_some());
                }
            }
        }
        if self.remarks.takes_home() {
            self.go_home();
        }
        Ok(false)
    }

    /// Returns an error if lines follow the end of the program, because some machines run such lines. Only for machines with
    /// allowed homing. `end` is the number of the line that ends the program.
    pub fn after_end<'l>(
        &self,
        end: usize,
        mut left: impl Iterator<Item = (&'l Result<Line, Error>, usize)>,
    ) -> Option<Error> {
        let has_moves = |line: &Result<Line, Error>| match line {
            Ok(Line::Words(words)) => words.iter().any(|word| "GXYZ".contains(word.letter)),
            Ok(Line::Percent) => false,
            Ok(Line::Optional(_) | Line::Command(..)) | Err(_) => true,
        };
        let (_, number) = left.find(|(line, _)| has_moves(line)).filter(|_| self.remarks.allows_homes)?;
        let message = format!("this line follows the end of the program (line {end}), but some machines run it");
        Some(Error::new(number, None, message, "remove the lines after the end, or remove the end"))
    }

    fn run_block(&mut self, block: &Block) -> Result<(), Error> {
        self.set_modes(block)?;
        if let Some(word) = block.get(Slot::Dwell) {
            return self.dwell(block, word);
        }
        if let Some(word) = block.get(Slot::Shift) {
            return self.shift(block, word);
        }
        let rise = self.lift(block);
        match [Slot::X, Slot::Y, Slot::I, Slot::J, Slot::R].into_iter().find_map(|slot| block.get(slot)) {
            Some(first) => self.draw(block, first, rise),
            None => Ok(()),
        }
    }

    /// Applies words that stay in force.
    fn set_modes(&mut self, block: &Block) -> Result<(), Error> {
        if let Some(value) = block.value(Slot::Unit) {
            self.says_unit = true;
            let stated = if value == 20.0 { INCH } else { Unit::MILLIMETER.metres() };
            self.unit = self.placement.unit.map_or(stated, Unit::metres);
        }
        if let Some(value) = block.value(Slot::Distance) {
            self.is_relative = value == 91.0;
        }
        if let Some(value) = block.value(Slot::Centers) {
            self.has_absolute_centers = value == 90.1;
        }
        if let Some((word, value)) = block.get(Slot::System).zip(block.value(Slot::System)) {
            if value != self.system && self.origin.has_begun() {
                self.remarks.refuse(word.text.clone(), OTHER_SYSTEM, word.source);
            }
            self.system = value;
        }
        if let Some((word, value)) =
            block.get(Slot::F).zip(block.value(Slot::F)).filter(|_| block.get(Slot::Dwell).is_none())
        {
            if value <= 0.0 {
                return Err(word.error("is not a speed", "give a speed above 0, in units per minute"));
            }
            self.speed = Some(value * self.unit / SECONDS_PER_MINUTE);
        }
        if block.get(Slot::NoMotion).is_some() {
            self.motion = None;
        }
        if let Some(value) = block.value(Slot::Motion) {
            self.motion = Some(match value {
                0.0 => Move::Travel,
                1.0 => Move::Line,
                value => Move::Arc { is_left: value == 3.0 },
            });
        }
        Ok(())
    }

    /// Moves the origin of coordinates (G92).
    fn shift(&mut self, block: &Block, word: &Word) -> Result<(), Error> {
        if let Some(motion) = block.get(Slot::Motion) {
            let message = format!("and {} are on the same line", motion.text);
            return Err(word.error(&message, "write each on a line of its own"));
        }
        let is_stated = match word.value {
            Some(92.1) => self.origin.reset(false),
            Some(92.2) => self.origin.reset(true),
            Some(92.3) => {
                self.origin.restore();
                true
            }
            _ => {
                if block.with_letters("XYZABCUVWE").next().is_none() {
                    let hint = "name the coordinates that become those of the tip, such as G92 X0 Y0";
                    return Err(word.error("has no coordinates", hint));
                }
                if let Some(stated) = block.with_letters("Z").next().and_then(|word| word.value) {
                    self.height = Some(stated * self.unit);
                }
                self.origin.state([Slot::X, Slot::Y].map(|slot| block.value(slot).map(|value| value * self.unit)));
                true
            }
        };
        if !is_stated {
            self.remarks.refuse(word.text.clone(), UNSTATED_ORIGIN, word.source);
        }
        Ok(())
    }

    /// Sets the height of the tool. Returns by how much the tool rises, if that is known.
    fn lift(&mut self, block: &Block) -> Option<f64> {
        if block.get(Slot::Home).is_some() {
            self.height = None;
            return None;
        }
        let stated = block.with_letters("Z").next()?.value? * self.unit;
        let before = self.height;
        let rise = if self.is_relative { Some(stated) } else { before.map(|before| stated - before) };
        self.height = if self.is_relative { before.map(|before| before + stated) } else { Some(stated) };
        rise
    }

    /// Adds the move of a line. `first` is the line's first coordinate; the tool rises by `rise`.
    fn draw(&mut self, block: &Block, first: &Word, rise: Option<f64>) -> Result<(), Error> {
        let Some(motion) = self.motion else {
            return Err(first.error("has no kind of move", "write G0, G1, G2 or G3 before it"));
        };
        if !matches!(motion, Move::Arc { .. })
            && let Some(word) = [Slot::I, Slot::J, Slot::R].into_iter().find_map(|slot| block.get(slot))
        {
            return Err(word.error("belongs to an arc, but this is a straight move", "write G2 or G3 before it"));
        }
        let from = self.origin.at;
        let origin = self.origin.place([0.0; 2]);
        let to = [(Slot::X, 0), (Slot::Y, 1)].map(|(slot, k)| match block.value(slot).map(|value| value * self.unit) {
            Some(value) if self.is_relative => from[k] + value,
            Some(value) => origin[k] + value,
            None => from[k],
        });
        let source = block.get(Slot::Motion).unwrap_or(first).source;
        if !self.origin.is_known() {
            return self.begin(block, first, motion, to);
        }
        let curve = match motion {
            Move::Travel | Move::Line => Ok(Curve::Line { from, to }),
            Move::Arc { is_left } => self.arc(block, first, to, is_left),
        };
        self.origin.advance(to);
        let is_travel = motion == Move::Travel;
        self.remarks.drawn += usize::from(!is_travel);
        let speed = self.speed.filter(|_| !is_travel);
        self.pieces.push(Piece { curve: curve?, speed, is_travel, dwell: None, source });
        let words = [block.get(Slot::X), block.get(Slot::Y), block.with_letters("Z").next()];
        let words = words.map(|word| word.and_then(|word| Some(word.source.column? - 1..word.end)));
        let (is_rapid, unit, is_relative, feed) = (is_travel, self.unit, self.is_relative, self.speed);
        self.modes.push(Modes { is_rapid, unit, is_relative, origin, words, feed, rise });
        Ok(())
    }

    /// Runs the first move, whose beginning the program does not state. The tip's line begins where this move ends.
    fn begin(&mut self, block: &Block, first: &Word, motion: Move, to: Point) -> Result<(), Error> {
        let word = block.get(Slot::Motion).unwrap_or(first);
        if matches!(motion, Move::Arc { .. }) {
            let message = "is the first move, but the file does not state where the tip is before it";
            return Err(word.error(message, "write a travel (G0) before this arc, to the place where the arc begins"));
        }
        let is_missing = |slot: Slot| self.is_relative || block.get(slot).is_none();
        let axes = [(Slot::X, 0, "X"), (Slot::Y, 1, "Y")];
        let missing = axes.into_iter().filter(|(slot, k, _)| !self.origin.is_known[*k] && is_missing(*slot));
        let (missing, names): (Vec<usize>, Vec<&str>) = missing.map(|(_, k, name)| (k, name)).unzip();
        self.unstated.push(word.source);
        if self.remarks.allows_homes {
            for k in (0..2).filter(|k| !missing.contains(k)) {
                (self.origin.at[k], self.origin.is_known[k]) = (to[k], true);
            }
            return Ok(());
        }
        if !names.is_empty() {
            let stated = names.join(" and ");
            self.notes.push(format!("the file does not state {stated} of the line's beginning: read as 0"));
        }
        if motion == Move::Line {
            let line = word.source.line;
            self.notes.push(format!(
                "the first move (G1, line {line}) is left out, because the file does not state where it begins"
            ));
        }
        self.origin.advance(to);
        Ok(())
    }

    /// Returns the error that lists all words that cannot be followed.
    pub fn refusal(&mut self) -> Option<Error> {
        self.remarks.error()
    }
}
