//! Failures that end a job before its result: exit code 1, or 2 for a wrong command line.

use super::exit::{BAD_INPUT, USAGE};
use crate::draw::DrawError;
use crate::engine::PlanError;
use crate::input::InputError;
use crate::motion::{FormatError, TimingError, WriteError};
use crate::output::PictureFormatError;
use thiserror::Error;

/// Bad input or I/O, in the user's words.
#[derive(Debug, Error)]
pub enum Failure {
    /// A defect in one of the input files or an override.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A blocked start or goal, with a hint.
    #[error("{0}\n  hint: {1}")]
    Blocked(InputError, String),
    /// The options make no plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The options make no trajectory.
    #[error(transparent)]
    Trajectory(#[from] TimingError),
    /// An output file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Rows of a study cannot be stored.
    #[cfg(feature = "study")]
    #[error(transparent)]
    Journal(#[from] crate::study::JournalError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The effect of an option is impossible.
    #[error("{0}")]
    Option(String),
    /// Bad input that a report in JSON contains already.
    #[error(transparent)]
    Reported(InputError),
    /// A wrong command line.
    #[error("{0}")]
    Usage(String),
}

impl Failure {
    /// Returns true if the failure is already on stdout.
    pub fn is_reported(&self) -> bool {
        matches!(self, Self::Reported(_))
    }

    /// Returns the process's exit code.
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Self::Usage(_) | Self::Plan(PlanError::Options(_))) { USAGE } else { BAD_INPUT }
    }
}

impl From<FormatError> for Failure {
    fn from(error: FormatError) -> Self {
        match error {
            FormatError::Unknown { .. } => Self::Usage(error.to_string()),
            FormatError::WithoutMcap { .. } => Self::Option(error.to_string()),
        }
    }
}

impl From<PictureFormatError> for Failure {
    fn from(error: PictureFormatError) -> Self {
        match error {
            PictureFormatError::Unknown { .. } => Self::Usage(error.to_string()),
            PictureFormatError::WithoutPng { .. } => Self::Option(error.to_string()),
        }
    }
}
