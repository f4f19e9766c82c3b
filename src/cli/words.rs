//! Parses options of `cplan plan` for callers from a library.

use super::failure::Failure;
use super::files::Files;
use super::message_args::MessageArgs;
use super::plan::{self, PlanArgs};
use super::query_args::QueryArgs;
use super::verify::Settings;
use crate::engine::{Method, Options};
use crate::input::Overrides;
use crate::options::{MotionArgs, PlannerArgs, planners, word};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Args, Command, Parser};

/// Options for planning and overrides, in the grammar of `cplan plan`.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Words {
    #[arg(long, value_parser = word(planners()), default_value_t = Method::Shortest)]
    planner: Method,
    #[command(flatten)]
    query: QueryArgs,
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    message: MessageArgs,
    #[command(flatten)]
    options: PlannerArgs,
}

/// Planner options and overrides, parsed from options such as `--cells=80`.
#[derive(Debug, Clone)]
pub(super) struct ParsedWords {
    pub options: Options,
    pub overrides: Overrides,
}

/// Parses words such as `--planner=harmonic` and `--cells=80`.
///
/// # Errors
/// The defect, in a line or two.
pub fn read_words(words: &[String]) -> Result<(Options, Overrides), String> {
    parse_settings(words).map(|asked| (asked.options, asked.overrides)).map_err(|failure| failure.to_string())
}

/// Parses words, and returns all settings.
///
/// # Errors
/// The defect, in a line or two.
pub(super) fn parse_settings(words: &[String]) -> Result<ParsedWords, Failure> {
    let refused = |error| Failure::Usage(message_about_misplaced_option(&error).unwrap_or_else(|| message(&error)));
    let words = Words::try_parse_from(words).map_err(refused)?;
    let Words { planner, query, motion, message, options: given } = words;
    let options = plan::options(planner, &given, &motion, &message)?;
    Ok(ParsedWords { options, overrides: query.overrides() })
}

/// Settings of a judgement, in the grammar of `cplan verify`.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct VerifyWords {
    #[command(flatten)]
    settings: Settings,
}

/// Parses words such as `--clearance=0.01` and `--unwrap`, which `cplan verify` knows.
///
/// # Errors
/// The defect, in a line or two.
pub(super) fn parse_verify_settings(words: &[String]) -> Result<Settings, Failure> {
    let refused = |error: clap::Error| Failure::Usage(message(&error));
    VerifyWords::try_parse_from(words).map(|words| words.settings).map_err(refused)
}

/// Returns a message if an option concerns files or printing instead of planning. `None` for other errors.
fn message_about_misplaced_option(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else { return None };
    let main_job = PlanArgs::augment_args(Files::augment_args(Command::new("cplan")));
    let is_known = error.kind() == ErrorKind::UnknownArgument
        && main_job.get_arguments().any(|known| known.get_long() == option.strip_prefix("--"));
    is_known.then(|| format!("{option} does not apply here, because it is about files or printed output"))
}

/// Returns the text of an error, without the program's usage.
pub(super) fn message(error: &clap::Error) -> String {
    let text = error.to_string();
    let message = text.split("\n\nUsage").next().unwrap_or_default();
    message.strip_prefix("error: ").unwrap_or(message).trim_end().to_owned()
}
