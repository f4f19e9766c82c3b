//! Collects the words that have no effect on the line, and those that cplan cannot follow.

use super::meaning::{Reason, machine_place};
use super::words::Word;
use crate::{Error, Source};
use std::collections::BTreeMap;

/// Greatest number of line numbers that an error lists for a word; it only counts further ones.
const MAX_LISTED_LINES: usize = 8;

/// The remarks about a program.
#[derive(Default)]
pub(super) struct Remarks {
    /// For each word without an effect, how often it occurs.
    listed: BTreeMap<String, usize>,
    /// Refused words by name, in the order of the file.
    refused: Vec<Refused>,
    /// Refused moves to positions of the machine, each with the number of drawn pieces before it.
    homes: Vec<(String, Source, usize)>,
    /// Number of drawn pieces so far.
    pub drawn: usize,
    /// True if moves to positions of the machine are allowed. They are then listed.
    pub allows_homes: bool,
    /// True if the last line moved the tip to a position of the machine.
    pub is_home: bool,
}

/// A word that cplan cannot follow.
struct Refused {
    name: String,
    reason: Reason,
    places: Vec<Source>,
}

/// Returns the name under which a word is counted.
pub(super) fn name(word: &Word) -> String {
    match word.value.filter(|_| "GM".contains(word.letter)) {
        Some(value) => format!("{}{value}", word.letter),
        None if word.letter == '#' => word.text.clone(),
        None => word.letter.to_string(),
    }
}

impl Remarks {
    /// Counts a word without an effect on the line.
    pub fn list(&mut self, name: String) {
        *self.listed.entry(name).or_default() += 1;
    }

    /// Adds a word that cplan cannot follow.
    pub fn refuse(&mut self, name: String, reason: Reason, source: Source) {
        match self.refused.iter_mut().find(|known| known.name == name && known.reason == reason) {
            Some(known) => known.places.push(source),
            None => self.refused.push(Refused { name, reason, places: vec![source] }),
        }
    }

    /// Records a move to a position of the machine.
    pub fn add_home(&mut self, word: &Word) {
        if self.allows_homes {
            self.is_home = true;
            self.list(name(word));
        } else {
            self.homes.push((name(word), word.source, self.drawn));
        }
    }

    /// Returns true if, since the last call, an allowed move to a position of the machine has occurred.
    pub fn takes_home(&mut self) -> bool {
        std::mem::take(&mut self.is_home) && self.allows_homes
    }

    /// Returns the note about words without an effect on the line.
    pub fn note(&self) -> Option<String> {
        let counted = |(name, count): (&String, &usize)| match name.as_str() {
            "Z" => format!("Z ({})", cplan_text::counted(*count, "height")),
            name => format!("{name} ({count})"),
        };
        let counts: Vec<String> = self.listed.iter().map(counted).collect();
        (!counts.is_empty()).then(|| format!("words without effect on the line: {}", counts.join(", ")))
    }

    /// Returns an error that lists all words that cplan cannot follow, with their lines.
    pub fn error(&mut self) -> Option<Error> {
        for (name, source, drawn) in std::mem::take(&mut self.homes) {
            self.refuse(name, machine_place(0 < drawn && drawn < self.drawn), source);
        }
        self.refused.sort_by_key(|refused| refused.places[0].line);
        let first = self.refused.first()?.places.first()?;
        let is_single = self.refused.len() == 1 && self.refused[0].places.len() == 1;
        let mut hints: Vec<&str> = Vec::new();
        for Refused { reason, .. } in &self.refused {
            if !hints.contains(&reason.hint) {
                hints.push(reason.hint);
            }
        }
        let described = |refused: &Refused| {
            let lines = if is_single { String::new() } else { format!(" ({})", lines(&refused.places)) };
            format!("{} {}{lines}", refused.name, refused.reason.does)
        };
        let messages: Vec<String> = self.refused.iter().map(described).collect();
        Some(Error::new(first.line, first.column, messages.join("; "), hints.join("; ")))
    }
}

/// Formats the line numbers of places: `line 3`, `lines 3, 5 and 7 more`.
fn lines(places: &[Source]) -> String {
    let mut numbers: Vec<usize> = places.iter().map(|source| source.line).collect();
    numbers.dedup();
    let shown: Vec<String> = numbers.iter().take(MAX_LISTED_LINES).map(usize::to_string).collect();
    let more = numbers.len().saturating_sub(MAX_LISTED_LINES);
    let noun = if numbers.len() == 1 { "line" } else { "lines" };
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("{noun} {}{rest}", shown.join(", "))
}
