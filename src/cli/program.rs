//! The program around a subcommand.

use super::memory::MemoryMeter;
use clap::Command;

/// What a subcommand may want to know of the program.
#[derive(Debug)]
pub struct Program {
    /// Makes the grammar of the whole command line, for what is generated from it.
    pub grammar: fn() -> Command,
    /// Counts the process's memory, if anything does.
    pub meter: Option<MemoryMeter>,
}
