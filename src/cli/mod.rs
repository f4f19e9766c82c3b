//! The command line: arguments to library calls, results to files, summaries and exit codes.

mod args;
mod check;
mod compare;
mod completions;
mod demo;
mod failure;
mod field_args;
mod field_report;
mod fresh;
mod init;
mod inspect;
mod inspect_text;
mod man;
mod motion;
mod names;
mod output;
mod plan;
mod planned;
mod recheck;
mod schema;
mod search_args;
#[cfg(feature = "serve")]
mod serve;
mod step_lines;
mod summary;
mod task;
mod task_files;
mod task_summary;
mod variant;
mod verify;

use args::{Cli, Command};
use clap::{CommandFactory, Parser, error::ErrorKind};
use failure::Failure;
use std::process::ExitCode;

/// Exit code: a path was found, and it is certified; or the job is done.
const DONE: u8 = 0;
/// Exit code: bad input or I/O.
const BAD_INPUT: u8 = 1;
/// Exit code: wrong command line, as clap has it.
const USAGE: u8 = 2;
/// Exit code: there is no path, proven.
const INFEASIBLE: u8 = 3;
/// Exit code of `verify`: a proven collision, a limit that is broken, or a task that is not the one asked for.
const REFUTED: u8 = 3;
/// Exit code: neither found nor ruled out.
const UNKNOWN: u8 = 4;

/// Runs the program with the process's arguments. A wrong command line ends it with exit code 2.
#[must_use]
pub fn run() -> ExitCode {
    let mut cli = Cli::parse();
    let done = match (&mut cli.command, &cli.files) {
        (Some(Command::Compare(args)), _) => compare::run(args),
        (Some(Command::Check(args)), _) => check::run(args),
        (Some(Command::Inspect(args)), _) => inspect::run(args),
        (Some(Command::Recheck(args)), _) => recheck::run(args),
        (Some(Command::Verify(args)), _) => verify::run(args),
        #[cfg(feature = "serve")]
        (Some(Command::Serve(args)), _) => serve::run(args),
        (Some(Command::Demo(args)), _) => demo::run(args),
        (Some(Command::Init(args)), _) => init::run(args),
        (Some(Command::Completions(args)), _) => completions::run(args),
        (Some(Command::Man(args)), _) => man::run(args),
        (Some(Command::Schema), _) => schema::run(),
        (None, Some(files)) => plan::run(files, &cli.plan),
        (None, None) => Cli::command().error(ErrorKind::MissingRequiredArgument, "URDF and WORLD are required").exit(),
    };
    ExitCode::from(done.unwrap_or_else(|failure: Failure| {
        output::say(&format!("error: {failure}"));
        failure.exit_code()
    }))
}
