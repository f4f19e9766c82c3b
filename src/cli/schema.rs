//! `cplan schema`: JSON schemas of cplan's files.

use super::exit::DONE;
use super::failure::Failure;
use super::sinks;
use crate::options::{Word, word};
use clap::Args;

/// The schema of world files. A test of the crate with the types writes it, and also the other schemas.
pub const WORLD_SCHEMA: &str = include_str!("../../docs/world.schema.json");

/// Print the JSON schema of worlds, studies or configuration spaces.
#[derive(Debug, Args)]
#[command(after_help = "\
An editor with Taplo (Even Better TOML) completes and explains the keys of a
world file, if the file begins with this line and the schema is in the same
folder:
  #:schema ./world.schema.json
`cplan init` writes both files.

Examples:
  cplan schema > world.schema.json
  cplan schema study > study.schema.json
  cplan schema cspace > cspace.schema.json

Exit codes: 0 printed, 1 I/O, 2 wrong command line.")]
pub struct SchemaArgs {
    /// Kind of file.
    #[arg(value_name = "FILES", value_parser = word(SCHEMAS), default_value = "world")]
    of: &'static str,
}

/// The schemas, with the names of the files that have them.
const SCHEMAS: &[Word<&str>] = &[
    (WORLD_SCHEMA, "world", "World files (TOML)"),
    #[cfg(feature = "study")]
    (include_str!("../../docs/study.schema.json"), "study", "Study files (TOML)"),
    (
        include_str!("../../docs/cspace.schema.json"),
        "cspace",
        "Configuration spaces, written by `--output cspace.json`",
    ),
];

/// Prints the schema.
///
/// # Errors
/// I/O.
pub fn run(args: &SchemaArgs) -> Result<u8, Failure> {
    sinks::print(args.of)?;
    Ok(DONE)
}
