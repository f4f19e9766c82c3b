//! The answer to a problem.

use crate::error::{raised, refused};
use crate::geometry::array;
use crate::problem::{Options, Problem};
use crate::signals::interruptible;
use cplan::output::CSpaceFormat;
use cplan::{PlanOutput as _, Status};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::time::Instant;

/// An answer to a problem, with everything that the program prints, writes and draws: Found, Infeasible or Unknown.
/// Frozen. A pickled plan contains problem, options and result; unpickling plans again, and compares the results.
#[pyclass(frozen, subclass, module = "cplan")]
pub struct Plan {
    plan: cplan::Plan,
    /// Computed at the first use, which takes as long as the rest of a call.
    trajectory: PyOnceLock<Option<Py<PyAny>>>,
    path: PyOnceLock<Option<Py<PyArray2<f64>>>>,
}

/// A motion that is certified collision-free along its whole length.
#[pyclass(frozen, extends = Plan, module = "cplan")]
pub struct Found;

/// A proof that there is no motion.
#[pyclass(frozen, extends = Plan, module = "cplan")]
pub struct Infeasible;

/// The answer is unknown at the resolution that was tried.
#[pyclass(frozen, extends = Plan, module = "cplan")]
pub struct Unknown;

/// Returns the motion of a plan as a `cplan.Trajectory`.
fn trajectory(py: Python<'_>, plan: &cplan::Plan) -> PyResult<Option<Py<PyAny>>> {
    let Some(motion) = cplan_calls::trajectory(plan) else { return Ok(None) };
    let parts = (
        PyArray1::from_vec(py, motion.time),
        array(py, motion.position)?,
        array(py, motion.velocity)?,
        array(py, motion.acceleration)?,
        motion.joints,
        motion.units,
        motion.interpolation,
    );
    Ok(Some(py.import("cplan._frames")?.call_method1("Trajectory", parts)?.unbind()))
}

/// Returns a plan as an object of the class of its outcome.
fn outcome(py: Python<'_>, plan: cplan::Plan) -> PyResult<Py<PyAny>> {
    let status = plan.status();
    let base = PyClassInitializer::from(Plan { plan, trajectory: PyOnceLock::new(), path: PyOnceLock::new() });
    Ok(match status {
        Status::Found => Py::new(py, base.add_subclass(Found))?.into_any(),
        Status::Infeasible => Py::new(py, base.add_subclass(Infeasible))?.into_any(),
        Status::Unknown => Py::new(py, base.add_subclass(Unknown))?.into_any(),
    })
}

/// Plans. `progress` is called with a line of text from time to time during long work.
#[pyfunction]
#[pyo3(signature = (problem, options = None, progress = None))]
pub fn plan(
    py: Python<'_>,
    problem: &Problem,
    options: Option<&Options>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Py<PyAny>> {
    let made = interruptible(py, |raised| {
        let mut say = |text: &str| {
            if let Some(progress) = progress.as_ref().filter(|_| !raised.is_any())
                && let Err(error) = Python::attach(|py| progress.call1(py, (text,)))
            {
                raised.put(error);
            }
        };
        cplan_calls::plan(&problem.problem, Options::given(options), &mut say)
    })?;
    outcome(py, made.map_err(|refusal| raised(py, refusal))?)
}

/// Returns the average time of `count` plans in seconds, without Python. The overhead of `plan` is measured against it.
#[pyfunction]
#[pyo3(signature = (problem, options = None, count = 1))]
pub fn seconds_in_rust(py: Python<'_>, problem: &Problem, options: Option<&Options>, count: u32) -> PyResult<f64> {
    let options = Options::given(options).options;
    py.detach(|| {
        let begun = Instant::now();
        for _ in 0..count {
            std::hint::black_box(cplan::plan(&problem.problem, &options).map_err(refused)?);
        }
        Ok(begun.elapsed().as_secs_f64() / f64::from(count))
    })
}

/// Restores a pickled plan: it plans again, and raises if the result differs.
#[pyfunction]
pub fn restored(py: Python<'_>, data: &[u8]) -> PyResult<Py<PyAny>> {
    let plan = interruptible(py, |_| cplan_calls::restored(data))?;
    outcome(py, plan.map_err(|refusal| raised(py, refusal))?)
}

#[pymethods]
impl Plan {
    /// The status of the answer: found, infeasible or unknown.
    #[getter]
    fn status(&self) -> &'static str {
        self.plan.status().name()
    }

    /// Name of the planner.
    #[getter]
    fn planner(&self) -> &'static str {
        self.plan.options().planner.method().name()
    }

    /// The reason why there is no motion, or why the answer is unknown.
    #[getter]
    fn reason(&self) -> Option<String> {
        self.plan.reason()
    }

    /// Notes on the problem for the user, line by line.
    #[getter]
    fn notes(&self) -> Vec<String> {
        cplan_calls::notes(self.plan.problem())
    }

    /// Returns a summary of some ten lines for people.
    fn summary(&self) -> String {
        self.plan.summary()
    }

    /// Returns the result as a JSON object.
    fn to_json(&self) -> String {
        self.plan.to_json()
    }

    /// Returns workspace and configuration space side by side, as SVG.
    fn svg(&self, py: Python<'_>) -> String {
        py.detach(|| self.plan.svg())
    }

    /// Returns a page in which the arm can be moved.
    fn html(&self, py: Python<'_>) -> String {
        py.detach(|| self.plan.html())
    }

    /// Returns the configuration spaces and the planner's data in them, as arrays (see `cplan.cspace`): one space for a
    /// motion, and for a task one for each world that the arm moves in.
    fn cspaces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let spaces = py.detach(|| CSpaceFormat::Json.text(&self.plan.cspaces()).unwrap_or_default());
        py.import("cplan.cspace")?.call_method1("read", (spaces,))
    }

    /// Writes the plan into a file, in the format of its name: .json, .csv, .yaml, .mcap, .svg, .png, .gif, .html;
    /// cspace.json and .geojson.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.plan.save(path)).map_err(|error| pyo3::exceptions::PyOSError::new_err(error.to_string()))
    }

    /// Returns the plan as HTML for a notebook.
    fn _repr_html_(&self, py: Python<'_>) -> String {
        let page = self.html(py).replace('&', "&amp;").replace('"', "&quot;");
        format!("<iframe srcdoc=\"{page}\" style=\"width: 100%; height: 640px; border: 0\"></iframe>")
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let name = slf.get_type().qualname()?;
        Ok(format!("<cplan.{name}: {}>", slf.get().plan.verdict()))
    }

    /// Returns the object itself, because it never changes.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Returns the object itself, because it never changes.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let data = serde_json::to_vec(&slf.get().plan).map_err(refused)?;
        let restored = slf.py().import("cplan._cplan")?.getattr("restored")?;
        Ok((restored, (PyBytes::new(slf.py(), &data),)))
    }
}

#[pymethods]
impl Found {
    #[classattr]
    fn __match_args__() -> (&'static str, &'static str) {
        ("path", "trajectory")
    }

    /// The waypoints, shape (n, 2), with straight segments between them; read-only.
    #[getter]
    fn path(slf: PyRef<'_, Self>) -> PyResult<Option<Py<PyArray2<f64>>>> {
        let py = slf.py();
        let Plan { plan, path, .. } = &**slf.as_super();
        let made = path.get_or_try_init(py, || plan.waypoints().map(|path| array(py, path)).transpose())?;
        Ok(made.as_ref().map(|path| path.clone_ref(py)))
    }

    /// The whole motion in time.
    #[getter]
    fn trajectory(slf: PyRef<'_, Self>) -> PyResult<Option<Py<PyAny>>> {
        let py = slf.py();
        let Plan { plan, trajectory: motion, .. } = &**slf.as_super();
        let made = motion.get_or_try_init(py, || trajectory(py, plan))?;
        Ok(made.as_ref().map(|trajectory| trajectory.clone_ref(py)))
    }

    /// Euclidean length of the path in joint space; for a task, the sum for all its motions.
    #[getter]
    fn length(slf: PyRef<'_, Self>) -> Option<f64> {
        slf.as_super().plan.length()
    }

    /// Duration of the whole motion in seconds.
    #[getter]
    fn duration(slf: PyRef<'_, Self>) -> Option<f64> {
        slf.as_super().plan.duration()
    }

    /// Proven lower bound on the distance between arm and obstacles during the whole motion, in metres; None if no
    /// obstacle is within reach.
    #[getter]
    fn clearance(slf: PyRef<'_, Self>) -> Option<f64> {
        slf.as_super().plan.clearance()
    }

    /// Proven lower bound on the length of all paths; None for planners that do not compute one.
    #[getter]
    fn lower_bound(slf: PyRef<'_, Self>) -> Option<f64> {
        slf.as_super().plan.bound().map(|bound| bound.lower)
    }

    /// Largest possible excess of the path over the shortest one, as a fraction.
    #[getter]
    fn gap(slf: PyRef<'_, Self>) -> Option<f64> {
        slf.as_super().plan.bound().map(|bound| bound.gap()).filter(|gap| gap.is_finite())
    }
}

#[pymethods]
impl Infeasible {
    #[classattr]
    fn __match_args__() -> (&'static str,) {
        ("reason",)
    }
}

#[pymethods]
impl Unknown {
    #[classattr]
    fn __match_args__() -> (&'static str,) {
        ("reason",)
    }
}
