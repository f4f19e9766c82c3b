//! Ctrl-C, while Python waits for work.

use cplan::interrupt::Interrupt;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often work asks whether there was a signal.
const EVERY: Duration = Duration::from_millis(20);

/// Does `work` while other threads of Python run. What a signal's handler raises, [`KeyboardInterrupt`] as a rule, ends it.
///
/// Handlers run in Python's main thread, so work in another one is not ended by Ctrl-C.
///
/// What `work` leaves in `raised` ends it, too, at the next checkpoint, and is raised.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(&Raised) -> T + Send) -> PyResult<T> {
    let raised = Raised::default();
    let here = raised.clone();
    let interrupt = Interrupt::new().asking(EVERY, move || {
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

/// The first exception that came up.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// Keeps an exception, if it is the first.
    pub fn put(&self, error: PyErr) {
        self.slot().get_or_insert(error);
    }

    /// Whether there is one.
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
