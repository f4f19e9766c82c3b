//! The reason why a file cannot be read as a line.

/// The reason why a file cannot be read as a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Error {
    /// Line number from 1, if a line is to blame.
    pub line: Option<usize>,
    /// Column from 1, in characters, if a word is to blame.
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
