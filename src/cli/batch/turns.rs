//! Passes lines to jobs and collects their answers. A job that has answered a line takes the next one. Answers are
//! written in the order of the lines.

use crate::cli::failure::Failure;
use std::collections::BTreeMap;
use std::io::{self, BufRead, ErrorKind, Read, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Longest line, in bytes. With this limit, endless input ends with an error.
const MAX_LINE_BYTES: u64 = 64 << 20;

/// The byte order mark, which some programs write before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// Largest number of answers per job that wait until an earlier line is answered. It is enough to keep all jobs busy
/// during a hard problem.
const MAX_WAITING_PER_JOB: usize = 64;

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

/// Input and output that all jobs share.
pub struct Turns<R, W> {
    input: Mutex<Input<R>>,
    output: Mutex<Output<W>>,
    turn_changed: Condvar,
    most: usize,
}

struct Input<R> {
    reader: R,
    /// Name of the input in messages.
    name: String,
    /// Number of lines that have been read, including blank ones.
    read: usize,
    /// Number of lines that have been passed to jobs.
    given: usize,
}

struct Output<W> {
    writer: W,
    waiting: BTreeMap<usize, String>,
    written: usize,
    count: Count,
    /// The reason why the work has ended; `None` while it continues. If the reader of the output has closed it, that is
    /// no failure.
    ended: Option<Result<(), Failure>>,
}

impl<R: BufRead, W: Write> Turns<R, W> {
    /// Creates the state before any line is read.
    pub fn new(reader: R, name: &str, writer: W, jobs: usize) -> Self {
        let output = Output { writer, waiting: BTreeMap::new(), written: 0, count: Count::default(), ended: None };
        Self {
            input: Mutex::new(Input { reader, name: name.to_owned(), read: 0, given: 0 }),
            output: Mutex::new(output),
            turn_changed: Condvar::new(),
            most: MAX_WAITING_PER_JOB * jobs,
        }
    }

    /// Answers lines until there are no more. `answer` returns the answer, and true if the line was a JSON object.
    pub fn work(&self, mut answer: impl FnMut(&Line) -> (String, bool)) {
        while self.has_room() {
            match self.next() {
                Ok(Some((turn, line))) => {
                    let (text, is_object) = answer(&line);
                    self.write_in_order(turn, text, is_object);
                }
                Ok(None) => return,
                Err(failure) => self.output().end(Err(failure)),
            }
        }
    }

    /// Returns the counts.
    ///
    /// # Errors
    /// The failure that ended the work.
    pub fn end(self) -> Result<Count, Failure> {
        let output = self.output.into_inner().unwrap_or_else(PoisonError::into_inner);
        output.ended.unwrap_or(Ok(())).map(|()| output.count)
    }

    /// Waits until there is room to store another answer that is not yet due. Returns false if the work has ended.
    fn has_room(&self) -> bool {
        let is_full = |output: &mut Output<W>| output.ended.is_none() && output.waiting.len() >= self.most;
        self.turn_changed.wait_while(self.output(), is_full).unwrap_or_else(PoisonError::into_inner).ended.is_none()
    }

    /// Returns the next line that is not blank, and its number among the lines that are not blank.
    fn next(&self) -> Result<Option<(usize, Line)>, Failure> {
        let mut input = self.input.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            let mut text = Vec::new();
            let read = (&mut input.reader).take(MAX_LINE_BYTES + 1).read_until(b'\n', &mut text);
            input.read += 1;
            let number = input.read;
            if number == 1 && text.starts_with(BYTE_ORDER_MARK) {
                text.drain(..BYTE_ORDER_MARK.len());
            }
            let place = || format!("{}: line {number}", input.name);
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
                Ok(_) => {
                    input.given += 1;
                    return Ok(Some((input.given - 1, Line { number, text })));
                }
            }
        }
    }

    /// Writes an answer and those that waited for it. If earlier lines are not answered yet, stores it instead.
    fn write_in_order(&self, turn: usize, text: String, is_object: bool) {
        let mut output = self.output();
        output.count.lines += 1;
        output.count.objects += usize::from(is_object);
        output.waiting.insert(turn, text);
        let mut ready = String::new();
        loop {
            let next = output.written;
            let Some(text) = output.waiting.remove(&next) else { break };
            ready.push_str(&text);
            output.written += 1;
        }
        match output.write(&ready) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => output.end(Ok(())),
            Err(error) => output.end(Err(Failure::Io(format!("stdout: {error}")))),
            Ok(()) => (),
        }
        self.turn_changed.notify_all();
    }

    fn output(&self) -> MutexGuard<'_, Output<W>> {
        self.output.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<W: Write> Output<W> {
    fn write(&mut self, text: &str) -> io::Result<()> {
        if text.is_empty() || self.ended.is_some() {
            return Ok(());
        }
        self.writer.write_all(text.as_bytes())?;
        self.writer.flush()
    }

    /// Ends the work. Only the first reason is recorded.
    fn end(&mut self, why: Result<(), Failure>) {
        self.ended.get_or_insert(why);
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
        let turns = Turns::new(lines.as_bytes(), "input", &mut written, JOBS);
        let done = AtomicUsize::new(0);
        let answer = |line: &Line| {
            // The first line is answered when all other jobs wait for it.
            if line.number == 1 {
                while done.load(Ordering::SeqCst) < MAX_WAITING_PER_JOB * JOBS {
                    std::thread::yield_now();
                }
                std::thread::sleep(Duration::from_millis(20));
                assert!(done.load(Ordering::SeqCst) < MAX_WAITING_PER_JOB * JOBS + JOBS);
            }
            done.fetch_add(1, Ordering::SeqCst);
            (String::from_utf8(line.text.clone()).unwrap(), line.number % 4 == 1)
        };
        std::thread::scope(|scope| (0..JOBS).for_each(|_| drop(scope.spawn(|| turns.work(answer)))));
        let count = turns.end().unwrap();
        assert_eq!((count.lines, count.objects), (1000, 500));
        assert_eq!(
            String::from_utf8(written).unwrap(),
            (0..1000).map(|number| format!("{number}\n")).collect::<String>()
        );
    }
}
