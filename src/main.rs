//! The `cplan` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    cplan::cli::run()
}
