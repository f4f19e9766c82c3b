//! What is to be said of a drawing, counted by kind, so that a thousand texts make one line.

use std::fmt;

/// Something that was not taken, or not as it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// Of what kind, such as `TEXT: left out`.
    pub message: String,
    /// How often.
    pub count: usize,
    /// Where first, in formats that have lines.
    pub line: Option<usize>,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        match (self.count, self.line) {
            (1, None) => Ok(()),
            (1, Some(line)) => write!(f, " (line {line})"),
            (count, None) => write!(f, " ({count} times)"),
            (count, Some(line)) => write!(f, " ({count} times, first in line {line})"),
        }
    }
}

/// Notes in the order in which their kinds came up.
#[derive(Debug, Default)]
pub(crate) struct Notes(Vec<Note>);

impl Notes {
    pub fn add(&mut self, message: impl Into<String>, line: Option<usize>) {
        let message = message.into();
        match self.0.iter_mut().find(|note| note.message == message) {
            Some(note) => note.count += 1,
            None => self.0.push(Note { message, count: 1, line }),
        }
    }

    pub fn into_list(self) -> Vec<Note> {
        self.0
    }
}
