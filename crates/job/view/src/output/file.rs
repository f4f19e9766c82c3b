//! Files of a plan.

use super::cspace::CSpaceFormat;
use super::picture::{PictureFormat, PictureFormatError};
use crate::DrawError;
use cplan_motion::{Format, FormatError, WriteError};
use std::path::Path;
use thiserror::Error;

/// The content of a plan's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// The result, or the motion alone.
    Result(Format),
    /// The configuration space as data.
    CSpace(CSpaceFormat),
    /// A picture, or a page.
    Picture(PictureFormat),
}

/// The reason why a file is not written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The extension is not that of a picture format of this program.
    #[error(transparent)]
    Picture(#[from] PictureFormatError),
    /// The extension is not that of any format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The picture cannot be made.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The plan has no trajectory or grid, and the format contains nothing else.
    #[error("{file} is not written: the result has no {content}")]
    Empty {
        /// The name as given.
        file: String,
        /// Content of the format.
        content: &'static str,
    },
}

impl FileFormat {
    /// Returns the format of a file's extension: `.json`, `.csv`, `.yaml`, `.mcap`, `.svg`, `.png`, `.gif`, `.html` or
    /// `.geojson`. Some names, such as `cspace.json`, mean the configuration space: see [`CSpaceFormat::from_path`].
    ///
    /// # Errors
    /// Any other extension, and those that this build of the program does not support.
    pub fn from_path(path: &Path) -> Result<Self, SaveError> {
        if let Some(format) = CSpaceFormat::from_path(path) {
            return Ok(Self::CSpace(format));
        }
        match PictureFormat::from_path(path) {
            Ok(format) => Ok(Self::Picture(format)),
            Err(error @ PictureFormatError::WithoutPng { .. }) => Err(error.into()),
            Err(PictureFormatError::Unknown { .. }) => Ok(Self::Result(Format::from_path(path)?)),
        }
    }
}
