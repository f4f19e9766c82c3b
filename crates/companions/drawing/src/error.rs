//! The reason why a file cannot be read as a drawing.

/// The reason why a file cannot be read as a drawing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Error {
    /// Line number from 1, in formats that have lines.
    pub line: Option<usize>,
    /// Description of the defect.
    pub message: String,
    /// Hint for the correction of the file.
    pub cure: String,
}

impl Error {
    pub(crate) fn new(line: impl Into<Option<usize>>, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { line: line.into(), message: message.into(), cure: cure.into() }
    }
}
