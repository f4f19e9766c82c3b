//! Files of a plan.

use super::cspace::{CSpaceFormat, cspaces};
use super::picture::{PictureFormat, PictureFormatError, view, view_with_replay};
#[cfg(feature = "mcap")]
use super::stage::stage;
use crate::DrawError;
use cplan_engine::Plan;
use cplan_motion::{Format, FormatError, WriteError, write_whole};
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

/// Returns the plan as a file of this format. Returns `None` if the format contains only a trajectory or a grid, and
/// the plan has neither. All formats except MCAP, PNG and GIF are text in UTF-8.
///
/// # Errors
/// A picture that cannot be rendered.
pub fn bytes(plan: &Plan, format: FileFormat) -> Result<Option<Vec<u8>>, DrawError> {
    match format {
        #[cfg(feature = "mcap")]
        FileFormat::Result(Format::Mcap) => Ok(stage(plan).and_then(|stage| plan.recording(Some(&stage)))),
        FileFormat::Result(format) => Ok(plan.encoded(format)),
        FileFormat::CSpace(format) => Ok(format.text(&cspaces(plan)).map(String::into_bytes)),
        FileFormat::Picture(format) if format.is_animated() => format.bytes(&view_with_replay(plan)).map(Some),
        FileFormat::Picture(format) => format.bytes(&view(plan)).map(Some),
    }
}

/// Writes the plan into a file, completely or not at all. The extension determines the content, see
/// [`FileFormat::from_path`].
///
/// # Errors
/// An unknown extension, a missing trajectory or grid, a picture that cannot be made, and I/O errors.
pub fn save(plan: &Plan, path: &Path) -> Result<(), SaveError> {
    let format = FileFormat::from_path(path)?;
    let Some(contents) = bytes(plan, format)? else {
        let content = if let FileFormat::CSpace(_) = format { "grid" } else { "trajectory" };
        return Err(SaveError::Empty { file: path.display().to_string(), content });
    };
    Ok(write_whole(path, &contents)?)
}
