//! Ctrl-C, while Python waits for work.

use cplan::interrupt::{Interrupt, Interrupted};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// How often work asks whether there was a signal.
const EVERY: Duration = Duration::from_millis(20);

/// Does `work` while other threads of Python run. What a signal's handler raises, [`KeyboardInterrupt`] as a rule, ends it.
///
/// Handlers run in Python's main thread, so work in another one is not ended by Ctrl-C.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let raised = Arc::new(Mutex::new(None));
    let slot = raised.clone();
    let interrupt = Interrupt::new().asking(EVERY, move || {
        let signal = Python::attach(|py| py.check_signals()).err();
        let is_raised = signal.is_some();
        if let (true, Ok(mut slot)) = (is_raised, slot.lock()) {
            *slot = signal;
        }
        is_raised
    });
    py.detach(|| interrupt.run(work)).map_err(|why: Interrupted| {
        let signal = raised.lock().ok().and_then(|mut slot| slot.take());
        signal.unwrap_or_else(|| PyKeyboardInterrupt::new_err(why.to_string()))
    })
}
