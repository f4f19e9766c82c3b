//! Reads G-code (ISO 6983), as far as it describes lines in the plane.

mod block;
mod machine;
mod meaning;
mod origin;
mod program;
mod remarks;
mod words;

use crate::{Error, Placement, Point, Toolpath};
pub use program::{Modes, Program, ProgramMove};

use machine::Machine;
use words::{Line, Word};

/// M words from this number on belong to the firmware of printers and plotters, except calls of programs.
const FIRMWARE: f64 = 80.0;

/// Reads a program up to M2, M30, a second % or its end.
///
/// # Errors
/// One error with all words that cannot be followed, if there are any; otherwise the first defect, with its line and column; a
/// program without a line.
pub(crate) fn read(text: &str, placement: &Placement) -> Result<Toolpath, Error> {
    run(text, Machine::new(*placement))?.finish()
}

/// Does the same as [`read`] for the single moves of a program, which may include homing. `home` is the position of the tip,
/// metres, at the beginning and after homing, if it is known.
///
/// # Errors
/// Same as for [`read`].
pub(crate) fn program(text: &str, home: Option<Point>) -> Result<Program, Error> {
    run(text, Machine::new(Placement::default()).with_homing(home))?.program()
}

fn run(text: &str, mut machine: Machine) -> Result<Machine, Error> {
    let lines: Vec<Result<Line, Error>> =
        text.lines().zip(1..).map(|(line, number)| words::line(line, number)).collect();
    machine.is_firmware = lines.iter().flatten().any(is_firmware);
    let mut first_error = None;
    let mut left = lines.iter().zip(1..);
    for (line, number) in left.by_ref() {
        match line.as_ref().map_err(Clone::clone).and_then(|line| machine.run(line)) {
            Ok(false) => {}
            Ok(true) => {
                first_error = first_error.or_else(|| machine.after_end(number, left));
                break;
            }
            Err(error) => first_error = first_error.or(Some(error)),
        }
    }
    match machine.refusal().or(first_error) {
        Some(error) => Err(error),
        None => Ok(machine),
    }
}

/// Returns true if only firmware of printers and plotters has this line. In such programs, the P of a dwell is in milliseconds.
fn is_firmware(line: &Line) -> bool {
    let is_own = |word: &Word| {
        let is_call = word.is('M', &[97.0, 98.0, 99.0]);
        word.letter == 'E' || (word.letter == 'M' && !is_call && word.value.is_some_and(|value| value >= FIRMWARE))
    };
    match line {
        Line::Words(words) => words.iter().any(is_own),
        Line::Command(name, _) => name.len() > 2,
        Line::Percent | Line::Optional(_) => false,
    }
}
