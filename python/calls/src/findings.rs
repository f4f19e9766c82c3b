//! Checks of configurations and motions, explanations of infeasible problems, and comparisons of planners. They return
//! the program's JSON, from which `cplan/findings.py` makes objects.

use crate::error::Refusal;
use crate::problem::{Arm, Options, World};
use cplan::cli::{ExplanationResult, compare_in};
use cplan::compare::PLAIN;
use cplan::cspace::Slice;
use cplan::engine::explain::TIME_LIMIT;
use cplan::engine::findings;
use cplan::input::{InputError, JointValues, Source, load_recording, read_recording};
use cplan::model::Contacts;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::time::Duration;

/// Checks whether a configuration (`0.3,-1`) is free, and returns the reasons.
///
/// # Errors
/// The defects of arm and world, and a text that is not a configuration.
pub fn check(arm: &Arm, world: &World, at: &str, clearance: Option<f64>) -> Result<String, Refusal> {
    let at: JointValues = at.parse().map_err(|error| Refusal::value(format!("at: {error}")))?;
    let scene = arm.among(world)?.with_margins(clearance, None)?.scene;
    let configuration = at.resolve(&scene.arm().joints, "at").map_err(InputError::from)?;
    printed(&findings::check(&scene, configuration))
}

/// Returns the blocked intervals of joint 2 at values of joint 1. On a circle, an interval across the seam is split in
/// two.
///
/// # Errors
/// The defects of arm and world, and values that are not numbers.
pub fn slices(arm: &Arm, world: &World, q1: &[f64]) -> Result<Vec<Vec<[f64; 2]>>, Refusal> {
    if let Some(odd) = q1.iter().find(|value| !value.is_finite()) {
        return Err(Refusal::value(format!("q1: {odd} is not a joint value")));
    }
    let scene = arm.among(world)?.scene;
    let (contacts, grow) = (Contacts::new(&scene), scene.workspace().clearance);
    let (bands, domain) = (Slice::bands(&contacts, grow), scene.arm().topology().ranges.map(|range| range.domain()));
    let mut slice = Slice::default();
    let mut intervals_at = |&q1: &f64| match bands.forbids(q1) {
        true => vec![<[f64; 2]>::from(domain[1])],
        false => {
            slice.compute(&contacts, q1, grow);
            slice.merged.clone()
        }
    };
    Ok(q1.iter().map(&mut intervals_at).collect())
}

/// A motion to verify.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    /// A file.
    File(PathBuf),
    /// A text in the format of JSON files.
    Text(String),
}

/// Verifies a motion. With `anywhere`, it need not lead from start to goal; with `unwrap`, turns are added to joint
/// values that jump by whole turns.
///
/// # Errors
/// The defects of arm, world and motion.
pub fn verify(
    arm: &Arm,
    world: &World,
    motion: &Motion,
    options: &Options,
    anywhere: bool,
    unwrap: bool,
) -> Result<String, Refusal> {
    let overrides = &options.overrides;
    let loaded = arm.among(world)?.with_margins(overrides.clearance, overrides.calibration)?;
    let mut recorded = match motion {
        Motion::File(file) => load_recording(file, &loaded)?,
        Motion::Text(text) => read_recording(&Source::in_memory("motion", text.clone()), &loaded)?,
    };
    if recorded.steps.is_some() && anywhere {
        return Err(Refusal::value("`anywhere` does not apply to tasks, which must begin at the start"));
    }
    if unwrap {
        recorded.recording = recorded.recording.unwrapped(&loaded.scene.arm().topology());
    }
    printed(&findings::verify(&loaded, &recorded, overrides, anywhere)?)
}

/// Compares planners, with the words of the program's `compare`. Returns JSON, text, Markdown and CSV.
///
/// # Errors
/// The defects of arm, world and words.
pub fn compare(arm: &Arm, world: &World, words: &[String]) -> Result<[String; 4], Refusal> {
    let study = compare_in(arm.among(world)?, words)?;
    match study.comparisons.first().filter(|_| study.sampling.is_none()) {
        Some(only) => Ok([printed(&only.to_json())?, only.to_text(false, PLAIN), only.to_markdown(), only.to_csv()]),
        None => Ok([printed(&study.to_json())?, study.to_text(false, PLAIN), study.to_markdown(), study.to_csv()]),
    }
}

/// The name of a problem's files, and its start and goal if they were drawn.
pub type ComparedProblem = (String, Option<([f64; 2], [f64; 2])>);

/// Returns the problems that `compare` compares with these words.
///
/// # Errors
/// The defects of arm, world and words.
pub fn compared_problems(arm: &Arm, world: &World, words: &[String]) -> Result<Vec<ComparedProblem>, Refusal> {
    let problem = |(file, query): (String, Option<[cplan::space::Configuration; 2]>)| {
        (file, query.map(|[start, goal]| (start.into(), goal.into())))
    };
    Ok(cplan::cli::compared_problems(arm.among(world)?, words)?.into_iter().map(problem).collect())
}

/// Stubs copy defaults from signatures, so the signatures repeat the limit as a number.
const _: () = assert!(TIME_LIMIT.as_secs() == 5);

/// Explains why there is no motion, or which obstacles shape the motion, in at most `time` seconds: JSON and text.
///
/// # Errors
/// The defects of arm, world and options.
pub fn explanation(arm: &Arm, world: &World, options: &Options, time: f64) -> Result<[String; 2], Refusal> {
    let explained = explained(arm, world, options, time)?;
    Ok([printed(&explained.to_json())?, explained.summary()])
}

/// Draws an explanation as a picture or as a page.
///
/// # Errors
/// The defects of arm, world and options.
pub fn explanation_drawn(
    arm: &Arm,
    world: &World,
    options: &Options,
    page: bool,
    time: f64,
) -> Result<String, Refusal> {
    let draw = if page { cplan::view::page } else { cplan::view::svg };
    Ok(draw(&explained(arm, world, options, time)?.view()))
}

fn explained(arm: &Arm, world: &World, options: &Options, time: f64) -> Result<ExplanationResult, Refusal> {
    let limit = Duration::try_from_secs_f64(time).map_err(Refusal::value)?;
    Ok(ExplanationResult::of(arm.among(world)?, &options.overrides, limit)?)
}

/// Formats a value as the program prints it.
fn printed(found: &impl Serialize) -> Result<String, Refusal> {
    serde_json::to_string_pretty(found).map(|json| json + "\n").map_err(Refusal::value)
}
