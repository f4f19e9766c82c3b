//! Passes lines to jobs, and writes their answers in the order of the lines.

use crate::cli::failure::Failure;
use crate::parallel::run_in_order;
use std::io::{BufRead, ErrorKind, Read, Write};
use std::sync::{Condvar, Mutex, PoisonError};

/// Greatest length of a line, in bytes. So endless input ends with an error.
const MAX_LINE_BYTES: u64 = 64 << 20;

/// The byte order mark, which some programs write before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// A line that is not blank, and its number among all lines, from 1.
pub struct Line {
    pub number: usize,
    pub text: Vec<u8>,
}

/// Counts of the input.
#[derive(Debug, Clone, Copy, Default)]
pub struct Count {
    /// Number of lines that are not blank.
    pub lines: usize,
    /// Number of these lines that are JSON objects.
    pub objects: usize,
}

/// Input for all jobs.
pub struct Input<R> {
    reader: R,
    /// Name of the input in messages.
    name: String,
    /// Number of lines that have been read, including blank ones.
    count: usize,
    /// Number of lines that have been passed to jobs.
    lines: usize,
    /// True if there are no further lines, or the last one could not be read.
    is_over: bool,
}

impl<R: BufRead + Send> Input<R> {
    /// Creates the state before any line is read.
    pub fn new(reader: R, name: &str) -> Self {
        Self { reader, name: name.to_owned(), count: 0, lines: 0, is_over: false }
    }

    /// Answers all lines with this number of jobs. `answer` returns the answer, and true if the line was a JSON object.
    /// Also ends when the reader of the output closes it.
    ///
    /// # Errors
    /// Input that cannot be read, and output that cannot be written.
    pub fn answer_all(
        self,
        mut writer: impl Write,
        jobs: usize,
        answer: impl Fn(&Line) -> (String, bool) + Sync,
    ) -> Result<Count, Failure> {
        let (shared, turn_changed) = (Mutex::new(self), Condvar::new());
        let input = || shared.lock().unwrap_or_else(PoisonError::into_inner);
        let work = |turn| {
            // Each job waits until all previous lines are read.
            let is_early = |input: &mut Self| input.lines != turn && !input.is_over;
            let line = turn_changed.wait_while(input(), is_early).unwrap_or_else(PoisonError::into_inner).next();
            turn_changed.notify_all();
            line.map(|line| line.map(|line| answer(&line)))
        };
        let mut count = Count::default();
        let mut write = |(text, is_object): (String, bool)| {
            count.lines += 1;
            count.objects += usize::from(is_object);
            writer.write_all(text.as_bytes()).and_then(|()| writer.flush()).map_err(|error| {
                (error.kind() != ErrorKind::BrokenPipe).then(|| Failure::Io(format!("stdout: {error}")))
            })
        };
        // If nothing failed, the work ends with `None`.
        let ended = run_in_order(usize::MAX, jobs, work, |answered| {
            answered.map_err(Some).and_then(|answered| answered.ok_or(None)).and_then(&mut write).inspect_err(|_| {
                // Jobs must not wait for lines that will not be read.
                input().is_over = true;
                turn_changed.notify_all();
            })
        });
        ended.or_else(|failure: Option<Failure>| failure.map_or(Ok(()), Err)).map(|()| count)
    }

    /// Returns the next line that is not blank. `None` if there are no more.
    fn next(&mut self) -> Result<Option<Line>, Failure> {
        let line = if self.is_over { Ok(None) } else { self.read() };
        self.is_over = !matches!(line, Ok(Some(_)));
        self.lines += 1;
        line
    }

    fn read(&mut self) -> Result<Option<Line>, Failure> {
        loop {
            let mut text = Vec::new();
            let read = (&mut self.reader).take(MAX_LINE_BYTES + 1).read_until(b'\n', &mut text);
            self.count += 1;
            let number = self.count;
            if number == 1 && text.starts_with(BYTE_ORDER_MARK) {
                text.drain(..BYTE_ORDER_MARK.len());
            }
            let place = || format!("{}: line {number}", self.name);
            match read {
                Err(error) => {
                    let cure = "check that it is a complete text file";
                    return Err(Failure::Io(format!("{} cannot be read: {error}\n  hint: {cure}", place())));
                }
                Ok(0) => return Ok(None),
                Ok(bytes) if bytes as u64 > MAX_LINE_BYTES => {
                    let message = format!("{} is longer than {} MiB", place(), MAX_LINE_BYTES >> 20);
                    return Err(Failure::Refused(format!("{message}\n  hint: write each problem on its own line")));
                }
                Ok(_) if text.trim_ascii().is_empty() => (),
                Ok(_) => return Ok(Some(Line { number, text })),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    #[test]
    fn answers_leave_in_order_and_few_wait() {
        const JOBS: usize = 3;
        let lines: String = (0..1000).map(|number| format!("{number}\n\n")).collect();
        let mut written = Vec::new();
        let done = AtomicUsize::new(0);
        let answer = |line: &Line| {
            // The first line is answered while all other jobs wait for it.
            if line.number == 1 {
                while done.load(Ordering::SeqCst) < 150 {
                    std::thread::yield_now();
                }
                std::thread::sleep(Duration::from_millis(20));
                assert!(done.load(Ordering::SeqCst) < 300, "more lines were answered than may wait");
            }
            done.fetch_add(1, Ordering::SeqCst);
            (String::from_utf8(line.text.clone()).unwrap(), line.number % 4 == 1)
        };
        let count = Input::new(lines.as_bytes(), "input").answer_all(&mut written, JOBS, answer).unwrap();
        assert_eq!((count.lines, count.objects), (1000, 500));
        assert_eq!(
            String::from_utf8(written).unwrap(),
            (0..1000).map(|number| format!("{number}\n")).collect::<String>()
        );
    }
}
