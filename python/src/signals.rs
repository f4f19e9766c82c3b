//! Ctrl-C during long work.

use cplan::interrupt::Interrupt;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Interval at which work checks for signals.
const SIGNAL_CHECK_INTERVAL: Duration = Duration::from_millis(20);

/// Does `work` while other Python threads run. An exception of a signal handler, usually [`KeyboardInterrupt`], ends
/// it.
///
/// Handlers run in Python's main thread, so Ctrl-C does not end work in another thread.
///
/// An exception that `work` puts into `raised` also ends it, at the next checkpoint, and is raised.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(&RaisedException) -> T + Send) -> PyResult<T> {
    let raised = RaisedException::default();
    let here = raised.clone();
    let interrupt = Interrupt::new().with_callback(SIGNAL_CHECK_INTERVAL, move || {
        if let Err(signal) = Python::attach(|py| py.check_signals()) {
            here.put(signal);
        }
        here.is_any()
    });
    let done = py.detach(|| interrupt.run(|| work(&raised)));
    match (raised.take(), done) {
        (Some(error), _) => Err(error),
        (None, done) => done.map_err(|why| PyKeyboardInterrupt::new_err(why.to_string())),
    }
}

/// The first exception that occurred.
#[derive(Clone, Default)]
pub struct RaisedException(Arc<Mutex<Option<PyErr>>>);

impl RaisedException {
    /// Keeps an exception, if it is the first.
    pub fn put(&self, error: PyErr) {
        self.slot().get_or_insert(error);
    }

    /// Returns true if there is an exception.
    pub fn is_any(&self) -> bool {
        self.slot().is_some()
    }

    fn take(&self) -> Option<PyErr> {
        self.slot().take()
    }

    fn slot(&self) -> MutexGuard<'_, Option<PyErr>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
