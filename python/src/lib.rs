//! The extension module of the Python package `cplan`: what is asked and what came of it, as Python has it.
//!
//! Nothing is decided here. Arms and worlds are texts that [`cplan::input`] reads, options are words of the program's command
//! line, plans are those of [`cplan::plan`]; arrays are numpy's.

mod error;
mod findings;
mod geometry;
mod plan;
mod problem;
mod signals;
mod study;

use pyo3::prelude::*;
use std::ffi::OsString;

/// What `cplan/__init__.py` hands on.
#[pymodule]
fn _cplan(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<problem::Arm>()?;
    module.add_class::<problem::World>()?;
    module.add_class::<problem::Options>()?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<plan::Plan>()?;
    module.add_class::<plan::Found>()?;
    module.add_class::<plan::Infeasible>()?;
    module.add_class::<plan::Unknown>()?;
    module.add_class::<plan::Trajectory>()?;
    module.add_class::<study::Study>()?;
    module.add_class::<study::Rows>()?;
    module.add_class::<study::Journal>()?;
    module.add_class::<geometry::PolygonTest>()?;
    module.add_function(wrap_pyfunction!(plan::plan, module)?)?;
    module.add_function(wrap_pyfunction!(plan::restored, module)?)?;
    module.add_function(wrap_pyfunction!(study::rows_restored, module)?)?;
    module.add_function(wrap_pyfunction!(plan::seconds_in_rust, module)?)?;
    module.add_function(wrap_pyfunction!(findings::check, module)?)?;
    module.add_function(wrap_pyfunction!(findings::slices, module)?)?;
    module.add_function(wrap_pyfunction!(findings::verify, module)?)?;
    module.add_function(wrap_pyfunction!(findings::compare, module)?)?;
    module.add_function(wrap_pyfunction!(findings::explain, module)?)?;
    module.add_function(wrap_pyfunction!(findings::explain_drawn, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::penetration_depth, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::polygon_test, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::minkowski_difference, module)?)?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add("InputError", module.py().get_type::<error::InputError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))
}

/// The program `cplan` with these arguments, its name first; its exit code.
#[pyfunction]
fn run(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cplan::cli::run_with(arguments, None))
}
