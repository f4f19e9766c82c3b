//! Shows the progress of many runs or layouts on stderr.

use super::print_args::PrintArgs;
use super::sinks;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time between lines if stderr is not a terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// Least time between two drawings of the bar.
const REDRAW_INTERVAL: Duration = Duration::from_millis(50);

/// Width of the bar, in characters.
const BAR_WIDTH: usize = 16;

/// Width of a line, in characters. It is less than that of usual terminals, because a wrapped line cannot be redrawn.
const LINE_WIDTH: usize = 78;

/// The form in which progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ProgressMode {
    /// Prints nothing.
    Silent,
    /// Redraws a bar.
    Bar,
    /// Prints a line at intervals, and at the end.
    Lines,
    /// Prints a line at intervals. For work that usually ends before the first line.
    LongLines,
}

/// Counts runs and shows their number.
#[derive(Debug)]
pub struct Progress {
    mode: ProgressMode,
    /// Plural name of the counted items: runs or layouts.
    noun: &'static str,
    total: usize,
    started: Instant,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    done: usize,
    now: String,
    /// Time at which the display last changed.
    shown: Instant,
}

impl Progress {
    /// Creates a display for `total` runs, or other items named `noun`. On a terminal, it shows a bar, which vanishes
    /// at the end. Otherwise it prints a line every ten seconds, and a last line unless there is a `single` problem.
    pub fn new(total: usize, noun: &'static str, single: bool, quiet: bool) -> Self {
        let mode = match (quiet, single) {
            (true, _) => ProgressMode::Silent,
            (false, _) if std::io::stderr().is_terminal() => ProgressMode::Bar,
            (false, true) => ProgressMode::LongLines,
            (false, false) => ProgressMode::Lines,
        };
        let now = Instant::now();
        Self { mode, noun, total, started: now, state: Mutex::new(State { done: 0, now: String::new(), shown: now }) }
    }

    /// Shows the beginning of a run.
    pub fn begin(&self, problem: &str, planner: &str) {
        if self.mode != ProgressMode::Bar {
            return;
        }
        let mut state = self.state();
        state.now = format!("{planner} on {problem}");
        if state.done == 0 || state.shown.elapsed() >= REDRAW_INTERVAL {
            state.shown = Instant::now();
            print_on_stderr(&format!("\r{}", bar(state.done, self.total, self.started.elapsed(), &state.now)));
        }
    }

    /// Counts the end of a run.
    pub fn done(&self) {
        let mut state = self.state();
        state.done += 1;
        // The bar is redrawn when the next run begins.
        let prints_lines = matches!(self.mode, ProgressMode::Lines | ProgressMode::LongLines);
        if prints_lines && state.shown.elapsed() >= LINE_INTERVAL {
            state.shown = Instant::now();
            sinks::print_status(&line(state.done, self.total, self.noun, self.started.elapsed()));
        }
    }

    /// Ends the display: removes the bar, or prints a last line.
    pub fn end(&self) {
        match self.mode {
            ProgressMode::Silent | ProgressMode::LongLines => {}
            ProgressMode::Bar => print_on_stderr(&format!("\r{:LINE_WIDTH$}\r", "")),
            ProgressMode::Lines => {
                // A search may end before it has made all allowed runs.
                let done = self.state().done;
                sinks::print_status(&line(done, done, self.noun, self.started.elapsed()));
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Prints on stderr. Ignores a closed stream.
fn print_on_stderr(text: &str) {
    let mut stderr = std::io::stderr().lock();
    let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// Returns the number of runs per second, and the remaining time at this rate, or `None` if it is not known yet.
fn rate(done: usize, total: usize, elapsed: Duration) -> (f64, Option<String>) {
    let rate = done as f64 / elapsed.as_secs_f64().max(1e-3);
    (rate, (done > 0 && done < total).then(|| time((total - done) as f64 / rate)))
}

/// Formats whole seconds in their two largest units: `45 s`, `3 min 20 s`, `2 h 5 min`.
fn time(seconds: f64) -> String {
    let seconds = seconds.ceil() as u64;
    let (minutes, hours) = (seconds / 60, seconds / 3600);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {} s", seconds % 60),
        _ => format!("{hours} h {} min", minutes % 60),
    }
}

/// Returns a line such as `37 of 1000 runs, 12.3 a second, 78 s left`.
fn line(done: usize, total: usize, noun: &str, elapsed: Duration) -> String {
    let (rate, left) = rate(done, total, elapsed);
    let left = left.map_or_else(String::new, |left| format!(", {left} left"));
    format!("{done} of {total} {noun}, {rate:.1} a second{left}")
}

/// Returns a progress bar with the numbers of [`line`], and with the name of the current run if there is room. Its
/// width never changes.
fn bar(done: usize, total: usize, elapsed: Duration, now: &str) -> String {
    let full = (BAR_WIDTH * done).checked_div(total).unwrap_or(BAR_WIDTH).min(BAR_WIDTH);
    let (rate, left) = rate(done, total, elapsed);
    let left = left.map_or_else(String::new, |left| format!(" {left} left"));
    let text =
        format!("[{}{}] {done}/{total} {rate:.1}/s{left}  {now}", "#".repeat(full), ".".repeat(BAR_WIDTH - full));
    let cut: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(LINE_WIDTH).collect();
    format!("{cut:LINE_WIDTH$}")
}

/// Returns a function that reports how many frames of an animation are drawn. It prints at intervals, and only if the
/// animation takes long.
pub fn pictures_done(path: &Path, print: &PrintArgs) -> impl FnMut(usize, usize) {
    const PICTURE_INTERVAL: Duration = Duration::from_secs(5);
    let begun = Instant::now();
    let mut reported = begun;
    move |done, all| {
        if reported.elapsed() > PICTURE_INTERVAL {
            reported = Instant::now();
            print.print_status(&format!("{}: {}", path.display(), line(done, all, "pictures", begun.elapsed())));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_wide_as_the_line_and_fill_up() {
        let second = Duration::from_secs(1);
        for (done, full) in [(0, 0), (5, 8), (10, 16)] {
            let bar = bar(done, 10, second, "a planner with a very long name on a problem with a very long name");
            assert_eq!((bar.chars().count(), bar.matches('#').count()), (LINE_WIDTH, full), "{bar}");
        }
        assert_eq!(bar(0, 0, second, "\n").chars().count(), LINE_WIDTH);
    }

    #[test]
    fn times_have_two_units() {
        assert_eq!([0.2, 59.5, 200.0, 7500.0].map(time), ["1 s", "1 min 0 s", "3 min 20 s", "2 h 5 min"]);
    }

    #[test]
    fn lines_show_rate_and_remaining_time() {
        assert_eq!(line(20, 100, "runs", Duration::from_secs(4)), "20 of 100 runs, 5.0 a second, 16 s left");
        assert_eq!(line(100, 100, "layouts", Duration::from_secs(4)), "100 of 100 layouts, 25.0 a second");
        let bar = bar(20, 100, Duration::from_secs(4), "visibility on shelf");
        assert_eq!(bar.trim_end(), "[###.............] 20/100 5.0/s 16 s left  visibility on shelf");
        assert_eq!(line(0, 9, "runs", Duration::ZERO), "0 of 9 runs, 0.0 a second");
    }
}
