//! Formats of result files, chosen by the extension of the file's name.

use std::path::Path;
use thiserror::Error;

/// A format of result files. Some formats need a feature of the crate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// The whole result, as JSON.
    Json,
    /// The trajectory as a table.
    Csv,
    /// The trajectory as a ROS 2 message.
    Yaml,
    /// The trajectory as a recording of ROS 2 topics.
    #[cfg(feature = "mcap")]
    Mcap,
}

/// The reason why a file name does not determine a format.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FormatError {
    /// The extension is unknown.
    #[error("the format of {file:?} is unknown: its name must end in .json, .csv, .yaml, .yml or .mcap")]
    Unknown {
        /// The name as given.
        file: String,
    },
    /// The format is MCAP, which this build of the program lacks.
    #[error("{file}: this program was built without MCAP; use .yaml, .csv or .json")]
    WithoutMcap {
        /// The name as given.
        file: String,
    },
}

impl Format {
    /// Returns the format for the extension of a file's name, in upper or lower case.
    ///
    /// # Errors
    /// [`FormatError::Unknown`] for any other extension, or none; [`FormatError::WithoutMcap`] for `.mcap` without the
    /// feature `mcap`.
    pub fn from_path(path: &Path) -> Result<Self, FormatError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let file = || path.to_string_lossy().into_owned();
        match extension.as_deref() {
            Some("json") => Ok(Self::Json),
            Some("csv") => Ok(Self::Csv),
            Some("yaml" | "yml") => Ok(Self::Yaml),
            #[cfg(feature = "mcap")]
            Some("mcap") => Ok(Self::Mcap),
            #[cfg(not(feature = "mcap"))]
            Some("mcap") => Err(FormatError::WithoutMcap { file: file() }),
            _ => Err(FormatError::Unknown { file: file() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_decides_the_format() {
        let format = |name: &str| Format::from_path(Path::new(name));
        assert_eq!(format("a/b.json"), Ok(Format::Json));
        assert_eq!(format("b.CSV"), Ok(Format::Csv));
        assert_eq!(format("b.yaml"), Ok(Format::Yaml));
        assert_eq!(format("b.tar.yml"), Ok(Format::Yaml));
        #[cfg(feature = "mcap")]
        assert_eq!(format("a/b.mcap"), Ok(Format::Mcap));
        #[cfg(not(feature = "mcap"))]
        {
            let refused = format("a/b.mcap").expect_err("not in this program");
            assert_eq!(refused.to_string(), "a/b.mcap: this program was built without MCAP; use .yaml, .csv or .json");
        }
        for name in ["b.txt", "json", ".csv", "b.", ""] {
            let message = format(name).expect_err("no format of ours").to_string();
            assert!(message.contains(name) && message.contains(".json, .csv, .yaml"), "{message}");
        }
    }
}
