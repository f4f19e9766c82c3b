//! Results and findings of the library, as the program prints them in JSON.

use cplan::cli::read_words;
use cplan::engine::findings::verify;
use cplan::input::{InputError, Overrides, load_recording, load_scene, load_topic};
use cplan::{Problem, plan};
use serde_json::Value;
use std::path::Path;

/// Settings of the judge in addition to the files.
#[derive(Default)]
pub struct Question<'a> {
    /// Values that replace those of the files.
    pub overrides: Overrides,
    /// True if the motion may begin and end anywhere.
    pub anywhere: bool,
    /// The topic of an MCAP file that has the motion. `None` for other files.
    pub topic: Option<&'a str>,
}

impl Question<'_> {
    /// Returns settings with which a motion may begin and end anywhere.
    pub fn with_free_ends() -> Self {
        Self { anywhere: true, ..Self::default() }
    }
}

/// Returns the findings about a recording. Their `verdict` determines the program's exit code.
pub fn judge(robot: &Path, world: &Path, recording: &Path, question: &Question) -> Result<Value, InputError> {
    let Question { overrides, anywhere, topic } = question;
    let mut loaded = load_scene(robot, world)?.with_margins(overrides.clearance, overrides.calibration)?;
    let recorded = match topic {
        None => load_recording(recording, &loaded)?,
        Some(topic) => load_topic(recording, topic, &loaded)?,
    };
    if recorded.has_torques {
        loaded = loaded.keeping_efforts()?;
    }
    let findings = verify(&loaded, &recorded, overrides, *anywhere)?;
    Ok(serde_json::to_value(&findings).unwrap())
}

/// Returns the result that `cplan plan` prints for these words on its command line.
pub fn plan_result(robot: &Path, world: &Path, words: &str) -> Value {
    let words: Vec<String> = words.split_whitespace().map(str::to_owned).collect();
    let (options, overrides) = read_words(&words).unwrap_or_else(|error| panic!("{words:?}: {error}"));
    let problem = Problem::load_with(robot, world, &overrides).unwrap_or_else(|error| panic!("{error}"));
    serde_json::from_str(&plan(&problem, &options).unwrap().to_json()).unwrap()
}
