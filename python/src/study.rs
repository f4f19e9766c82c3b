//! Studies: one task in many layouts.

use crate::error::{raised, refused};
use crate::problem::{Arm, World};
use crate::signals::interruptible;
use cplan::input::Source;
use cplan::study::{self, Row, Summary};
use numpy::PyArray1;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::PathBuf;
use std::sync::Mutex;

/// One task in many layouts: a robot, a world, varied numbers in both, and measures.
#[pyclass(frozen, subclass, module = "cplan")]
pub struct Study {
    study: study::Study,
}

fn words(words: &[String]) -> Result<(cplan::Options, cplan::input::Overrides), String> {
    cplan::cli::read_words(words)
}

#[pymethods]
impl Study {
    /// Reads a study file (TOML), and the robot and world that it names. `sources` are the texts of a pickled study,
    /// which replace the files.
    #[new]
    #[pyo3(signature = (path, sources = None))]
    fn new(py: Python<'_>, path: PathBuf, sources: Option<&str>) -> PyResult<Self> {
        let study = match sources {
            Some(sources) => study::Study::from_sources(serde_json::from_str(sources).map_err(refused)?, &words),
            // Absolute, so that a pickled study finds maps and meshes elsewhere.
            None => {
                let path = std::path::absolute(&path)?;
                py.detach(|| study::Study::load(path, &words, &cplan::input::robot))
            }
        };
        study.map(|study| Self { study }).map_err(|error| raised(py, &error))
    }

    /// Returns `sources` for a study with this text, a robot that was read from a URDF, and a world.
    #[staticmethod]
    fn sources(text: String, arm: &Arm, world: &World) -> PyResult<String> {
        let urdf = arm
            .source()
            .ok_or_else(|| PyValueError::new_err("a study needs a robot in URDF, but this arm was made in code"))?;
        serde_json::to_string(&(Source::in_memory("study.toml", text), urdf, world.source())).map_err(refused)
    }

    /// The title of the study.
    #[getter]
    fn name(&self) -> &str {
        &self.study.name
    }

    /// Names of the parameters.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.study.parameters.iter().map(|parameter| parameter.name.clone()).collect()
    }

    /// Number of layouts that the search may try, in addition to the listed and drawn ones.
    #[getter]
    fn searched(&self) -> usize {
        self.study.searched
    }

    /// Options of the main job, as the study states them.
    #[getter]
    fn options(&self) -> Vec<String> {
        self.study.options().to_vec()
    }

    /// Returns the number of layouts that are listed and drawn.
    fn __len__(&self) -> usize {
        self.study.count()
    }

    /// Returns the values of a layout, by the names of the parameters.
    fn values<'py>(&self, py: Python<'py>, layout: usize) -> PyResult<Bound<'py, PyDict>> {
        if layout >= self.study.count() {
            return Err(PyValueError::new_err(format!(
                "the study has {} layouts, numbered from 0",
                self.study.count()
            )));
        }
        let values = PyDict::new(py);
        for (parameter, value) in self.study.parameters.iter().zip(self.study.values(layout)) {
            values.set_item(&parameter.name, value)?;
        }
        Ok(values)
    }

    /// Returns robot and world with the values of a row.
    fn layout(&self, values: Vec<f64>) -> PyResult<(Arm, World)> {
        if values.len() != self.study.parameters.len() {
            return Err(PyValueError::new_err(format!("expected {} values", self.study.parameters.len())));
        }
        let [world, urdf] = self.study.layout(&values);
        Ok((Arm::of(urdf), World::of(world)))
    }

    /// Plans in the layouts from `first` to before `last` with `jobs` threads, and returns their rows.
    ///
    /// Other Python threads run meanwhile; Ctrl-C ends it.
    #[pyo3(signature = (first, last, jobs = 1))]
    fn rows(&self, py: Python<'_>, first: usize, last: usize, jobs: usize) -> PyResult<Rows> {
        let last = last.min(self.study.count());
        collected(py, |each| self.study.rows(first..last.max(first), jobs, each))
    }

    /// Continues with a search after the rows `known`, with `jobs` threads, and returns its rows. `done` are rows of a
    /// search that was interrupted.
    fn search(&self, py: Python<'_>, known: &Rows, done: &Rows, jobs: usize) -> PyResult<Rows> {
        collected(py, |each| self.study.search(&known.rows, &done.rows, jobs, each))
    }

    /// Summarises rows in some lines for people.
    fn summary(&self, rows: &Rows) -> String {
        Summary::new(&self.study, &rows.rows).to_text(false)
    }

    /// Summarises rows as a JSON object.
    fn summary_json(&self, rows: &Rows) -> String {
        Summary::new(&self.study, &rows.rows).to_json().to_string()
    }

    /// Returns the table of rows as CSV.
    fn csv(&self, rows: &Rows) -> String {
        self.study.csv(&rows.rows)
    }

    /// Returns the table of rows as a Parquet file.
    fn parquet<'py>(&self, py: Python<'py>, rows: &Rows) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.study.parquet(&rows.rows).map_err(refused)?))
    }

    /// Returns the page of rows, with pictures of the best and the worst layout, and of one without a motion.
    fn html(&self, py: Python<'_>, rows: &Rows) -> String {
        py.detach(|| self.study.html(&rows.rows, &study::pictures(&self.study, &rows.rows)))
    }

    /// Returns the columns of rows by name: numbers and flags as arrays, words as lists with None.
    fn columns<'py>(&self, py: Python<'py>, rows: &Rows) -> PyResult<Bound<'py, PyDict>> {
        let (columns, rows) = (PyDict::new(py), &rows.rows);
        let nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        columns.set_item("layout", PyArray1::from_iter(py, rows.iter().map(|row| row.layout as i64)))?;
        for (k, parameter) in self.study.parameters.iter().enumerate() {
            columns.set_item(&parameter.name, PyArray1::from_iter(py, rows.iter().map(|row| row.values[k])))?;
        }
        columns.set_item("outcome", rows.iter().map(|row| row.ending.name()).collect::<Vec<_>>())?;
        columns.set_item("reason", rows.iter().map(|row| row.reason.as_deref()).collect::<Vec<_>>())?;
        for (k, measure) in self.study.measures.iter().enumerate() {
            columns.set_item(measure.name(), PyArray1::from_iter(py, rows.iter().map(|row| nan(row.measured[k]))))?;
        }
        columns.set_item("fits", PyArray1::from_iter(py, rows.iter().map(|row| row.fits)))?;
        Ok(columns)
    }

    fn __repr__(&self) -> String {
        let names: Vec<&str> = self.study.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        format!("<cplan.Study \"{}\": {} layouts over {}>", self.study.name, self.study.count(), names.join(", "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (&'static str, String))> {
        let sources = serde_json::to_string(&slf.get().study.sources()).map_err(refused)?;
        Ok((slf.get_type().into_any(), ("", sources)))
    }
}

/// A function that receives each row. It returns an error to end the work.
type RowCallback<'a> = &'a mut dyn FnMut(Row) -> Result<(), ()>;

/// Returns all rows that `work` reports, until Ctrl-C.
fn collected(py: Python<'_>, work: impl FnOnce(RowCallback) -> Result<(), ()> + Send) -> PyResult<Rows> {
    let rows = interruptible(py, |raised| {
        let mut rows = Vec::new();
        // The exception that ended it early is raised below.
        let _ = work(&mut |row| {
            rows.push(row);
            cplan::interrupt::checkpoint();
            if raised.is_any() { Err(()) } else { Ok(()) }
        });
        rows
    })?;
    Ok(Rows { rows })
}

/// Rows of a study.
#[pyclass(frozen, eq, module = "cplan")]
#[derive(PartialEq)]
pub struct Rows {
    rows: Vec<Row>,
}

#[pymethods]
impl Rows {
    /// Creates rows by joining parts.
    #[new]
    #[pyo3(signature = (*parts))]
    fn new(parts: Vec<PyRef<'_, Rows>>) -> Self {
        Self { rows: parts.iter().flat_map(|part| part.rows.iter().cloned()).collect() }
    }

    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// Splits into the first `count` rows and the others.
    fn split(&self, count: usize) -> (Self, Self) {
        let (first, others) = self.rows.split_at(count.min(self.rows.len()));
        (Self { rows: first.to_vec() }, Self { rows: others.to_vec() })
    }

    /// Returns the values of a row, in the order of the parameters.
    fn values(&self, row: usize) -> PyResult<Vec<f64>> {
        self.rows.get(row).map(|row| row.values.clone()).ok_or_else(|| PyValueError::new_err("there is no such row"))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let data = serde_json::to_vec(&slf.get().rows).map_err(refused)?;
        let restored = slf.py().import("cplan._cplan")?.getattr("rows_restored")?;
        Ok((restored, (PyBytes::new(slf.py(), &data),)))
    }
}

/// Restores pickled rows.
#[pyfunction]
pub fn rows_restored(data: &[u8]) -> PyResult<Rows> {
    serde_json::from_slice(data).map(|rows| Rows { rows }).map_err(refused)
}

/// The rows of a running study on disk.
#[pyclass(frozen, module = "cplan")]
pub struct Journal {
    journal: Mutex<Option<study::Journal>>,
}

#[pymethods]
impl Journal {
    /// Opens the journal of a study, and returns it with the rows of an earlier run; `fresh` drops these.
    #[staticmethod]
    fn open(path: PathBuf, study: &Study, fresh: bool) -> PyResult<(Self, Rows)> {
        let (journal, rows) = study::Journal::open(&path, &study.study, fresh).map_err(failed)?;
        Ok((Self { journal: Mutex::new(Some(journal)) }, Rows { rows }))
    }

    /// Adds the next rows, and writes them to disk.
    fn add(&self, rows: &Rows) -> PyResult<()> {
        let mut journal = self.journal.lock().map_err(refused)?;
        let journal = journal.as_mut().ok_or_else(|| PyValueError::new_err("the journal is removed"))?;
        rows.rows.iter().try_for_each(|row| journal.add(row)).and_then(|()| journal.flush()).map_err(failed)
    }

    /// Removes the journal.
    fn remove(&self) -> PyResult<()> {
        self.journal.lock().map_err(refused)?.take().map_or(Ok(()), study::Journal::remove).map_err(failed)
    }
}

fn failed(error: study::JournalError) -> PyErr {
    PyOSError::new_err(error.to_string())
}
