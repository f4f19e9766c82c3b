//! Work that a command still does when Ctrl-C ends it.

use std::process::exit;

/// The exit code of a process that Ctrl-C ends. It is the same as in shells.
const EXIT_STOPPED: i32 = 130;

/// Runs `last` before Ctrl-C ends the process. On systems that cannot handle Ctrl-C, it ends the process as usual.
pub fn run_before_exit(last: impl FnOnce() + Send + 'static) {
    let mut last = Some(last);
    let _ = ctrlc::set_handler(move || {
        if let Some(last) = last.take() {
            last();
        }
        exit(EXIT_STOPPED);
    });
}
