//! Reads G-code (ISO 6983), as far as it describes lines in the plane.

mod machine;
mod words;

use crate::{Error, Placement, Toolpath};
use machine::Machine;

/// Reads a program up to M2, M30 or its end.
///
/// # Errors
/// If the program has a word that cannot be followed, with its line and column, or if it has no line.
pub(crate) fn read(text: &str, placement: &Placement) -> Result<Toolpath, Error> {
    let mut machine = Machine::new(placement);
    for (number, line) in text.lines().enumerate() {
        let block = words::block(line, number + 1)?;
        if machine.run(&block)? {
            break;
        }
    }
    machine.finish()
}
