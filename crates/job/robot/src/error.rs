//! Errors in the user's input, with position, message and hint.

use super::source::Position;
use cplan_text::{plain, plain_line};
use std::fmt;
use thiserror::Error;

/// Category of a diagnostic, which scripts can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DiagnosticKind {
    /// A defect of a file or an option.
    #[default]
    Input,
    /// A start that is missing, outside the limits or blocked.
    Start,
    /// A goal that is missing, outside the limits, out of reach or blocked.
    Goal,
}

/// One defect of the input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file or command-line option with the defect.
    pub origin: String,
    /// Position in the file, if it is known.
    pub position: Option<Position>,
    /// The line of the file, with a caret below the defect.
    pub excerpt: Option<Box<str>>,
    /// Description of the defect, with the name of the joint, link or obstacle.
    pub message: String,
    /// Hint for the user. Every diagnostic that reaches the user has one.
    pub help: Option<String>,
    /// Category.
    pub kind: DiagnosticKind,
}

impl Diagnostic {
    /// Creates a diagnostic about a whole file or option.
    pub fn new(origin: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            origin: origin.into(),
            position: None,
            excerpt: None,
            message: message.into(),
            help: None,
            kind: DiagnosticKind::Input,
        }
    }

    /// Sets the hint.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// Sets the category.
    #[must_use]
    pub fn with_kind(self, kind: DiagnosticKind) -> Self {
        Self { kind, ..self }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", plain_line(&self.origin))?;
        if let Some(Position { line, column }) = self.position {
            write!(f, ": line {line}, column {column}")?;
        }
        write!(f, ": {}", plain_line(&self.message))?;
        if let Some(excerpt) = &self.excerpt {
            write!(f, "\n{excerpt}")?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n  hint: {}", plain(help))?;
        }
        Ok(())
    }
}

/// Unusable input. The text of the error has every diagnostic, with file, line and column, the line of the file, and a hint.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", list_diagnostics(.diagnostics))]
pub struct InputError {
    diagnostics: Vec<Diagnostic>,
}

impl InputError {
    /// Returns the diagnostics, at least one, usually in the order of the file.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// Replaces the name of an option in the messages, for commands that name the option differently.
    pub fn with_option(mut self, name: &str, called: &str) -> Self {
        for Diagnostic { origin, message, help, .. } in &mut self.diagnostics {
            [Some(origin), Some(message), help.as_mut()]
                .into_iter()
                .flatten()
                .for_each(|text| *text = text.replace(name, called));
        }
        self
    }

    /// Sets the category of all diagnostics.
    #[must_use]
    pub fn with_kind(self, kind: DiagnosticKind) -> Self {
        Self { diagnostics: self.diagnostics.into_iter().map(|diagnostic| diagnostic.with_kind(kind)).collect() }
    }

    /// Creates an error from diagnostics, of which there must be at least one, each with a hint.
    pub fn of(diagnostics: Vec<Diagnostic>) -> Self {
        debug_assert!(!diagnostics.is_empty(), "an error without a diagnostic");
        debug_assert!(
            diagnostics.iter().all(|diagnostic| diagnostic.help.is_some()),
            "a diagnostic without help: {diagnostics:?}"
        );
        Self { diagnostics }
    }

    /// Returns `Ok` if there are no diagnostics.
    ///
    /// # Errors
    /// All diagnostics.
    pub fn check(diagnostics: Vec<Diagnostic>) -> Result<(), Self> {
        if diagnostics.is_empty() { Ok(()) } else { Err(Self::of(diagnostics)) }
    }
}

impl From<Diagnostic> for InputError {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::of(vec![diagnostic])
    }
}

/// Largest number of diagnostics that a message shows. It only counts further ones, which are usually consequences of the first
/// ones.
const MAX_SHOWN_DIAGNOSTICS: usize = 8;

fn list_diagnostics(diagnostics: &[Diagnostic]) -> String {
    let mut lines: Vec<String> = diagnostics.iter().take(MAX_SHOWN_DIAGNOSTICS).map(ToString::to_string).collect();
    if diagnostics.len() > MAX_SHOWN_DIAGNOSTICS {
        lines.push(format!("... and {} more", diagnostics.len() - MAX_SHOWN_DIAGNOSTICS));
    }
    lines.join("\n")
}

/// Largest number of names in a list. Further ones are only counted, because nobody reads so many and each diagnostic may have a
/// list.
const MAX_LISTED_NAMES: usize = 64;

/// Lists names in quotes, separated by commas.
pub fn quoted<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let mut all = names.into_iter();
    let mut names: Vec<String> = all.by_ref().take(MAX_LISTED_NAMES).map(|n| format!("\"{}\"", n.as_ref())).collect();
    let more = all.count();
    if more > 0 {
        names.push(format!("... and {more} more"));
    }
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
