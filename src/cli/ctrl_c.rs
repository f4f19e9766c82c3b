//! What a job still does when Ctrl-C ends it.

use std::process::exit;
use std::thread;

/// The exit code of what Ctrl-C ends, as shells have it.
const STOPPED: i32 = 130;

/// Has `last` done before Ctrl-C ends the process. Where nobody can be told of it, it ends the process as ever.
pub fn before_it_ends(last: impl FnOnce() + Send + 'static) {
    let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
    thread::spawn(move || {
        if runtime.block_on(tokio::signal::ctrl_c()).is_ok() {
            last();
            exit(STOPPED);
        }
    });
}
