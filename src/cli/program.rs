//! Data about the program, which subcommands use.

use super::memory::MemoryMeter;
use clap::Command;

/// Data about the program, which subcommands use.
#[derive(Debug)]
pub struct Program {
    /// Builds the grammar of the whole command line, from which help and scripts are generated.
    pub grammar: fn() -> Command,
    /// Counter of the process's memory. `None` if the program cannot count it.
    pub meter: Option<MemoryMeter>,
}
