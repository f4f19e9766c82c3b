//! The reason why a file cannot be read as a line.

/// The reason why a file cannot be read as a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Error {
    /// Number of the line with the defect, from 1. `None` if no single line is to blame.
    pub line: Option<usize>,
    /// Column of the word with the defect, from 1, in characters. `None` if no single word is to blame.
    pub column: Option<usize>,
    /// Description of the defect.
    pub message: String,
    /// Hint how to correct the file.
    pub hint: String,
}

impl Error {
    /// Creates an error about a place of the file, or about the whole file.
    pub fn new(
        line: impl Into<Option<usize>>,
        column: impl Into<Option<usize>>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self { line: line.into(), column: column.into(), message: message.into(), hint: hint.into() }
    }
}
