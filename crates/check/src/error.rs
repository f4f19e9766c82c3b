//! Errors: the reasons why a certificate is not accepted.

use thiserror::Error;

/// One of the three files that the checker reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// The robot's URDF or xacro file.
    Urdf,
    /// The world file, with the robot's surroundings and the query.
    World,
    /// The certificate to check.
    Certificate,
}

/// The reason why a certificate is not accepted.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum CheckError {
    /// A file cannot be read, or contains something that the checker does not know.
    #[error("{message}")]
    Input {
        /// The file with the error.
        input: Input,
        /// Line number, from 1; `None` if unknown.
        line: Option<usize>,
        /// Description of the problem, and what to do about it.
        message: String,
    },
    /// The certificate does not prove its answer. The message names the part that fails.
    #[error("{0}")]
    Fails(String),
}

impl CheckError {
    /// Returns an error for input that is wrong at byte `at` of the text.
    pub fn at(input: Input, text: &str, at: usize, message: impl Into<String>) -> Self {
        let line = text.as_bytes()[..at.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1;
        Self::Input { input, line: Some(line), message: message.into() }
    }

    /// Makes an error for a file as a whole.
    pub fn in_file(input: Input, message: impl Into<String>) -> Self {
        Self::Input { input, line: None, message: message.into() }
    }

    /// Returns an error for a part of the certificate that does not hold.
    ///
    /// # Errors
    /// Always.
    pub fn fails<T>(message: impl Into<String>) -> Result<T, Self> {
        Err(Self::Fails(message.into()))
    }
}
