//! Notes about a drawing. Equal notes are counted, so that a thousand ignored texts give one note.

use std::collections::HashMap;
use std::fmt;

/// A note about elements that were omitted or changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// Kind of element and what was done to it, such as `TEXT: left out`.
    pub message: String,
    /// Number of occurrences.
    pub count: usize,
    /// Line of the first occurrence, in formats that have lines.
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

/// Greatest number of different notes that are listed, because nobody would read more. All others are counted together.
const MAX_KINDS: usize = 48;

/// Notes, counted for each pair of element and message.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Notes {
    counted: Vec<(Vec<String>, Note)>,
    /// Index of each note, by the words that select its element and by its message.
    places: HashMap<(Vec<String>, String), usize>,
}

impl Notes {
    /// Adds a note about the whole drawing, with its line.
    pub fn add(&mut self, message: impl Into<String>, line: Option<usize>) {
        self.add_of(Vec::new(), message, line);
    }

    /// Adds a note about an element that can be selected. `whose` lists the words that select it: layer and name.
    pub fn add_of(&mut self, whose: Vec<String>, message: impl Into<String>, line: Option<usize>) {
        let message = message.into();
        let place = *self.places.entry((whose.clone(), message.clone())).or_insert_with(|| {
            self.counted.push((whose, Note { message, count: 0, line }));
            self.counted.len() - 1
        });
        self.counted[place].1.count += 1;
    }

    /// Returns all notes, in the order of their first occurrences.
    pub fn all(&self) -> Vec<Note> {
        self.of(|_| true)
    }

    /// Returns the notes about the whole drawing and about selected elements.
    pub fn of(&self, is_asked_for: impl Fn(&[String]) -> bool) -> Vec<Note> {
        let mut kinds: Vec<Note> = Vec::new();
        let asked = self.counted.iter().filter(|(whose, _)| whose.is_empty() || is_asked_for(whose));
        for (_, note) in asked {
            match kinds.iter().position(|kind| kind.message == note.message) {
                Some(known) => kinds[known].count += note.count,
                None if kinds.len() < MAX_KINDS => kinds.push(note.clone()),
                None if kinds.len() == MAX_KINDS => {
                    kinds.push(Note { message: "other things".into(), ..note.clone() });
                }
                None => kinds[MAX_KINDS].count += note.count,
            }
        }
        kinds
    }
}
