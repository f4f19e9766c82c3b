//! Signals that end the process.

use signal_hook::consts::SIGINT;
use signal_hook::flag;
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

pub use signal_hook::consts::SIGTERM;

/// Interval of the checks for a signal.
const INTERVAL: Duration = Duration::from_millis(20);

/// Runs `last` before Ctrl-C or one of these signals ends the process. Its result becomes the exit code. On systems
/// that cannot handle a signal, the process ends as usual.
pub fn run_before_exit(signals: &[i32], last: impl FnOnce() -> i32 + Send + 'static) {
    let is_ended = Arc::new(AtomicBool::new(false));
    for &signal in signals.iter().chain(&[SIGINT]) {
        let _ = flag::register(signal, Arc::clone(&is_ended));
    }
    thread::spawn(move || {
        while !is_ended.load(Ordering::Relaxed) {
            thread::sleep(INTERVAL);
        }
        exit(last())
    });
}
