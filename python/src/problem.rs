//! Problems: an arm, a world, options.

use crate::error::{raised, refused};
use crate::geometry::array;
use cplan_calls::ArmNumbers;
use numpy::PyArray2;
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::LazyLock;

/// A planar two-joint arm: a robot in URDF, or one that is made in code.
///
/// Lengths are metres, angles radians. A URDF is checked together with a world, which contains the data that a URDF
/// leaves open.
#[pyclass(frozen, module = "cplan", eq)]
#[derive(Clone, PartialEq)]
pub struct Arm(pub cplan_calls::Arm);

#[pymethods]
impl Arm {
    /// Reads a URDF or xacro file; `xacro_args` replace the defaults of its arguments.
    #[staticmethod]
    #[pyo3(signature = (path, *, xacro_args = None))]
    fn from_urdf(py: Python<'_>, path: PathBuf, xacro_args: Option<BTreeMap<String, String>>) -> PyResult<Self> {
        let arm = cplan_calls::Arm::read(absolute(path)?, xacro_args.unwrap_or_default());
        arm.map(Self).map_err(|refusal| raised(py, refusal))
    }

    /// Reads a URDF text. `name` appears in messages.
    #[staticmethod]
    #[pyo3(signature = (text, name = "arm.urdf"))]
    fn from_text(text: String, name: &str) -> Self {
        Self(cplan_calls::Arm::of_text(text, name))
    }

    /// Creates an arm of two bars with round ends, of these lengths and this width in metres. The joints "joint 1" and
    /// "joint 2" are continuous, or have `limits` ((lower, upper) of each, radians). They move at 1 rad/s, or at
    /// `velocity`. They reach that in 0.25 s, or with `acceleration`.
    #[staticmethod]
    #[pyo3(signature = (lengths, width, *, limits = None, velocity = None, acceleration = None))]
    fn rr(
        py: Python<'_>,
        lengths: [f64; 2],
        width: f64,
        limits: Option<[(f64, f64); 2]>,
        velocity: Option<[f64; 2]>,
        acceleration: Option<[f64; 2]>,
    ) -> PyResult<Self> {
        let arm = cplan_calls::Arm::rr(lengths, width, &ArmNumbers { limits, velocity, acceleration });
        arm.map(Self).map_err(|refusal| raised(py, refusal))
    }

    /// Creates a SCARA by the numbers of its data sheet, as `cplan init --kind scara` does: lengths of both links and travel
    /// of the quill in metres, `limits` ((lower, upper) of "axis_1" and "axis_2", radians) and their top speeds `velocity`
    /// (rad/s). Missing numbers are those of `cplan init`. Its quill is "axis_3", its wrist "axis_4" and its tip
    /// the link "flange", for `stroke`, `wrist` and `tip` of the world's robot.
    #[staticmethod]
    #[pyo3(signature = (links = None, stroke = None, *, limits = None, velocity = None))]
    fn scara(
        py: Python<'_>,
        links: Option<[f64; 2]>,
        stroke: Option<f64>,
        limits: Option<[(f64, f64); 2]>,
        velocity: Option<[f64; 2]>,
    ) -> PyResult<Self> {
        let numbers = ArmNumbers { limits, velocity, acceleration: None };
        cplan_calls::Arm::scara(links, stroke, &numbers).map(Self).map_err(|refusal| raised(py, refusal))
    }

    /// The text of the URDF; None for an arm that is made in code.
    #[getter]
    fn urdf(&self) -> Option<&str> {
        self.0.source().map(|source| source.text())
    }

    /// Returns the names of the two joints that are planned in a world, base to tip.
    fn joints(&self, py: Python<'_>, world: &World) -> PyResult<[String; 2]> {
        py.detach(|| self.0.joints(&world.0)).map_err(|refusal| raised(py, refusal))
    }

    fn __repr__(&self) -> String {
        self.0.description()
    }

    /// Restores a pickled arm.
    #[staticmethod]
    fn restored(data: &str) -> PyResult<Self> {
        serde_json::from_str(data).map(Self).map_err(refused)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        pickled(slf, &slf.get().0)
    }
}

/// A polygonal workspace, with start and goal or steps: the text of a world file (TOML).
#[pyclass(frozen, module = "cplan", eq)]
#[derive(PartialEq)]
pub struct World(pub cplan_calls::World);

#[pymethods]
impl World {
    /// Reads a world file (TOML).
    #[staticmethod]
    fn from_toml(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        cplan_calls::World::read(absolute(path)?).map(Self).map_err(|refusal| raised(py, refusal))
    }

    /// Reads the text of a world file. `name` appears in messages.
    #[staticmethod]
    #[pyo3(signature = (text, name = "world.toml"))]
    fn from_text(text: String, name: &str) -> Self {
        Self(cplan_calls::World::of_text(text, name))
    }

    /// Creates a world from obstacles, given one after the other, and the other keys of a world file by name.
    #[new]
    #[pyo3(signature = (*obstacles, **keys))]
    fn new(py: Python<'_>, obstacles: &Bound<'_, PyTuple>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let json = py.import("cplan._world")?.call_method1("document", (obstacles, keys))?;
        cplan_calls::World::of_keys(json.extract()?).map(Self).map_err(|refusal| raised(py, refusal))
    }

    /// The text of the world file.
    #[getter]
    fn toml(&self) -> &str {
        self.0.source().text()
    }

    fn __repr__(&self) -> String {
        self.0.description()
    }

    /// Restores a pickled world.
    #[staticmethod]
    fn restored(data: &str) -> PyResult<Self> {
        serde_json::from_str(data).map(Self).map_err(refused)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        pickled(slf, &slf.get().0)
    }
}

/// Returns an absolute path. After unpickling in another process, or in another working directory, the files beside it
/// are still found.
fn absolute(path: PathBuf) -> PyResult<PathBuf> {
    Ok(std::path::absolute(path)?)
}

/// Returns the pickled form of an object that has a static method `restored`. It contains texts as they were read;
/// files that they name are read when a problem is made.
fn pickled<'py, T: PyClass>(thing: &Bound<'py, T>, data: &impl Serialize) -> PyResult<(Bound<'py, PyAny>, (String,))> {
    let data = serde_json::to_string(data).map_err(refused)?;
    Ok((thing.as_any().get_type().getattr("restored")?, (data,)))
}

/// Options of a plan, which can also replace the world's start, goal and clearance: words of the program's command
/// line.
#[pyclass(frozen, module = "cplan", eq)]
#[derive(PartialEq)]
pub struct Options(cplan_calls::Options);

impl Options {
    /// Returns the options of a call, which are optional.
    pub fn given(options: Option<&Self>) -> &cplan_calls::Options {
        static NONE: LazyLock<cplan_calls::Options> = LazyLock::new(cplan_calls::Options::default);
        options.map_or(&NONE, |options| &options.0)
    }
}

#[pymethods]
impl Options {
    /// Parses words such as `--planner=harmonic`.
    #[new]
    fn new(words: Vec<String>) -> PyResult<Self> {
        cplan_calls::Options::parse(words).map(Self).map_err(refused)
    }

    fn __repr__(&self) -> String {
        format!("<cplan.Options: {}>", self.0.words().join(" "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Vec<String>,))> {
        Ok((slf.get_type().into_any(), (slf.get().0.words().to_vec(),)))
    }
}

/// An arm in its world with a task, read and checked.
#[pyclass(frozen, module = "cplan")]
pub struct Problem {
    pub problem: cplan::Problem,
}

#[pymethods]
impl Problem {
    /// Creates a problem. Raises InputError with all defects of arm, world, start and goal.
    #[new]
    #[pyo3(signature = (arm, world, options = None))]
    fn new(py: Python<'_>, arm: &Arm, world: &World, options: Option<&Options>) -> PyResult<Self> {
        let problem = py.detach(|| cplan_calls::problem(&arm.0, &world.0, Options::given(options)));
        problem.map(|problem| Self { problem }).map_err(|refusal| raised(py, refusal))
    }

    /// Notes on the files for the user, line by line.
    #[getter]
    fn notes(&self) -> Vec<String> {
        cplan_calls::notes(&self.problem)
    }

    /// Names of the two joints, base to tip.
    #[getter]
    fn joints(&self) -> [String; 2] {
        self.problem.scene().arm().joints.each_ref().map(|joint| joint.name.clone())
    }

    /// Kind of the arm: RR, PP, RP or PR.
    #[getter]
    fn kind(&self) -> &'static str {
        self.problem.scene().arm().kind()
    }

    /// The start, base to tip, radians or metres.
    #[getter]
    fn start(&self) -> [f64; 2] {
        self.problem.query().start().into()
    }

    /// The goals, shape (n, 2): each is enough. Goals that leave a joint free are not listed.
    #[getter]
    fn goals(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        array(py, self.problem.query().goals().points().map(Into::into).collect())
    }

    /// Returns the object itself, because it never changes.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Returns the object itself, because it never changes.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Restores a pickled problem.
    #[staticmethod]
    fn restored(data: &str) -> PyResult<Self> {
        serde_json::from_str(data).map(|problem| Self { problem }).map_err(refused)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        pickled(slf, &slf.get().problem)
    }
}
