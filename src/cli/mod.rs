//! The command line: arguments to library calls, results to files, summaries and exit codes.

mod args;
mod batch;
mod check;
mod compare;
mod completions;
mod converge;
#[cfg(feature = "study")]
mod ctrl_c;
mod demo;
mod error_json;
mod explain;
mod explore;
mod failure;
mod fresh;
mod import;
mod init;
mod inspect;
mod inspect_text;
mod man;
mod memory;
mod message_args;
mod plan;
mod print_args;
mod progress;
mod reach;
mod recheck;
mod result_files;
mod schema;
#[cfg(feature = "serve")]
mod serve;
mod sinks;
#[cfg(feature = "study")]
mod study;
mod terminal;
mod variant;
mod verify;
mod words;

pub use compare::compare_in;
pub use explain::Explained;
pub use failure::Failure;
pub use memory::MemoryMeter;
pub use words::read_words;

use args::{Cli, Command};
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches};
use error_json::ErrorJson;
use std::ffi::OsString;
use std::path::Path;
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

/// Runs the program with the process's arguments. A wrong command line ends it with exit code 2. With `--json` an error is
/// a JSON object on stdout, besides the words on stderr. `meter` counts the
/// process's memory, if anything does.
#[must_use]
pub fn run(meter: Option<MemoryMeter>) -> ExitCode {
    run_with(std::env::args_os().collect(), meter).into()
}

/// The same with these arguments, the program's name first; its exit code.
#[must_use]
pub fn run_with(arguments: Vec<OsString>, meter: Option<MemoryMeter>) -> u8 {
    let in_json = arguments.iter().any(|argument| argument == "--json");
    let first = arguments.get(1).cloned();
    let mut cli =
        match Cli::grammar().try_get_matches_from(arguments).and_then(|matches| Cli::from_arg_matches(&matches)) {
            Ok(cli) => cli,
            Err(error) => {
                let misspelled = first.filter(|_| error.kind() == ErrorKind::ArgumentConflict).and_then(misspelled);
                return unread(&misspelled.unwrap_or(error), in_json);
            }
        };
    let done = match (&mut cli.command, &cli.files) {
        (Some(Command::Compare(args)), _) => compare::run(args, meter),
        (Some(Command::Batch(args)), _) => batch::run(args),
        (Some(Command::Check(args)), _) => check::run(args),
        (Some(Command::Converge(args)), _) => converge::run(args),
        (Some(Command::Explain(args)), _) => explain::run(args),
        (Some(Command::Explore(args)), _) => explore::run(args),
        (Some(Command::Import(args)), _) => import::run(args),
        (Some(Command::Inspect(args)), _) => inspect::run(args),
        (Some(Command::Reach(args)), _) => reach::run(args),
        (Some(Command::Recheck(args)), _) => recheck::run(args),
        (Some(Command::Verify(args)), _) => verify::run(args),
        #[cfg(feature = "serve")]
        (Some(Command::Serve(args)), _) => serve::run(args),
        #[cfg(feature = "study")]
        (Some(Command::Study(args)), _) => study::run(args),
        (Some(Command::Demo(args)), _) => demo::run(args),
        (Some(Command::Init(args)), _) => init::run(args),
        (Some(Command::Completions(args)), _) => completions::run(args),
        (Some(Command::Man(args)), _) => man::run(args),
        (Some(Command::Planners(_)), _) => planners(),
        (Some(Command::Schema(args)), _) => schema::run(args),
        (None, Some(files)) => plan::run(files, &cli.plan),
        (None, None) => {
            let error = Cli::command().error(ErrorKind::MissingRequiredArgument, "URDF and WORLD are required");
            return unread(&error, in_json);
        }
    };
    done.unwrap_or_else(|failure: Failure| {
        if in_json && !failure.is_reported() {
            // A stream that is closed cannot be told so.
            let _ = sinks::print(&ErrorJson::of_failure(&failure).text());
        }
        sinks::say(&format!("error: {failure}"));
        failure.exit_code()
    })
}

/// Shows what planners can be told.
fn planners() -> Result<u8, Failure> {
    let mut grammar = Cli::grammar();
    let help = grammar.find_subcommand_mut("planners").map(|command| command.render_long_help().to_string());
    sinks::print(&help.unwrap_or_default())?;
    Ok(DONE)
}

/// That a first word is neither a command nor a file. Of more words than two the third would be the command then, in conflict with two files.
fn misspelled(first: OsString) -> Option<clap::Error> {
    let word = first.to_string_lossy();
    let is_meant = Path::new(&first).extension().is_none() && !word.starts_with('-');
    let is_known = Cli::command().find_subcommand(&*word).is_some() || Path::new(&first).exists();
    let message = || format!("there is no command or file {word:?}; cplan --help lists the commands");
    (is_meant && !is_known).then(|| Cli::command().error(ErrorKind::InvalidSubcommand, message()))
}

/// Says what is wrong with the command line, or shows what it asks to be shown: a help or the version.
fn unread(error: &clap::Error, in_json: bool) -> u8 {
    if in_json && error.use_stderr() {
        let _ = sinks::print(&ErrorJson::of_usage(error).text());
    }
    // As `exit` has it: a stream that is closed is nobody's concern.
    let _ = error.print();
    u8::try_from(error.exit_code()).unwrap_or(USAGE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    /// All examples of all helps are command lines; `tests/program/cli/help.rs` runs those that end soon.
    #[test]
    fn examples_are_command_lines() {
        let mut command = Cli::command();
        command.build();
        let helps = std::iter::once(&command).chain(command.get_subcommands());
        let text: String = helps.filter_map(|c| c.get_after_help()).map(|help| format!("{help}\n")).collect();
        let examples: Vec<&str> = text.lines().map(str::trim).filter(|line| line.starts_with("cplan ")).collect();
        assert!(examples.len() > 30, "{examples:?}");
        for example in examples {
            // Words in quotes are one; what follows `>` is the shell's.
            let quoted = example.split('"').enumerate();
            let parts = quoted.flat_map(|(i, part)| match i % 2 {
                1 => vec![part],
                _ => part.split_whitespace().collect(),
            });
            let words: Vec<&str> = parts.take_while(|word| ![">", ">>", "|"].contains(word)).collect();
            let parsed = Cli::try_parse_from(words);
            assert!(parsed.is_ok(), "{example}: {}", parsed.err().map_or(String::new(), |e| e.to_string()));
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
