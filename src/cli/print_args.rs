//! What is printed, on the command line.

use super::failure::Failure;
use super::sinks;
use clap::Args;

/// What is printed.
#[derive(Debug, Args)]
pub struct PrintArgs {
    /// Print the result as JSON, and nothing else, on stdout.
    #[arg(long)]
    pub json: bool,
    /// No summary, no progress.
    #[arg(long)]
    pub quiet: bool,
}

impl PrintArgs {
    /// Says on stderr how the work goes on, unless that is not asked for.
    pub fn say(&self, text: &str) {
        if !self.quiet {
            sinks::say(text);
        }
    }

    /// Prints the result on stdout: as JSON, for people, or not at all. The verdict has the colour of the exit code.
    ///
    /// # Errors
    /// I/O, and what `json` cannot say.
    pub fn tell(
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
