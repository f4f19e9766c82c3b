//! Predicates of convex polygons on arrays.

use crate::error::refused;
use cplan::geometry::{self, Convex, Point};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

/// Largest coordinate in metres, the same as for arms and worlds.
const MAX_COORDINATE: f64 = 1e15;

/// Creates a convex polygon from corners, shape (n, 2), counter-clockwise; one corner is a point, two are a segment.
fn polygon(name: &str, corners: &PyReadonlyArray2<'_, f64>) -> PyResult<Convex> {
    let corners = corners.as_array();
    if corners.ncols() != 2 {
        return Err(refused(format!("{name}: expected shape (n, 2), not {:?}", corners.shape())));
    }
    // Products of larger coordinates overflow.
    if corners.iter().any(|x| x.abs() > MAX_COORDINATE) {
        return Err(refused(format!("{name}: coordinates must be at most {MAX_COORDINATE:e} in magnitude")));
    }
    let points = corners.rows().into_iter().map(|row| Point::new(row[0], row[1])).collect();
    Convex::new(points, 0.0).map_err(|error| refused(format!("{name}: {error}")))
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
pub fn penetration_depth(a: PyReadonlyArray2<'_, f64>, b: PyReadonlyArray2<'_, f64>) -> PyResult<f64> {
    Ok(geometry::penetration_depth(&polygon("a", &a)?, &polygon("b", &b)?))
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
    let test = geometry::polygon_test(&polygon("a", &a)?, &polygon("b", &b)?);
    let corners = |inside: &[geometry::CornerInside]| inside.iter().map(|c| c.corner).collect::<Vec<usize>>();
    let parts = (test.meet, corners(&test.a_inside), corners(&test.b_inside), test.crossings);
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
    let difference = polygon("a", &a)?.minkowski_difference(&polygon("b", &b)?);
    array(py, difference.core().iter().map(|p| [p.x, p.y]).collect())
}
