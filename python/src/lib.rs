//! The extension module of the Python package `cplan`: problems and results as Python objects.
//!
//! This crate decides nothing. [`cplan::input`] reads the texts of arms and worlds, options are words of the program's
//! command line, and plans come from [`cplan::plan`]. Arrays are those of numpy.

mod error;
mod findings;
mod geometry;
mod grading;
mod plan;
mod problem;
mod signals;
mod study;

use pyo3::prelude::*;
use std::ffi::OsString;

/// Registers the names that `cplan/__init__.py` exports.
#[pymodule]
fn _cplan(module: &Bound<'_, PyModule>) -> PyResult<()> {
    cplan::input::read_svg_lines();
    module.add_class::<problem::Arm>()?;
    module.add_class::<problem::World>()?;
    module.add_class::<problem::Options>()?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<plan::Plan>()?;
    module.add_class::<plan::Found>()?;
    module.add_class::<plan::Infeasible>()?;
    module.add_class::<plan::Unknown>()?;
    module.add_class::<study::Study>()?;
    module.add_class::<study::Rows>()?;
    module.add_class::<study::Journal>()?;
    module.add_function(wrap_pyfunction!(plan::plan, module)?)?;
    module.add_function(wrap_pyfunction!(plan::restored, module)?)?;
    module.add_function(wrap_pyfunction!(study::rows_restored, module)?)?;
    module.add_function(wrap_pyfunction!(plan::seconds_in_rust, module)?)?;
    module.add_function(wrap_pyfunction!(findings::check, module)?)?;
    module.add_function(wrap_pyfunction!(findings::slices, module)?)?;
    module.add_function(wrap_pyfunction!(findings::verify, module)?)?;
    module.add_function(wrap_pyfunction!(findings::compare, module)?)?;
    module.add_function(wrap_pyfunction!(findings::compared_problems, module)?)?;
    module.add_function(wrap_pyfunction!(findings::explain, module)?)?;
    module.add_function(wrap_pyfunction!(findings::explain_drawn, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::penetration_depth, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::polygon_test, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::minkowski_difference, module)?)?;
    module.add_function(wrap_pyfunction!(grading::joint_ranges, module)?)?;
    module.add_function(wrap_pyfunction!(grading::judge_boxes, module)?)?;
    module.add_function(wrap_pyfunction!(grading::separate, module)?)?;
    module.add_function(wrap_pyfunction!(grading::drawn, module)?)?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add("InputError", module.py().get_type::<error::InputError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))
}

/// Runs the program `cplan` with these arguments, its name first; returns its exit code.
#[pyfunction]
fn run(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cplan::cli::run_with(arguments, None))
}
