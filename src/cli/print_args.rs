//! Command-line options for printed output.

use super::failure::Failure;
use super::headings::OUTPUT;
use super::sinks;
use clap::Args;

/// Options for printed output.
#[derive(Debug, PartialEq, Args)]
#[command(next_help_heading = OUTPUT)]
pub struct PrintArgs {
    /// Print the result as JSON, and nothing else, on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print neither summary nor progress.
    #[arg(long)]
    pub quiet: bool,
}

impl PrintArgs {
    /// Prints progress on stderr, unless `--quiet` is set.
    pub fn print_status(&self, text: &str) {
        if !self.quiet {
            sinks::print_status(text);
        }
    }

    /// Prints the result on stdout as JSON or as text, or prints nothing. The exit code determines the colour of the
    /// verdict.
    ///
    /// # Errors
    /// I/O, and results that JSON cannot represent.
    pub fn report(
        &self,
        code: u8,
        json: impl FnOnce() -> Result<String, Failure>,
        summary: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        match (self.json, self.quiet) {
            (true, _) => sinks::print_json(&json()?),
            (false, true) => Ok(()),
            (false, false) => sinks::sum_up(&summary(), code),
        }
    }
}
