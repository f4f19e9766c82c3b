//! `cplan schema`: the JSON schema of world files.

use super::DONE;
use super::failure::Failure;
use super::output;
use crate::input::world_schema;

/// Prints the schema.
///
/// # Errors
/// I/O.
pub fn run() -> Result<u8, Failure> {
    output::print(&text())?;
    Ok(DONE)
}

/// The schema as a file has it.
pub fn text() -> String {
    format!("{:#}\n", world_schema())
}
