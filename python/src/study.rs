//! Studies: one task in many layouts.

use crate::error::{raised, refused};
use crate::problem::{Arm, World};
use crate::signals::interruptible;
use cplan::study::{self, Row, Summary};
use cplan_calls::Column;
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

#[pymethods]
impl Study {
    /// Reads a study file (TOML), and the robot and world that it names. `sources` are the texts of a pickled study,
    /// which replace the files.
    #[new]
    #[pyo3(signature = (path, sources = None))]
    fn new(py: Python<'_>, path: PathBuf, sources: Option<&str>) -> PyResult<Self> {
        let study = match sources {
            Some(sources) => cplan_calls::study_of_sources(sources),
            // Absolute, so that a pickled study finds maps and meshes elsewhere.
            None => {
                let path = std::path::absolute(&path)?;
                py.detach(|| cplan_calls::read_study(path))
            }
        };
        study.map(|study| Self { study }).map_err(|refusal| raised(py, refusal))
    }

    /// Returns `sources` for a study with this text, a robot that was read from a URDF, and a world.
    #[staticmethod]
    fn sources(py: Python<'_>, text: String, arm: &Arm, world: &World) -> PyResult<String> {
        cplan_calls::study_sources(text, &arm.0, &world.0).map_err(|refusal| raised(py, refusal))
    }

    /// The title of the study.
    #[getter]
    fn name(&self) -> &str {
        &self.study.name
    }

    /// Names of the parameters.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        cplan_calls::parameter_names(&self.study)
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
        let numbers = cplan_calls::layout_values(&self.study, layout).map_err(|refusal| raised(py, refusal))?;
        let values = PyDict::new(py);
        for (parameter, value) in self.study.parameters.iter().zip(numbers) {
            values.set_item(&parameter.name, value)?;
        }
        Ok(values)
    }

    /// Returns robot and world with the values of a row.
    fn layout(&self, py: Python<'_>, values: Vec<f64>) -> PyResult<(Arm, World)> {
        let (arm, world) = cplan_calls::layout(&self.study, &values).map_err(|refusal| raised(py, refusal))?;
        Ok((Arm(arm), World(world)))
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
        let columns = PyDict::new(py);
        for (name, column) in cplan_calls::table(&self.study, &rows.rows) {
            match column {
                Column::Counts(counts) => columns.set_item(name, PyArray1::from_vec(py, counts))?,
                Column::Numbers(numbers) => {
                    let numbers = numbers.into_iter().map(|number| number.unwrap_or(f64::NAN));
                    columns.set_item(name, PyArray1::from_iter(py, numbers))?;
                }
                Column::Flags(flags) => columns.set_item(name, PyArray1::from_vec(py, flags))?,
                Column::Words(words) => columns.set_item(name, words)?,
            }
        }
        Ok(columns)
    }

    fn __repr__(&self) -> String {
        cplan_calls::study_description(&self.study)
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
