//! Checks of configurations and motions, explanations of infeasible problems, and comparisons of planners. They return
//! the program's JSON, from which `cplan/findings.py` makes objects.

use crate::error::raised;
use crate::geometry::array;
use crate::problem::{Arm, Options, World};
use crate::signals::interruptible;
use cplan_calls::{ComparedProblem, Motion, Refusal};
use numpy::PyArray2;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Checks whether a configuration (`0.3,-1`) is free, and returns the reasons.
#[pyfunction]
#[pyo3(signature = (arm, world, at, clearance = None))]
pub fn check(py: Python<'_>, arm: &Arm, world: &World, at: &str, clearance: Option<f64>) -> PyResult<String> {
    called(py, || cplan_calls::check(&arm.0, &world.0, at, clearance))
}

/// Returns the blocked intervals of joint 2 at values of joint 1 (radians or metres): there a link touches something,
/// or is nearer than the clearance. Each array has closed, ascending intervals, shape (n, 2). The result is exact, from
/// contact angles. On a circle, an interval across the seam is split in two.
#[pyfunction]
pub fn slices(py: Python<'_>, arm: &Arm, world: &World, q1: Vec<f64>) -> PyResult<Vec<Py<PyArray2<f64>>>> {
    let found = called(py, || cplan_calls::slices(&arm.0, &world.0, &q1))?;
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
    let motion = file.map_or_else(|| Motion::Text(text.unwrap_or_default()), Motion::File);
    called(py, || cplan_calls::verify(&arm.0, &world.0, &motion, Options::given(options), anywhere, unwrap))
}

/// Compares planners, with the words of the program's `compare`. Returns JSON, text, Markdown and CSV.
#[pyfunction]
pub fn compare(py: Python<'_>, arm: &Arm, world: &World, words: Vec<String>) -> PyResult<[String; 4]> {
    called(py, || cplan_calls::compare(&arm.0, &world.0, &words))
}

/// Returns the problems that `compare` compares with these words.
#[pyfunction]
pub fn compared_problems(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    words: Vec<String>,
) -> PyResult<Vec<ComparedProblem>> {
    called(py, || cplan_calls::compared_problems(&arm.0, &world.0, &words))
}

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
    called(py, || cplan_calls::explanation(&arm.0, &world.0, Options::given(options), time))
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
    called(py, || cplan_calls::explanation_drawn(&arm.0, &world.0, Options::given(options), page, time))
}

/// Makes a call that Ctrl-C can end.
pub fn called<T: Send>(py: Python<'_>, call: impl FnOnce() -> Result<T, Refusal> + Send) -> PyResult<T> {
    interruptible(py, |_| call())?.map_err(|refusal| raised(py, refusal))
}
