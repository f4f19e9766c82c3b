//! `cplan schema`: JSON schemas of the files.

use super::exit::DONE;
use super::failure::Failure;
use super::sinks;
use crate::input::world_schema;
use crate::output::cspace_schema;
use clap::{Args, ValueEnum};

/// Print the JSON schema of world files, for editors, or of configuration spaces.
#[derive(Debug, Args)]
#[command(after_help = "\
An editor with Taplo (Even Better TOML) completes and explains the keys of a world whose first line is
  #:schema ./world.schema.json
with the schema in that file beside it, as `cplan init` writes both.

Examples:
  cplan schema > world.schema.json
  cplan schema study > study.schema.json
  cplan schema cspace > cspace.schema.json

Exit codes: 0 printed, 1 I/O, 2 wrong command line.")]
pub struct SchemaArgs {
    /// Of which files.
    #[arg(value_name = "FILES", default_value = "world")]
    of: Described,
}

/// Files that have a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Described {
    /// Worlds, as TOML.
    World,
    /// Studies, as TOML.
    #[cfg(feature = "study")]
    Study,
    /// Configuration spaces, as `--output cspace.json` writes them.
    Cspace,
}

/// Prints the schema.
///
/// # Errors
/// I/O.
pub fn run(args: &SchemaArgs) -> Result<u8, Failure> {
    sinks::print(&match args.of {
        Described::World => text(),
        #[cfg(feature = "study")]
        Described::Study => format!("{:#}\n", crate::study::study_schema()),
        Described::Cspace => format!("{:#}\n", cspace_schema()),
    })?;
    Ok(DONE)
}

/// Returns the schema of worlds as a file has it.
pub fn text() -> String {
    format!("{:#}\n", world_schema())
}
