//! Errors in files, with their places.

use crate::document::{File, Place};
use std::fmt;
use std::path::PathBuf;

/// Reason why a file cannot be expanded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// Path of the file with the error.
    pub path: PathBuf,
    /// The file and the place of the error. `None` if it has no place.
    pub place: Option<Box<(File, Place)>>,
    /// Description of the error.
    pub message: String,
    /// Hint for the user.
    pub hint: Option<String>,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some((file, place)) = self.place.as_deref() {
            write!(f, ":{}", file.line(place.range.start))?;
        }
        write!(f, ": {}", self.message)?;
        self.hint.as_ref().map_or(Ok(()), |hint| write!(f, "; {hint}"))
    }
}

impl std::error::Error for Error {}

/// An error in an expression or a substitution, before its place is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Fault {
    /// The text itself is wrong. Contains the message and a hint.
    Here(String, Option<String>),
    /// The error is in another place: in a property that is evaluated only when this text uses it.
    Elsewhere(Box<Error>),
}

impl Fault {
    /// Creates a fault with a hint.
    pub fn with_hint(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Here(message.into(), Some(hint.into()))
    }
}

impl From<String> for Fault {
    fn from(message: String) -> Self {
        Self::Here(message, None)
    }
}

impl From<&str> for Fault {
    fn from(message: &str) -> Self {
        message.to_owned().into()
    }
}
