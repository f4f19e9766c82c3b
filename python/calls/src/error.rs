//! The reasons why a call of the package fails.

use cplan::cli::Failure;
use cplan::input::InputError;
use thiserror::Error;

/// The reason why a call failed, for one of Python's exceptions.
#[derive(Debug, Error)]
pub enum Refusal {
    /// Invalid files: `cplan.InputError`.
    #[error(transparent)]
    Input(#[from] InputError),
    /// An invalid argument: `ValueError`.
    #[error("{0}")]
    Value(String),
    /// An error of the operating system: `OSError`.
    #[error("{0}")]
    System(String),
}

impl Refusal {
    /// Returns an invalid argument with this reason.
    pub fn value(why: impl ToString) -> Self {
        Self::Value(why.to_string())
    }

    /// Returns an error of the operating system with this reason.
    pub fn system(why: impl ToString) -> Self {
        Self::System(why.to_string())
    }
}

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Input(error) => Self::Input(error),
            other => Self::value(other),
        }
    }
}
