//! What a job still does when Ctrl-C ends it.

use std::process::exit;

/// The exit code of what Ctrl-C ends, as shells have it.
const STOPPED: i32 = 130;

/// Has `last` done before Ctrl-C ends the process. Where the system lets nobody wait for it, it ends the process as ever.
pub fn before_it_ends(last: impl FnOnce() + Send + 'static) {
    let mut last = Some(last);
    let _ = ctrlc::set_handler(move || {
        if let Some(last) = last.take() {
            last();
        }
        exit(STOPPED);
    });
}
