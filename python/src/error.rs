//! Refused calls as Python exceptions.

use cplan::input;
use cplan_calls::Refusal;
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    cplan,
    InputError,
    PyValueError,
    "Invalid input. The text of the exception states each problem with file, line and hint. `diagnostics` lists them as dictionaries with `file`, `line`, `column`, `message` and `help`; `line` and `column` are None if unknown."
);

/// Returns a refusal as a Python exception.
pub fn raised(py: Python<'_>, refusal: Refusal) -> PyErr {
    match refusal {
        Refusal::Input(error) => invalid_input(py, &error),
        Refusal::Value(why) => PyValueError::new_err(why),
        Refusal::System(why) => PyOSError::new_err(why),
    }
}

fn invalid_input(py: Python<'_>, error: &input::InputError) -> PyErr {
    let raised = InputError::new_err(error.to_string());
    let diagnostics = error.diagnostics().iter().map(|diagnostic| {
        let entry = pyo3::types::PyDict::new(py);
        entry.set_item("file", &diagnostic.origin)?;
        entry.set_item("line", diagnostic.position.map(|at| at.line))?;
        entry.set_item("column", diagnostic.position.map(|at| at.column))?;
        entry.set_item("message", &diagnostic.message)?;
        entry.set_item("help", &diagnostic.help)?;
        Ok(entry)
    });
    match diagnostics.collect::<PyResult<Vec<_>>>().and_then(|all| raised.value(py).setattr("diagnostics", all)) {
        Ok(()) => raised,
        Err(other) => other,
    }
}

/// Returns a `ValueError` with this reason.
pub fn refused(why: impl ToString) -> PyErr {
    PyValueError::new_err(why.to_string())
}
