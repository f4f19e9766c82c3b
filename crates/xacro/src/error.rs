//! What is wrong with a file, and where.

use crate::document::{File, Place};
use std::fmt;
use std::path::PathBuf;

/// Why a file is not expanded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// The file that is wrong.
    pub path: PathBuf,
    /// Its text and the bytes that are wrong, if it is that part.
    pub place: Option<Box<(File, Place)>>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
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

/// What is wrong with an expression or a substitution, before its place is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Wrong where it stands: the message, and what to do.
    Here(String, Option<String>),
    /// Wrong in another place: a property whose value is only computed here.
    Elsewhere(Box<Error>),
}

impl Fault {
    /// A fault with advice.
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
