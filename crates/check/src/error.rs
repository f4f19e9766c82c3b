//! Why a certificate is not accepted.

use thiserror::Error;

/// One of the three files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// The robot.
    Urdf,
    /// Its surroundings, and what is asked.
    World,
    /// What is to be checked.
    Certificate,
}

/// Why a certificate is not accepted.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum CheckError {
    /// A file cannot be read, or says what the checker does not know.
    #[error("{message}")]
    Input {
        /// Which file.
        input: Input,
        /// The line, from 1, where that is known.
        line: Option<usize>,
        /// What is wrong, and what to do.
        message: String,
    },
    /// The certificate proves nothing: the part of it that fails.
    #[error("{0}")]
    Fails(String),
}

impl CheckError {
    /// Bad input, the byte `at` of the text.
    pub fn at(input: Input, text: &str, at: usize, message: impl Into<String>) -> Self {
        let line = text.as_bytes()[..at.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1;
        Self::Input { input, line: Some(line), message: message.into() }
    }

    /// Bad input as a whole.
    pub fn in_file(input: Input, message: impl Into<String>) -> Self {
        Self::Input { input, line: None, message: message.into() }
    }

    /// A part of the certificate that does not hold.
    ///
    /// # Errors
    /// Always.
    pub fn fails<T>(message: impl Into<String>) -> Result<T, Self> {
        Err(Self::Fails(message.into()))
    }
}
