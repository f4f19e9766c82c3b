//! The state of a machine that runs G-code.

use super::words::Word;
use crate::arc;
use crate::path::{Piece, Toolpath};
use crate::{Curve, Error, Placement, Point};
use cplan_text::{Unit, counted};

const INCH: f64 = 0.0254;
const SECONDS_PER_MINUTE: f64 = 60.0;

/// The words that the reader accepts, for hints.
const ACCEPTED: &str = "cplan reads G0 G1 G2 G3 G17 G20 G21 G90 G91, F I J N R X Y, M2 and M30; remove this word";

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

/// The words of a block by their purpose.
#[derive(Default)]
struct Block<'w> {
    motion: Option<&'w Word>,
    unit: Option<&'w Word>,
    distance: Option<&'w Word>,
    end: Option<&'w Word>,
    /// The words F, I, J, R, X and Y.
    values: [Option<&'w Word>; 6],
}

const VALUES: [char; 6] = ['F', 'I', 'J', 'R', 'X', 'Y'];
const F: usize = 0;
const I: usize = 1;
const J: usize = 2;
const R: usize = 3;
const X: usize = 4;
const Y: usize = 5;

/// The state between two blocks.
pub(super) struct Machine<'p> {
    placement: &'p Placement,
    /// Metres per unit of length.
    unit: f64,
    says_unit: bool,
    is_relative: bool,
    motion: Option<Move>,
    /// Metres per second.
    speed: Option<f64>,
    /// The place of the tip in metres, before the placement.
    at: Point,
    /// False until the first move, before which the place of the tip is not known.
    has_place: bool,
    pieces: Vec<Piece>,
}

impl<'p> Machine<'p> {
    pub fn new(placement: &'p Placement) -> Self {
        Self {
            placement,
            unit: placement.unit.unwrap_or(Unit::MILLIMETER).metres(),
            says_unit: false,
            is_relative: false,
            motion: None,
            speed: None,
            at: [0.0; 2],
            has_place: false,
            pieces: Vec::new(),
        }
    }

    /// Runs a block. Returns true if the program ends there.
    ///
    /// # Errors
    /// If the block has a word that cannot be followed, or words that contradict each other.
    pub fn run(&mut self, words: &[Word]) -> Result<bool, Error> {
        let block = sort(words)?;
        if let Some(word) = block.unit {
            self.says_unit = true;
            let stated = if word.value == 20.0 { INCH } else { Unit::MILLIMETER.metres() };
            self.unit = self.placement.unit.map_or(stated, Unit::metres);
        }
        if let Some(word) = block.distance {
            self.is_relative = word.value == 91.0;
        }
        if let Some(word) = block.values[F] {
            if word.value <= 0.0 {
                return Err(word.error("is not a speed", "give a speed above 0, in units per minute"));
            }
            self.speed = Some(word.value * self.unit / SECONDS_PER_MINUTE);
        }
        if let Some(word) = block.motion {
            self.motion = Some(match word.value {
                0.0 => Move::Travel,
                1.0 => Move::Line,
                value => Move::Arc { is_left: value == 3.0 },
            });
        }
        if let Some(word) = [X, Y, I, J, R].into_iter().find_map(|k| block.values[k]) {
            self.draw(&block, word)?;
        }
        Ok(block.end.is_some())
    }

    /// Adds the move of a block. `first` is its first coordinate.
    fn draw(&mut self, block: &Block, first: &Word) -> Result<(), Error> {
        let Some(motion) = self.motion else {
            return Err(first.error("has no kind of move", "write G0, G1, G2 or G3 before it"));
        };
        let value = |k: usize| block.values[k].map(|word| word.value * self.unit);
        if !matches!(motion, Move::Arc { .. })
            && let Some(word) = [I, J, R].into_iter().find_map(|k| block.values[k])
        {
            return Err(word.error("belongs to an arc, and this is a straight move", "write G2 or G3, or remove it"));
        }
        let from = self.at;
        let to = [(X, 0), (Y, 1)].map(|(word, k)| match value(word) {
            Some(value) if self.is_relative => from[k] + value,
            Some(value) => value,
            None => from[k],
        });
        let source = block.motion.unwrap_or(first).source;
        if !std::mem::replace(&mut self.has_place, true) {
            if motion != Move::Travel {
                let message = "is the first move, but the file has not said where the tip is";
                let word = block.motion.unwrap_or(first);
                return Err(word.error(message, "begin with a move to the first point, such as G0 X0 Y0"));
            }
            self.at = to;
            return Ok(());
        }
        let curve = match motion {
            Move::Travel | Move::Line => Curve::Line { from, to },
            Move::Arc { is_left } => self.arc(block, first, to, is_left)?,
        };
        self.at = to;
        let is_travel = motion == Move::Travel;
        let speed = self.speed.filter(|_| !is_travel);
        self.pieces.push(Piece { curve, speed, is_travel, source });
        Ok(())
    }

    fn arc(&self, block: &Block, first: &Word, to: Point, is_left: bool) -> Result<Curve, Error> {
        let word = block.motion.unwrap_or(first);
        let value = |k: usize| block.values[k].map(|word| word.value * self.unit);
        let shown = |length: f64| format!("{} {}", (length / self.unit * 1e6).round() / 1e6, self.unit_name());
        match (value(I), value(J), value(R)) {
            (None, None, None) => Err(word.error("has neither a centre nor a radius", "add I and J, or R")),
            (None, None, Some(radius)) => arc::with_radius(self.at, to, radius, is_left).ok_or_else(|| {
                if to == self.at {
                    return word.error("ends where it begins, so R does not give its centre", "use I and J");
                }
                let chord = (to[0] - self.at[0]).hypot(to[1] - self.at[1]);
                let message = format!("has ends {} apart, more than twice its radius", shown(chord));
                word.error(&message, format!("give a radius of at least {}", shown(chord / 2.0)))
            }),
            (_, _, Some(_)) => Err(word.error("has a centre and a radius", "keep I and J, or R")),
            (i, j, None) => {
                let center = [self.at[0] + i.unwrap_or(0.0), self.at[1] + j.unwrap_or(0.0)];
                arc::about(self.at, to, center, is_left).map_err(|[first, last]| {
                    let [first, last] = [first, last].map(shown);
                    let message = format!("begins {first} from its centre, and ends {last} from it");
                    word.error(&message, "I and J count from the start of the arc; write them with more digits")
                })
            }
        }
    }

    fn unit_name(&self) -> String {
        match self.placement.unit {
            Some(unit) => unit.to_string(),
            None if self.unit == INCH => "in".into(),
            None => "mm".into(),
        }
    }

    /// Returns the line.
    ///
    /// # Errors
    /// If the program has no line.
    pub fn finish(self) -> Result<Toolpath, Error> {
        let placed = |piece: Piece| Piece { curve: self.placement.place(&piece.curve), ..piece };
        // Where a travel leads to nothing, the tip would only leave the line.
        let mut pieces = self.pieces;
        let count = pieces.len();
        while pieces.last().is_some_and(|piece| piece.is_travel) {
            pieces.pop();
        }
        let after = count - pieces.len();
        let drawn = pieces.iter().position(|piece| !piece.is_travel).unwrap_or(pieces.len());
        if pieces.iter().all(|piece| piece.curve.length() == 0.0) {
            return Err(Error::new(None, None, "the file has no line", "add at least one move (G1)"));
        }
        let path = Toolpath::new(pieces.into_iter().skip(drawn).map(placed).collect())?;
        let assumed = !self.says_unit && self.placement.unit.is_none();
        let mut notes = Vec::new();
        if assumed {
            notes.push("the file states no unit (G20 or G21): read as mm".to_owned());
        }
        for (left_out, place) in [(drawn, "before the first piece"), (after, "after the last piece")] {
            if left_out > 0 {
                notes.push(format!("{} (G0) {place} left out", counted(left_out, "travel")));
            }
        }
        Ok(path.with_notes(notes))
    }
}

/// Sorts the words of a block by their purpose.
fn sort(words: &[Word]) -> Result<Block<'_>, Error> {
    let mut block = Block::default();
    for (index, word) in words.iter().enumerate() {
        let place = match (word.letter, word.value) {
            ('G', 0.0 | 1.0 | 2.0 | 3.0) => &mut block.motion,
            ('G', 20.0 | 21.0) => &mut block.unit,
            ('G', 90.0 | 91.0) => &mut block.distance,
            // The plane of X and Y, which is the only one.
            ('G', 17.0) => continue,
            ('M', 2.0 | 30.0) => &mut block.end,
            ('N', _) if index == 0 => continue,
            ('N', _) => return Err(word.error("is not at the start of its line", "put it first, or remove it")),
            (letter, _) if VALUES.contains(&letter) => {
                &mut block.values[VALUES.iter().position(|value| *value == letter).unwrap_or(0)]
            }
            _ => return Err(unknown(word)),
        };
        if let Some(known) = place {
            let message = format!("contradicts {} on the same line", known.text);
            return Err(word.error(&message, "keep one of them on the line"));
        }
        *place = Some(word);
    }
    Ok(block)
}

fn unknown(word: &Word) -> Error {
    let (message, hint) = match word.letter {
        'Z' => ("moves the tip out of the plane", "the arm moves in a plane; remove the Z words"),
        'A' | 'B' | 'C' => ("turns the tool", "the arm has no such axis; remove this word"),
        'S' | 'T' => ("commands the spindle or the tool", "remove this word"),
        'M' => ("commands the machine", "remove this word; cplan moves only the tip, and reads M2 and M30"),
        _ => ("is not a word that cplan follows", ACCEPTED),
    };
    word.error(message, hint)
}
