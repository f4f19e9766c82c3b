//! The command line: it converts arguments to library calls, and results to files, summaries and exit codes.

mod arm_numbers;
mod batch;
mod cell;
mod check;
mod compare;
mod commands;
mod completions;
mod converge;
#[cfg(feature = "serve")]
mod course;
mod data_sheet;
mod demo;
mod error_json;
mod exit;
mod explain;
mod explore;
mod failure;
mod files;
mod follow;
mod fresh;
mod gcode;
mod headings;
mod import;
mod init;
mod inspect;
mod inspect_text;
mod man;
mod memory;
mod message_args;
mod outputs;
mod plan;
mod planners;
mod polygons;
mod print_args;
mod program_args;
mod progress;
mod query_args;
mod reach;
mod recheck;
mod result_files;
mod schema;
#[cfg(feature = "serve")]
mod serve;
#[cfg(all(not(target_family = "wasm"), any(feature = "serve", feature = "study")))]
mod signals;
#[cfg(all(target_family = "wasm", feature = "study"))]
#[path = "no_signals.rs"]
mod signals;
mod sinks;
#[cfg(feature = "study")]
mod study;
mod terminal;
mod theme;
mod values;
mod variant;
mod verify;
mod words;

pub use compare::{compare_in, compared_problems};
pub use data_sheet::scara_urdf;
pub use explain::ExplanationResult;
pub use failure::Failure;
pub use memory::MemoryMeter;
pub use words::read_words;

use crate::engine::Method;
use crate::options::PlannerWords;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use commands::commands;
use cplan_text::nearest_word;
use error_json::ErrorJson;
use exit::USAGE;
use files::Files;
use plan::{PlanArgs, PlanCommand};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

commands! { meter:
    "Start" {
        Demo(demo::DemoArgs),
        Init(init::InitArgs),
        Import(import::ImportArgs),
    }
    "Plan" {
        Plan(plan::PlanCommand),
        #[cfg(feature = "study")]
        Study(study::StudyArgs),
        Explore(explore::ExploreArgs),
        Follow(follow::FollowArgs),
        Gcode(gcode::GcodeArgs),
        Cell(cell::CellArgs),
        Batch(batch::BatchArgs),
    }
    "Understand" {
        Explain(explain::ExplainArgs),
        Check(check::CheckArgs),
        Polygons(polygons::PolygonsArgs),
        Reach(reach::ReachArgs),
        Inspect(inspect::InspectArgs),
        #[cfg(feature = "serve")]
        Serve(serve::ServeArgs),
        #[cfg(feature = "serve")]
        Course(course::CourseArgs),
    }
    "Verify" {
        Verify(verify::VerifyArgs),
        Recheck(recheck::RecheckArgs),
    }
    "Research" {
        Compare(compare::CompareArgs, meter),
        Converge(converge::ConvergeArgs),
    }
    "Shell and reference" {
        Completions(completions::CompletionsArgs),
        Man(man::ManArgs),
        Planners(planners::PlannersArgs),
        Schema(schema::SchemaArgs),
    }
}

/// Plans motions of a planar two-joint arm among polygonal obstacles.
///
/// The answer is a path that is certified free of collision (found), a proof that there is no path (infeasible), or
/// neither (unknown).
#[derive(Debug, Parser)]
#[command(name = "cplan", version, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(max_term_width = terminal::WIDEST)]
#[command(after_help = "\
`cplan URDF WORLD` is short for `cplan plan URDF WORLD`. `cplan help COMMAND`
explains a command, `cplan help planners` the options of each planner.

Examples:
  cplan demo
  cplan init cell
  cplan import workspaces/drawings/cell.dxf --output cell.toml
  cplan robots/planar_2r.urdf workspaces/shelf.toml --picture plan.svg
  cplan study workspaces/studies/base.toml --output base.csv --output base.html
  cplan explain robots/planar_2r.urdf workspaces/no_path.toml
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 10deg,45deg
  cplan inspect robots/scara.urdf workspaces/scara_cell.toml --picture scara.svg
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml
  cplan compare --suite workspaces --output report.html

Lengths are in metres (or with a unit: 20mm), angles in radians (or degrees:
30deg), times in seconds.

Exit codes: 0 found and certified, 1 bad input or I/O, 2 wrong command line, 3
proven infeasible, 4 unknown.")]
struct Cli {
    /// The subcommand; without one, the program plans.
    #[command(subcommand)]
    command: Option<Command>,
    /// Files to plan with, unless there is a subcommand.
    #[command(flatten)]
    files: Option<Files>,
    #[command(flatten)]
    plan: PlanArgs,
}

impl Cli {
    /// Reads the command from a command line.
    fn read(arguments: &[OsString]) -> Result<Command, clap::Error> {
        let cli = Self::from_arg_matches(&Self::for_messages().try_get_matches_from(arguments)?)?;
        match (cli.command, cli.files) {
            (Some(command), _) => Ok(command),
            (None, Some(files)) => Ok(Command::Plan(PlanCommand { files, plan: cli.plan })),
            (None, None) => {
                Err(Self::command().error(ErrorKind::MissingRequiredArgument, "URDF and WORLD are required"))
            }
        }
    }

    /// Returns the commands in groups and the first examples, for a command line without words.
    fn overview() -> String {
        let mut grammar = Self::for_messages();
        let template = commands::help_template(&grammar, GROUPS).replace("\n{all-args}{after-help}", OVERVIEW_END);
        grammar = grammar.help_template(template);
        grammar.render_help().to_string()
    }

    /// Returns the grammar for help and error messages. Subcommands are in groups. Only `cplan planners` shows the options of
    /// planners.
    fn for_messages() -> clap::Command {
        let grammar = Self::command();
        let template = commands::help_template(&grammar, GROUPS);
        let usage = "cplan [plan] [OPTIONS] <URDF> <WORLD>\n       cplan <COMMAND>";
        let grammar = grammar.help_template(template).override_usage(usage);
        let grammar = grammar.mut_subcommands(|command| command.hide(true));
        let with_planners = ["plan", "demo", "explore"];
        with_planners.into_iter().fold(without_planner_options(grammar), |grammar, name| {
            grammar.mut_subcommand(name, without_planner_options)
        })
    }
}

/// End of the overview of the commands.
const OVERVIEW_END: &str = "
Begin with `cplan demo`, which needs no files. `cplan --help` lists the options,
`cplan help COMMAND` explains a command.";

/// Returns the grammar of the whole command line, from which manual pages and scripts are generated.
fn grammar() -> clap::Command {
    Cli::command()
}

/// Hides the options of planners in the help of a command. The help refers to `cplan planners` instead.
fn without_planner_options(command: clap::Command) -> clap::Command {
    let planners: BTreeSet<String> =
        PlannerWords::command().get_opts().map(|option| option.get_id().to_string()).collect();
    let names = Method::ALL.map(|method| method.name()).join(", ");
    command.mut_args(|argument| match argument.get_id().as_str() {
        "planner" => {
            let about = argument.get_help().map(ToString::to_string).unwrap_or_default();
            let help = format!("{about}: {names}. `cplan help planners` describes the planners and their options");
            argument.hide_possible_values(true).help(help)
        }
        id if planners.contains(id) => argument.hide(true),
        _ => argument,
    })
}

/// Runs the program with the process's arguments. A wrong command line ends it with exit code 2. With `--json`, errors
/// are also printed on stdout, as JSON objects. `meter` counts the process's memory, if possible.
pub fn run(meter: Option<MemoryMeter>) -> ExitCode {
    run_with(std::env::args_os().collect(), meter).into()
}

/// Runs the program with these arguments, of which the first is the program's name. Returns the exit code.
pub fn run_with(arguments: Vec<OsString>, meter: Option<MemoryMeter>) -> u8 {
    #[cfg(feature = "gpu")]
    crate::bring_gpu();
    crate::input::read_svg_lines();
    if arguments.len() < 2 {
        sinks::print_status(Cli::overview().trim_end());
        return USAGE;
    }
    let in_json = arguments.iter().any(|argument| argument == "--json");
    let misspelled = misspelled_command_error(&arguments);
    let read = misspelled.map_or_else(|| read_alone(&arguments).map_or_else(|| Cli::read(&arguments), Ok), Err);
    let mut command = match read {
        Ok(command) => command,
        Err(mut error) => {
            // A world with steps may itself have the line.
            if arguments[1] == "follow" && error.kind() == ErrorKind::MissingRequiredArgument {
                let tip = "PATH is the file of the line; for a world whose steps contain the line, use `cplan plan URDF WORLD`";
                error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
            }
            return unread(&error, in_json);
        }
    };
    command.run(meter).map_err(Failure::with_command_for_cells).unwrap_or_else(|failure| {
        if in_json && !failure.is_reported() {
            // If stdout is closed, the error cannot be reported there.
            let _ = sinks::print(&ErrorJson::of_failure(&failure).text());
        }
        sinks::print_status(&format!("error: {failure}"));
        failure.exit_code()
    })
}

/// Reads a command line with the grammar of its subcommand alone, because building the grammar of all subcommands takes
/// as long as planning. `None` if the whole grammar must decide, and for help and error messages.
fn read_alone(arguments: &[OsString]) -> Option<Command> {
    let is_command = |word: &str| word == "help" || Command::has_subcommand(word);
    let is_named = |word: &OsString| word.to_str().is_some_and(is_command);
    if arguments.get(1).is_some_and(is_named) {
        return Command::read_alone(&arguments[1..]);
    }
    let is_plan = !arguments.iter().any(is_named);
    is_plan.then(|| read(arguments)).flatten().map(Command::Plan)
}

/// Reads the arguments of one command. `None` if they are wrong.
fn read<A: Args>(line: &[OsString]) -> Option<A> {
    let grammar = A::augment_args(clap::Command::new("cplan"));
    A::from_arg_matches(&grammar.try_get_matches_from(line).ok()?).ok()
}

/// Returns an error if the first word is neither a subcommand nor a file, or if there is no such subcommand to explain. Without
/// this check, clap would mistake the third of several words for a subcommand, and report a conflict with two files.
fn misspelled_command_error(arguments: &[OsString]) -> Option<clap::Error> {
    let is_help = arguments.get(1).is_some_and(|word| word == "help");
    let given = arguments.get(if is_help { 2 } else { 1 })?;
    let word = given.to_string_lossy();
    let is_file = !is_help && (Path::new(given).extension().is_some() || Path::new(given).exists());
    if is_file || word.is_empty() || word.starts_with('-') || word == "help" || Command::has_subcommand(&word) {
        return None;
    }
    let mut grammar = Cli::command();
    let near = nearest_word(&word, grammar.get_subcommands().map(clap::Command::get_name));
    let tip =
        near.map_or("`cplan --help` lists the commands".to_owned(), |near| format!("did you mean `cplan {near}`?"));
    let what = if is_help { "no command" } else { "no command and no file" };
    let message = format!("there is {what} {word:?}\n\n  tip: {tip}");
    Some(grammar.error(ErrorKind::InvalidSubcommand, message))
}

/// Reports a command line that cannot be parsed. Prints help or version if the line requests them. Returns the exit
/// code.
fn unread(error: &clap::Error, in_json: bool) -> u8 {
    if error.use_stderr() {
        if in_json {
            let _ = sinks::print(&ErrorJson::of_usage(error).text());
        }
        sinks::print_status(error.to_string().trim_end());
    } else {
        // A closed stream is ignored, as in clap's `exit`.
        let _ = error.print();
    }
    u8::try_from(error.exit_code()).unwrap_or(USAGE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that all examples in the help are valid command lines. `tests/program/cli/help.rs` runs the short ones.
    #[test]
    fn examples_are_command_lines() {
        let mut command = Cli::command();
        command.build();
        let helps = std::iter::once(&command).chain(command.get_subcommands());
        let text: String = helps.filter_map(|c| c.get_after_help()).map(|help| format!("{help}\n")).collect();
        let text = text.replace("\\\n", " ");
        let examples: Vec<&str> = text.lines().map(str::trim).filter(|line| line.starts_with("cplan ")).collect();
        assert!(examples.len() > 30, "{examples:?}");
        for example in examples {
            // Quoted words count as one. Text after `>` is for the shell.
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
