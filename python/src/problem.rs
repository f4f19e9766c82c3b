//! Problems: an arm, a world, options.

use crate::error::{raised, refused};
use crate::geometry::array;
use cplan::Joint;
use cplan::cli::scara_urdf;
use cplan::input::{self, InputError, LoadedScene, Overrides, RobotFile, Source, scene_from, scene_of};
use numpy::PyArray2;
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A planar two-joint arm: a robot in URDF, or one that is made in code.
///
/// Lengths are metres, angles radians. A URDF is checked together with a world, which contains the data that a URDF
/// leaves open.
#[pyclass(frozen, module = "cplan", eq)]
#[derive(Clone, PartialEq)]
pub struct Arm(ArmSource);

#[derive(Clone, PartialEq, Serialize, Deserialize)]
enum ArmSource {
    Urdf(Source),
    Made(Box<cplan::Arm>),
}

impl Arm {
    /// Creates an arm from a URDF.
    pub fn of(urdf: Source) -> Self {
        Self(ArmSource::Urdf(urdf))
    }

    /// Returns the URDF; `None` for an arm that is made in code.
    pub fn source(&self) -> Option<&Source> {
        if let ArmSource::Urdf(source) = &self.0 { Some(source) } else { None }
    }
}

#[pymethods]
impl Arm {
    /// Reads a URDF or xacro file; `xacro_args` replace the defaults of its arguments.
    #[staticmethod]
    #[pyo3(signature = (path, *, xacro_args = None))]
    fn from_urdf(py: Python<'_>, path: PathBuf, xacro_args: Option<BTreeMap<String, String>>) -> PyResult<Self> {
        let arguments = xacro_args.unwrap_or_default().into_iter().collect();
        RobotFile { arguments, ..input::robot(absolute(path)?) }
            .read()
            .map(|source| Self(ArmSource::Urdf(source)))
            .map_err(|error| raised(py, &error))
    }

    /// Reads a URDF text. `name` appears in messages.
    #[staticmethod]
    #[pyo3(signature = (text, name = "arm.urdf"))]
    fn from_text(text: String, name: &str) -> Self {
        Self(ArmSource::Urdf(Source::in_memory(name, text)))
    }

    /// Creates an arm of two bars with round ends, of these lengths and this width in metres. The joints "joint 1" and
    /// "joint 2" are continuous, or have `limits` ((lower, upper) of each, radians). They move at 1 rad/s, or at
    /// `velocity`. They reach that in 0.25 s, or with `acceleration`.
    #[staticmethod]
    #[pyo3(signature = (lengths, width, *, limits = None, velocity = None, acceleration = None))]
    fn rr(
        lengths: [f64; 2],
        width: f64,
        limits: Option<[(f64, f64); 2]>,
        velocity: Option<[f64; 2]>,
        acceleration: Option<[f64; 2]>,
    ) -> PyResult<Self> {
        let mut arm = cplan::Arm::rr(lengths, width).map_err(refused)?;
        for (k, joint) in arm.joints.iter_mut().enumerate() {
            if let Some((lower, upper)) = limits.map(|limits| limits[k]) {
                *joint = Joint::turning(&joint.name, lower, upper);
            }
            let speed = velocity.map_or(joint.velocity, |velocity| velocity[k]);
            let rise = acceleration.map_or(joint.acceleration * speed / joint.velocity, |acceleration| acceleration[k]);
            *joint = joint.clone().at_most(speed, rise);
        }
        Ok(Self(ArmSource::Made(Box::new(arm))))
    }

    /// Creates a SCARA by the numbers of its data sheet, as `cplan init --kind scara` does: lengths of both links and travel
    /// of the quill in metres, `limits` ((lower, upper) of "axis_1" and "axis_2", radians) and their top speeds `velocity`
    /// (rad/s). Missing numbers are those of `cplan init`. Its quill is "axis_3", its wrist "axis_4" and its tip
    /// the link "flange", for `stroke`, `wrist` and `tip` of the world's robot.
    #[staticmethod]
    #[pyo3(signature = (links = None, stroke = None, *, limits = None, velocity = None))]
    fn scara(
        links: Option<[f64; 2]>,
        stroke: Option<f64>,
        limits: Option<[(f64, f64); 2]>,
        velocity: Option<[f64; 2]>,
    ) -> PyResult<Self> {
        let urdf = scara_urdf(links, stroke, limits, velocity).map_err(refused)?;
        Ok(Self(ArmSource::Urdf(Source::in_memory("arm.urdf", urdf))))
    }

    /// The text of the URDF; None for an arm that is made in code.
    #[getter]
    fn urdf(&self) -> Option<&str> {
        if let ArmSource::Urdf(source) = &self.0 { Some(source.text()) } else { None }
    }

    /// Returns the names of the two joints that are planned in a world, base to tip.
    fn joints(&self, py: Python<'_>, world: &World) -> PyResult<[String; 2]> {
        let loaded = py.detach(|| self.among(world)).map_err(|error| raised(py, &error))?;
        Ok(loaded.scene.arm().joints.each_ref().map(|joint| joint.name.clone()))
    }

    fn __repr__(&self) -> String {
        match &self.0 {
            ArmSource::Urdf(source) => format!("<cplan.Arm: URDF of {} characters>", source.text().len()),
            ArmSource::Made(arm) => format!("<cplan.Arm: {} with a reach of {} m>", arm.kind(), arm.reach()),
        }
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

impl Arm {
    /// Reads the arm together with its world.
    pub fn among(&self, world: &World) -> Result<LoadedScene, InputError> {
        let world = world.source.clone();
        match &self.0 {
            ArmSource::Urdf(source) => scene_from(source.clone(), world),
            ArmSource::Made(arm) => scene_of(*arm.clone(), world),
        }
    }
}

/// A polygonal workspace, with start and goal or steps: the text of a world file (TOML).
#[pyclass(frozen, module = "cplan", eq)]
#[derive(PartialEq)]
pub struct World {
    source: Source,
}

impl World {
    /// Creates a world from a world file.
    pub fn of(source: Source) -> Self {
        Self { source }
    }

    /// Returns the world file.
    pub fn source(&self) -> &Source {
        &self.source
    }
}

#[pymethods]
impl World {
    /// Reads a world file (TOML).
    #[staticmethod]
    fn from_toml(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Source::read(&absolute(path)?).map(|source| Self { source }).map_err(|error| raised(py, &error))
    }

    /// Reads the text of a world file. `name` appears in messages.
    #[staticmethod]
    #[pyo3(signature = (text, name = "world.toml"))]
    fn from_text(text: String, name: &str) -> Self {
        Self { source: Source::in_memory(name, text) }
    }

    /// Creates a world from obstacles, given one after the other, and the other keys of a world file by name.
    #[new]
    #[pyo3(signature = (*obstacles, **keys))]
    fn new(py: Python<'_>, obstacles: &Bound<'_, PyTuple>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let json = py.import("cplan._world")?.call_method1("document", (obstacles, keys))?;
        let keys: serde_json::Value = serde_json::from_str(json.extract::<&str>()?).map_err(refused)?;
        let text = toml::to_string(&keys).map_err(refused)?;
        Ok(Self { source: Source::in_memory("World(...)", text) })
    }

    /// The text of the world file.
    #[getter]
    fn toml(&self) -> &str {
        self.source.text()
    }

    fn __repr__(&self) -> String {
        format!("<cplan.World: TOML of {} lines>", self.source.text().lines().count())
    }

    /// Restores a pickled world.
    #[staticmethod]
    fn restored(data: &str) -> PyResult<Self> {
        serde_json::from_str(data).map(|source| Self { source }).map_err(refused)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        pickled(slf, &slf.get().source)
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
pub struct Options {
    words: Vec<String>,
    pub options: cplan::Options,
    pub overrides: Overrides,
}

#[pymethods]
impl Options {
    /// Parses words such as `--planner=harmonic`.
    #[new]
    fn new(words: Vec<String>) -> PyResult<Self> {
        if words.is_empty() {
            return Ok(Self { words, options: cplan::Options::default(), overrides: Overrides::default() });
        }
        let (options, overrides) = cplan::cli::read_words(&words).map_err(refused)?;
        Ok(Self { words, options, overrides })
    }

    fn __repr__(&self) -> String {
        format!("<cplan.Options: {}>", self.words.join(" "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Vec<String>,))> {
        Ok((slf.get_type().into_any(), (slf.get().words.clone(),)))
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
        let overrides = options.map_or_else(Overrides::default, |options| options.overrides.clone());
        let problem = py.detach(|| cplan::Problem::of_scene(arm.among(world)?, &overrides));
        problem.map(|problem| Self { problem }).map_err(|error| raised(py, &error))
    }

    /// Notes on the files for the user, line by line.
    #[getter]
    fn notes(&self) -> Vec<String> {
        noted(&self.problem)
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

/// Returns the notes of a problem for the user, line by line.
pub fn noted(problem: &cplan::Problem) -> Vec<String> {
    let robot = problem.robot();
    let assumptions = robot.assumptions(problem.scene().arm());
    robot.warnings.iter().chain(problem.notes()).cloned().chain(assumptions).collect()
}
