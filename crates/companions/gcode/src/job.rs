//! A program with its text, and the words that lift and lower its pen.

use super::{Dialect, Frame, firmware};
use cplan_toolpath::{Curve, Program, read_program};
use std::str::FromStr;

/// Words of lines that move the pen, such as `M300 S50`.
#[derive(Debug, Clone, PartialEq)]
pub struct PenWords(Vec<(char, f64)>);

impl FromStr for PenWords {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let words = words(text).filter(|words| !words.is_empty());
        words.map(Self).ok_or("must be words of G-code, each a letter and a number, such as \"M300 S50\"")
    }
}

impl PenWords {
    fn are_in(&self, line: &[(char, f64)]) -> bool {
        self.0.iter().all(|word| line.contains(word))
    }
}

/// The lines that move the pen.
#[derive(Debug, Clone, PartialEq)]
pub struct Pen {
    /// The words that lift it.
    pub up: PenWords,
    /// The words that lower it.
    pub down: PenWords,
}

/// Facts about the machine that a program does not state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Setup {
    /// The firmware that reads the program.
    pub dialect: Dialect,
    /// The lines that move the pen. `None` if only G0 is a travel.
    pub pen: Option<Pen>,
    /// Place of the tip at the beginning and after homing, metres, in the coordinates of the file. `None` if it is unknown.
    pub home: Option<[f64; 2]>,
    /// The place of the file's coordinates in the world.
    pub frame: Frame,
}

/// A program with its text.
#[derive(Debug, Clone)]
pub struct Job {
    pub(crate) bytes: Vec<u8>,
    pub(crate) setup: Setup,
    /// The moves, in coordinates of the world. Straight moves with a lifted pen are travels.
    pub program: Program,
}

impl Job {
    /// Reads a program. If a pen is stated, straight moves (G1) with the lifted pen count as travels, too.
    ///
    /// # Errors
    /// Words that the machine would read otherwise than cplan, with their lines; defective text; a program without moves.
    pub fn read(bytes: &[u8], setup: &Setup) -> Result<Self, cplan_toolpath::Error> {
        let mut program = read_program(bytes, setup.home)?;
        firmware::check(&String::from_utf8_lossy(bytes), setup.dialect)?;
        if let Some(pen) = &setup.pen {
            let lifted = lifted(&String::from_utf8_lossy(bytes), pen);
            for piece in program.moves.iter_mut().map(|own| &mut own.piece) {
                let is_straight = matches!(piece.curve, Curve::Line { .. });
                piece.is_travel |= is_straight && lifted.get(piece.source.line - 1).is_some_and(|lifted| *lifted);
            }
        }
        for piece in program.moves.iter_mut().map(|own| &mut own.piece) {
            piece.curve = setup.frame.place(&piece.curve);
        }
        Ok(Self { bytes: bytes.to_vec(), setup: setup.clone(), program })
    }

    /// Reads another text of the same program.
    pub(crate) fn again(&self, bytes: &[u8]) -> Result<Self, cplan_toolpath::Error> {
        Self::read(bytes, &self.setup)
    }

    /// Returns the number of drawing moves, and the number of travels.
    pub fn counts(&self) -> [usize; 2] {
        let travels = self.program.moves.iter().filter(|own| own.piece.is_travel).count();
        [self.program.moves.len() - travels, travels]
    }
}

/// Returns for each line of a program whether the pen is lifted both before and after it.
fn lifted(text: &str, pen: &Pen) -> Vec<bool> {
    let mut is_up = false;
    let of_line = |line: &str| {
        let (before, words) = (is_up, words(line).unwrap_or_default());
        match (pen.up.are_in(&words), pen.down.are_in(&words)) {
            (true, false) => is_up = true,
            (false, true) => is_up = false,
            // If both sets of words are in the line, the larger one decides.
            (true, true) => is_up = pen.up.0.len() > pen.down.0.len(),
            (false, false) => {}
        }
        before && is_up
    };
    text.lines().map(of_line).collect()
}

/// Returns the words of a line without comments. `None` if the line has anything else.
fn words(line: &str) -> Option<Vec<(char, f64)>> {
    let mut code = line.split(';').next().unwrap_or_default().to_owned();
    while let Some((from, to)) = code.find('(').and_then(|from| Some((from, from + code[from..].find(')')?))) {
        code.replace_range(from..=to, " ");
    }
    let code: String = code.chars().filter(|c| !c.is_whitespace()).collect();
    let mut words = Vec::new();
    let mut rest = code.as_str();
    while let Some(letter) = rest.chars().next() {
        let number = rest.get(1..)?;
        let end = number.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(number.len());
        words.push((letter.to_ascii_uppercase(), number[..end].parse().ok()?));
        rest = &number[end..];
    }
    Some(words)
}
