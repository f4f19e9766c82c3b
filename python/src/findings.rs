//! Checks of configurations and motions, explanations of infeasible problems, and comparisons of planners. They return
//! the program's JSON, from which `cplan/findings.py` makes objects.

use crate::error::{raised, refused};
use crate::geometry::array;
use crate::problem::{Arm, Options, World};
use crate::signals::interruptible;
use cplan::cli::{ExplanationResult, Failure, compare_in};
use cplan::compare::PLAIN;
use cplan::cspace::Slice;
use cplan::engine::explain::TIME_LIMIT;
use cplan::engine::findings;
use cplan::input::{InputError, JointValues, Overrides, Source, load_recording, read_recording};
use cplan::model::Contacts;
use numpy::PyArray2;
use pyo3::prelude::*;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Duration;

/// Checks whether a configuration (`0.3,-1`) is free, and returns the reasons.
#[pyfunction]
#[pyo3(signature = (arm, world, at, clearance = None))]
pub fn check(py: Python<'_>, arm: &Arm, world: &World, at: &str, clearance: Option<f64>) -> PyResult<String> {
    let at: JointValues = at.parse().map_err(|error| refused(format!("at: {error}")))?;
    let found = interruptible(py, |_| {
        let scene = arm.among(world)?.with_margins(clearance, None)?.scene;
        Ok(findings::check(&scene, at.resolve(&scene.arm().joints, "at")?))
    })?;
    printed(&found.map_err(|error: InputError| raised(py, &error))?)
}

/// Returns the blocked intervals of joint 2 at values of joint 1 (radians or metres): there a link touches something,
/// or is nearer than the clearance. Each array has closed, ascending intervals, shape (n, 2). The result is exact, from
/// contact angles. On a circle, an interval across the seam is split in two.
#[pyfunction]
pub fn slices(py: Python<'_>, arm: &Arm, world: &World, q1: Vec<f64>) -> PyResult<Vec<Py<PyArray2<f64>>>> {
    if let Some(odd) = q1.iter().find(|value| !value.is_finite()) {
        return Err(refused(format!("q1: {odd} is not a joint value")));
    }
    let found = interruptible(py, |_| {
        let scene = arm.among(world)?.scene;
        let (contacts, grow) = (Contacts::new(&scene), scene.workspace().clearance);
        let (bands, domain) =
            (Slice::bands(&contacts, grow), scene.arm().topology().ranges.map(|range| range.domain()));
        let mut slice = Slice::default();
        let of = |q1: f64| match bands.forbids(q1) {
            true => vec![<[f64; 2]>::from(domain[1])],
            false => {
                slice.compute(&contacts, q1, grow);
                slice.merged.clone()
            }
        };
        Ok(q1.into_iter().map(of).collect::<Vec<_>>())
    })?;
    let found = found.map_err(|error: InputError| raised(py, &error))?;
    found.into_iter().map(|intervals| array(py, intervals)).collect()
}

/// Verifies a motion: a file, or a text in the format of JSON files.
#[pyfunction]
#[pyo3(signature = (arm, world, file = None, text = None, options = None, anywhere = false, unwrap = false))]
#[allow(clippy::too_many_arguments)]
pub fn verify(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    file: Option<PathBuf>,
    text: Option<String>,
    options: Option<&Options>,
    anywhere: bool,
    unwrap: bool,
) -> PyResult<String> {
    let overrides = options.map_or_else(Overrides::default, |options| options.overrides.clone());
    let found = interruptible(py, |_| {
        let loaded = arm.among(world)?.with_margins(overrides.clearance, overrides.calibration)?;
        let mut recorded = match &file {
            Some(file) => load_recording(file, &loaded)?,
            None => read_recording(&Source::in_memory("motion", text.unwrap_or_default()), &loaded)?,
        };
        if recorded.steps.is_some() && anywhere {
            return Ok(None);
        }
        if unwrap {
            recorded.recording = recorded.recording.unwrapped(&loaded.scene.arm().topology());
        }
        findings::verify(&loaded, &recorded, &overrides, anywhere).map(Some)
    })?;
    match found.map_err(|error: InputError| raised(py, &error))? {
        Some(found) => printed(&found),
        None => Err(refused("`anywhere` does not apply to tasks, which must begin at the start")),
    }
}

/// Compares planners, with the words of the program's `compare`. Returns JSON, text, Markdown and CSV.
#[pyfunction]
pub fn compare(py: Python<'_>, arm: &Arm, world: &World, words: Vec<String>) -> PyResult<[String; 4]> {
    let compared = interruptible(py, |_| compare_in(arm.among(world)?, &words))?;
    let study = compared.map_err(|failure| failed(py, failure))?;
    match study.comparisons.first().filter(|_| study.sampling.is_none()) {
        Some(only) => Ok([printed(&only.to_json())?, only.to_text(false, PLAIN), only.to_markdown(), only.to_csv()]),
        None => Ok([printed(&study.to_json())?, study.to_text(false, PLAIN), study.to_markdown(), study.to_csv()]),
    }
}

/// The name of a problem's files, and its start and goal if they were drawn.
type ComparedProblem = (String, Option<([f64; 2], [f64; 2])>);

/// Returns the problems that `compare` compares with these words.
#[pyfunction]
pub fn compared_problems(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    words: Vec<String>,
) -> PyResult<Vec<ComparedProblem>> {
    let found = interruptible(py, |_| cplan::cli::compared_problems(arm.among(world)?, &words))?;
    let problem = |(file, query): (String, Option<[cplan::space::Configuration; 2]>)| {
        (file, query.map(|[start, goal]| (start.into(), goal.into())))
    };
    Ok(found.map_err(|failure| failed(py, failure))?.into_iter().map(problem).collect())
}

/// Stubs copy defaults from signatures, so the signatures repeat the limit as a number.
const _: () = assert!(TIME_LIMIT.as_secs() == 5);

/// Explains why there is no motion and which changes would open a path, or which obstacles shape the motion: JSON and
/// text.
#[pyfunction]
#[pyo3(signature = (arm, world, options = None, time = 5.0))]
pub fn explain(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    options: Option<&Options>,
    time: f64,
) -> PyResult<[String; 2]> {
    explained(py, arm, world, options, time, |explained| (explained.to_json(), explained.summary()))
        .and_then(|(json, summary)| Ok([printed(&json)?, summary]))
}

/// Draws an explanation as a picture or as a page.
#[pyfunction]
#[pyo3(signature = (arm, world, options = None, page = false, time = 5.0))]
pub fn explain_drawn(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    options: Option<&Options>,
    page: bool,
    time: f64,
) -> PyResult<String> {
    let draw = if page { cplan::view::page } else { cplan::view::svg };
    explained(py, arm, world, options, time, |explained| draw(&explained.view()))
}

fn explained<T: Send>(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    options: Option<&Options>,
    time: f64,
    told: impl FnOnce(&ExplanationResult) -> T + Send,
) -> PyResult<T> {
    let limit = Duration::try_from_secs_f64(time).map_err(refused)?;
    let overrides = options.map_or_else(Overrides::default, |options| options.overrides.clone());
    let found = interruptible(py, |_| {
        ExplanationResult::of(arm.among(world)?, &overrides, limit).map(|explained| told(&explained))
    })?;
    found.map_err(|failure| failed(py, failure))
}

/// Returns a failure of the program as an exception.
fn failed(py: Python<'_>, failure: Failure) -> PyErr {
    match failure {
        Failure::Input(error) => raised(py, &error),
        other => refused(other),
    }
}

/// Formats a value as the program prints it.
fn printed(found: &impl Serialize) -> PyResult<String> {
    serde_json::to_string_pretty(found).map(|json| json + "\n").map_err(refused)
}
