//! Predicates of convex polygons on arrays.

use crate::error::{raised, refused};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

/// Returns the corners of a polygon, shape (n, 2).
fn corners(name: &str, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 2]>> {
    let corners = array.as_array();
    if corners.ncols() != 2 {
        return Err(refused(format!("{name}: expected shape (n, 2), not {:?}", corners.shape())));
    }
    Ok(corners.rows().into_iter().map(|row| [row[0], row[1]]).collect())
}

/// Returns points as a read-only array of shape (n, 2).
pub fn array(py: Python<'_>, rows: Vec<[f64; 2]>) -> PyResult<Py<PyArray2<f64>>> {
    let count = rows.len();
    let array = PyArray1::from_vec(py, rows.into_flattened()).reshape([count, 2])?;
    array.readwrite().make_nonwriteable();
    Ok(array.unbind())
}

/// Returns the penetration depth of two convex polygons in metres: the shortest translation after which they only
/// touch. A negative value is the distance between them.
///
/// Corners are arrays of shape (n, 2), counter-clockwise.
#[pyfunction]
pub fn penetration_depth(py: Python<'_>, a: PyReadonlyArray2<'_, f64>, b: PyReadonlyArray2<'_, f64>) -> PyResult<f64> {
    cplan_calls::penetration_depth(&corners("a", &a)?, &corners("b", &b)?).map_err(|refusal| raised(py, refusal))
}

/// Finds the corners of each convex polygon in the other, and sides that cross. Exact.
///
/// Corners are arrays of shape (n, 2), counter-clockwise.
#[pyfunction]
pub fn polygon_test<'py>(
    py: Python<'py>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let test = cplan_calls::polygon_test(&corners("a", &a)?, &corners("b", &b)?);
    let test = test.map_err(|refusal| raised(py, refusal))?;
    let parts = (test.meet, test.a_inside, test.b_inside, test.crossings);
    py.import("cplan._frames")?.call_method1("PolygonTest", parts)
}

/// Returns the Minkowski difference: the translations of `b` with which it meets `a`, which is its C-obstacle. The
/// result has corners of shape (n, 2), counter-clockwise.
///
/// Both are convex, counter-clockwise, of shape (n, 2).
#[pyfunction]
pub fn minkowski_difference(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
) -> PyResult<Py<PyArray2<f64>>> {
    let difference = cplan_calls::minkowski_difference(&corners("a", &a)?, &corners("b", &b)?);
    array(py, difference.map_err(|refusal| raised(py, refusal))?)
}
