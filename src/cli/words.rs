//! What the main job can be told, for callers that are no shell.

use super::args::QueryArgs;
use super::message_args::MessageArgs;
use super::motion::MotionArgs;
use super::planner_args::PlannerArgs;
use crate::engine::{Method, Options};
use crate::input::Overrides;
use clap::Parser;

/// All that says how to plan and what to override, as words of the main job's command line.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Words {
    #[arg(long, default_value_t = Method::Shortest)]
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

/// Reads words such as `--planner=harmonic` and `--cells=80`.
///
/// # Errors
/// What is wrong with them, in a line or two.
pub fn read_words(words: &[String]) -> Result<(Options, Overrides), String> {
    let words = Words::try_parse_from(words).map_err(|error| {
        let text = error.to_string();
        let said = text.split("\n\nUsage").next().unwrap_or_default();
        said.strip_prefix("error: ").unwrap_or(said).trim_end().to_owned()
    })?;
    let planner = words.options.planner(words.planner)?;
    words.options.missing().map_or(Ok(()), Err)?;
    let options = Options {
        planner,
        levels: words.options.levels(),
        drive: words.motion.drive(),
        jerk: words.motion.jerk(),
        joints: words.message.joints.into(),
        accelerations: words.message.accelerations,
        ..Options::default()
    };
    Ok((options, words.query.overrides()))
}
