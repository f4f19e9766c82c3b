//! Errors in what the user wrote: where, what, and the cure.

use super::source::Position;
use crate::model::{plain, plain_line};
use std::fmt;
use thiserror::Error;

/// What a defect is about, for scripts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DefectKind {
    /// A file or an option.
    #[default]
    Input,
    /// The start: missing, outside the limits, or not free.
    Start,
    /// The goal: missing, outside the limits, out of reach, or not free.
    Goal,
}

/// One thing that is wrong with the input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Defect {
    /// The file, or the command-line option, that it is in.
    pub origin: String,
    /// Where in the file, if that is known.
    pub position: Option<Position>,
    /// The line of the file with a caret below the place.
    pub excerpt: Option<Box<str>>,
    /// What is wrong, naming the joint, link or obstacle.
    pub message: String,
    /// What to do about it; each defect that reaches the user has one.
    pub cure: Option<String>,
    /// What it is about.
    pub kind: DefectKind,
}

impl Defect {
    /// A defect of a whole file or option.
    #[must_use]
    pub fn new(origin: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            origin: origin.into(),
            position: None,
            excerpt: None,
            message: message.into(),
            cure: None,
            kind: DefectKind::Input,
        }
    }

    /// The same with a cure.
    #[must_use]
    pub fn cure(self, cure: impl Into<String>) -> Self {
        Self { cure: Some(cure.into()), ..self }
    }

    /// The same about something else.
    #[must_use]
    pub fn about(self, kind: DefectKind) -> Self {
        Self { kind, ..self }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", plain_line(&self.origin))?;
        if let Some(Position { line, column }) = self.position {
            write!(f, ": line {line}, column {column}")?;
        }
        write!(f, ": {}", plain_line(&self.message))?;
        if let Some(excerpt) = &self.excerpt {
            write!(f, "\n{excerpt}")?;
        }
        if let Some(cure) = &self.cure {
            write!(f, "\n  cure: {}", plain(cure))?;
        }
        Ok(())
    }
}

/// Input that cannot be used. Displays every defect with its file, line and column, the source line, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", listed(.defects))]
pub struct InputError {
    defects: Vec<Defect>,
}

impl InputError {
    /// What is wrong: at least one defect, in the order of the file where that makes sense.
    #[must_use]
    pub fn defects(&self) -> &[Defect] {
        &self.defects
    }

    /// The same about something else.
    pub(super) fn about(self, kind: DefectKind) -> Self {
        Self { defects: self.defects.into_iter().map(|defect| defect.about(kind)).collect() }
    }

    /// All of these; at least one.
    pub(super) fn of(defects: Vec<Defect>) -> Self {
        debug_assert!(!defects.is_empty(), "an error without a defect");
        debug_assert!(defects.iter().all(|defect| defect.cure.is_some()), "a defect without a cure: {defects:?}");
        Self { defects }
    }

    /// `Ok` when there are no defects.
    pub(super) fn check(defects: Vec<Defect>) -> Result<(), Self> {
        if defects.is_empty() { Ok(()) } else { Err(Self::of(defects)) }
    }
}

impl From<Defect> for InputError {
    fn from(defect: Defect) -> Self {
        Self::of(vec![defect])
    }
}

/// More defects than this are counted, not shown: the first ones usually cause the rest.
const SHOWN: usize = 8;

fn listed(defects: &[Defect]) -> String {
    let mut lines: Vec<String> = defects.iter().take(SHOWN).map(ToString::to_string).collect();
    if defects.len() > SHOWN {
        lines.push(format!("... and {} more", defects.len() - SHOWN));
    }
    lines.join("\n")
}

/// More names than this are counted, not listed: nobody reads them, and each defect may have its own list.
const NAMED: usize = 64;

/// Names in quotes, separated by commas, for messages.
pub(super) fn quoted<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let mut all = names.into_iter();
    let mut names: Vec<String> = all.by_ref().take(NAMED).map(|n| format!("\"{}\"", n.as_ref())).collect();
    let more = all.count();
    if more > 0 {
        names.push(format!("... and {more} more"));
    }
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// A parser's message without the place at its end, which a defect gives at the beginning.
pub(super) fn without_place(message: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    message.split(" at line ").next().unwrap_or(message).to_owned()
}
