//! Failures that end a command before its result. Their exit code is 1, or 2 for a wrong command line.

use super::exit::{BAD_INPUT, USAGE};
use crate::engine::PlanError;
use crate::input::{Diagnostic, InputError};
use crate::motion::{FormatError, TimingError, WriteError};
use crate::output::PictureFormatError;
use crate::view::DrawError;
use cplan_programs::ProgramError;
use thiserror::Error;

/// A failure, described for the user.
#[derive(Debug, Error)]
pub enum Failure {
    /// A defect of an input file or an override.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A blocked start or goal, with a hint for an explanation.
    #[error("{0}\n  hint: {1}")]
    Blocked(InputError, String),
    /// Planning with the options is refused.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The trajectory cannot be made with the options.
    #[error(transparent)]
    Trajectory(#[from] TimingError),
    /// An output file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The rows of a study cannot be stored.
    #[cfg(feature = "study")]
    #[error(transparent)]
    Journal(#[from] crate::study::JournalError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A file, folder, address or stream that is not available, with the reason.
    #[error("{0}")]
    Io(String),
    /// A request that cannot be fulfilled, with the reason.
    #[error("{0}")]
    Refused(String),
    /// A defect of the input that is part of a JSON report on stdout.
    #[error(transparent)]
    Reported(InputError),
    /// A wrong command line.
    #[error("{0}")]
    Usage(String),
}

impl Failure {
    /// Returns true if the failure is already part of the report on stdout.
    pub fn is_reported(&self) -> bool {
        matches!(self, Self::Reported(_))
    }

    /// Returns the failure with a hint to `cplan cell`, if another command was given a cell.
    #[must_use]
    pub fn with_command_for_cells(self) -> Self {
        let is_cell = |found: &Diagnostic| {
            let line = found.excerpt.as_deref().unwrap_or_default();
            found.message.starts_with("unknown key `arm`") && line.contains("[[arm]]")
        };
        match self {
            Self::Input(error) => match error.diagnostics() {
                [found] if is_cell(found) => {
                    let hint = format!("this is a cell with two arms, for `cplan cell {}`", found.origin);
                    Self::Input(found.clone().help(hint).into())
                }
                _ => Self::Input(error),
            },
            other => other,
        }
    }

    /// Returns the exit code of the process.
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Self::Usage(_) | Self::Plan(PlanError::Options(_))) { USAGE } else { BAD_INPUT }
    }
}

impl From<ProgramError> for Failure {
    fn from(error: ProgramError) -> Self {
        match error {
            ProgramError::Template(error) => Self::Input(error),
            _ => Self::Refused(error.to_string()),
        }
    }
}

impl From<FormatError> for Failure {
    fn from(error: FormatError) -> Self {
        match error {
            FormatError::Unknown { .. } => Self::Usage(error.to_string()),
            FormatError::WithoutMcap { .. } => Self::Refused(error.to_string()),
        }
    }
}

impl From<PictureFormatError> for Failure {
    fn from(error: PictureFormatError) -> Self {
        match error {
            PictureFormatError::Unknown { .. } => Self::Usage(error.to_string()),
            PictureFormatError::WithoutPng { .. } => Self::Refused(error.to_string()),
        }
    }
}
