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

/// More kinds than this are counted as one: nobody reads them.
const MOST_KINDS: usize = 48;

/// Notes in the order in which their kinds came up.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Notes(Vec<Note>);

impl Notes {
    /// Notes something, and the line that it is in.
    pub fn add(&mut self, message: impl Into<String>, line: Option<usize>) {
        let message = message.into();
        match self.0.iter_mut().position(|note| note.message == message) {
            Some(known) => self.0[known].count += 1,
            None if self.0.len() < MOST_KINDS => self.0.push(Note { message, count: 1, line }),
            None if self.0.len() == MOST_KINDS => self.0.push(Note { message: "other things".into(), count: 1, line }),
            None => self.0[MOST_KINDS].count += 1,
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &Note> {
        self.0.iter()
    }
}
