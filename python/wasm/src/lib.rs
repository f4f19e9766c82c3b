//! The back end of the Python package for Pythons without an extension module, as WebAssembly.
//!
//! ```text
//! cplan/_cplan.py -> JSON in the memory, call() -> Session -> [kind, bytes] -> cplan/_cplan.py
//! ```
//!
//! Files, clock and output are those of Python, by the system calls of WASI (`cplan/_wasi.py`). Built for
//! `wasm32-wasip1` alone, by `.ci/wheel`; for all else this crate is empty.
#![cfg(all(target_family = "wasm", target_os = "wasi"))]

mod answer;
mod request;
mod session;

use cplan::interrupt::Interrupt;
use session::Session;
use std::cell::RefCell;
use std::time::Duration;

// Functions of Python. Only numbers and addresses are passed, and Python reads the memory before it returns, so calls are
// safe. An exception in Python ends this instance.
#[link(wasm_import_module = "python")]
unsafe extern "C" {
    /// Lets Python handle signals.
    safe fn poll();
    /// Passes a line of text on to the caller's `progress`.
    safe fn progress(at: *const u8, bytes: usize);
}

/// Interval at which work lets Python handle signals.
const SIGNAL_CHECK_INTERVAL: Duration = Duration::from_millis(20);

thread_local! {
    static SESSION: RefCell<Session> = RefCell::default();
    /// The request, and then its answer.
    static BUFFER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Returns the address to which a request of so many bytes is to be written.
// The name is used once, because there is no other library in the instance.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(bytes: usize) -> *mut u8 {
    BUFFER.with_borrow_mut(|buffer| {
        *buffer = vec![0; bytes];
        buffer.as_mut_ptr()
    })
}

/// Handles the request in the buffer, and returns the length of its answer.
// As above.
#[unsafe(no_mangle)]
pub extern "C" fn call() -> usize {
    let request = BUFFER.take();
    let interrupt = Interrupt::new().with_callback(SIGNAL_CHECK_INTERVAL, || {
        poll();
        false
    });
    let mut report = |line: &str| progress(line.as_ptr(), line.len());
    let answered = interrupt.run(|| SESSION.with_borrow_mut(|session| session.answer(&request, &mut report)));
    BUFFER.replace(answered.unwrap_or_default());
    BUFFER.with_borrow(Vec::len)
}

/// Returns the address of the answer.
// As above.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    BUFFER.with_borrow(|buffer| buffer.as_ptr())
}
