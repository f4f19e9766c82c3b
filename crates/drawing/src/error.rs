//! Why a file is no drawing.

/// Why a file is no drawing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Error {
    /// From 1, in formats that have lines.
    pub line: Option<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub cure: String,
}

impl Error {
    pub(crate) fn new(line: impl Into<Option<usize>>, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { line: line.into(), message: message.into(), cure: cure.into() }
    }
}
