//! `cplan schema`: the JSON schema of world files.

use super::DONE;
use super::failure::Failure;
use super::sinks;
use crate::input::world_schema;

/// What the command's help says below.
pub const HELP: &str = "\
An editor with Taplo (Even Better TOML) completes and explains the keys of a world whose first line is
  #:schema ./world.schema.json
with the schema in that file beside it, as `cplan init` writes both.

Examples:
  cplan schema > world.schema.json

Exit codes: 0 printed, 1 I/O, 2 wrong command line.";

/// Prints the schema.
///
/// # Errors
/// I/O.
pub fn run() -> Result<u8, Failure> {
    sinks::print(&text())?;
    Ok(DONE)
}

/// The schema as a file has it.
pub fn text() -> String {
    format!("{:#}\n", world_schema())
}
