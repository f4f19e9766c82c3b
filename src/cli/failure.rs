//! What ends a job with exit code 1.

use crate::draw::DrawError;
use crate::input::InputError;
use crate::trajectory::{TimingError, WriteError};
use thiserror::Error;

/// Bad input or I/O, in the user's words.
#[derive(Debug, Error)]
pub enum Failure {
    /// One of the input files or an override.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The trajectory cannot be made as asked.
    #[error(transparent)]
    Trajectory(#[from] TimingError),
    /// An output file.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A picture.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// An option's value.
    #[error("{0}")]
    Option(String),
}
