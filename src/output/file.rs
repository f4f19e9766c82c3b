//! Files of a plan.

use super::cspace::CSpaceFormat;
use super::picture::{PictureFormat, PictureFormatError};
use crate::draw::DrawError;
use crate::engine::Plan;
use crate::motion::{Format, FormatError, WriteError, write_whole};
use std::path::Path;
use thiserror::Error;

/// What a file of a plan holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// The result, or the motion alone.
    Result(Format),
    /// The configuration space as data.
    CSpace(CSpaceFormat),
    /// A picture, or a page.
    Picture(PictureFormat),
}

/// Why a file is not written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The extension is that of no picture that this program can draw.
    #[error(transparent)]
    Picture(#[from] PictureFormatError),
    /// The extension tells no format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The picture cannot be made.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The format holds nothing but a trajectory, or a grid, and there is none.
    #[error("{file} is not written: there is no {content} to put into it")]
    Empty {
        /// The name as given.
        file: String,
        /// What the format holds.
        content: &'static str,
    },
}

impl FileFormat {
    /// The format that a file's extension stands for: `.json`, `.csv`, `.yaml`, `.mcap`, `.svg`, `.png`, `.gif`, `.html` or `.geojson`; but
    /// `cspace.json`, `cspace.csv` and what ends in `.cspace.json` or `.cspace.csv` is the configuration space.
    ///
    /// # Errors
    /// Any other extension, and those that this build of the program does not have.
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

impl Plan {
    /// The plan as a file of this format holds it; none if the format holds nothing but a trajectory, or a grid, and there is none. All but
    /// MCAP, PNG and GIF are text in UTF-8.
    ///
    /// # Errors
    /// A picture that cannot be made of pixels.
    pub fn bytes(&self, format: FileFormat) -> Result<Option<Vec<u8>>, DrawError> {
        match format {
            #[cfg(feature = "mcap")]
            FileFormat::Result(Format::Mcap) => {
                Ok(self.stage().and_then(|stage| self.report().recording(Some(&stage))))
            }
            FileFormat::Result(format) => Ok(self.report().bytes(format)),
            FileFormat::CSpace(format) => Ok(format.text(&self.cspaces()).map(String::into_bytes)),
            FileFormat::Picture(format) if format.plays() => format.bytes(&self.view_with_replay()).map(Some),
            FileFormat::Picture(format) => format.bytes(&self.view()).map(Some),
        }
    }

    /// Writes the plan into a file, whole or not at all; the extension says what it holds, see [`FileFormat::from_path`].
    ///
    /// # Errors
    /// An extension that is none of ours, a trajectory that is not there, a picture that cannot be made, I/O.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let format = FileFormat::from_path(path)?;
        let Some(bytes) = self.bytes(format)? else {
            let content = if let FileFormat::CSpace(_) = format { "grid" } else { "trajectory" };
            return Err(SaveError::Empty { file: path.display().to_string(), content });
        };
        Ok(write_whole(path, &bytes)?)
    }
}
