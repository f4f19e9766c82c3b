//! Information about the program for its subcommands.

use super::memory::MemoryMeter;
use clap::Command;

/// Information about the program for subcommands.
#[derive(Debug)]
pub struct Program {
    /// Builds the grammar of the whole command line, from which other files are generated.
    pub grammar: fn() -> Command,
    /// Counts the process's memory, if available.
    pub meter: Option<MemoryMeter>,
}
