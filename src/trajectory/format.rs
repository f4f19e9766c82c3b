//! Which file extension means what.

use super::{Report, csv, ros_yaml};
use std::path::Path;
use thiserror::Error;

/// A format of result files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// The whole report.
    Json,
    /// The trajectory as a table.
    Csv,
    /// The trajectory as a ROS 2 message.
    Yaml,
}

/// A file name whose extension is none of ours.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("cannot tell the format of {file:?}: its name must end in .json, .csv, .yaml or .yml")]
pub struct UnknownFormat {
    /// The name as given.
    pub file: String,
}

impl Format {
    /// The format that a file's extension stands for; upper and lower case are the same.
    ///
    /// # Errors
    /// [`UnknownFormat`] for any other extension, or none.
    pub fn from_path(path: &Path) -> Result<Self, UnknownFormat> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("json") => Ok(Self::Json),
            Some("csv") => Ok(Self::Csv),
            Some("yaml" | "yml") => Ok(Self::Yaml),
            _ => Err(UnknownFormat { file: path.to_string_lossy().into_owned() }),
        }
    }

    /// The report's text in this format; none if the format holds nothing but a trajectory and there is none.
    #[must_use]
    pub fn text(self, report: &Report) -> Option<String> {
        match self {
            Self::Json => Some(report.json()),
            Self::Csv => Some(csv(&report.joints, report.trajectory.as_ref()?)),
            Self::Yaml => Some(ros_yaml(&report.joints, report.trajectory.as_ref()?)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extension_decides() {
        let format = |name: &str| Format::from_path(Path::new(name));
        assert_eq!(format("a/b.json"), Ok(Format::Json));
        assert_eq!(format("b.CSV"), Ok(Format::Csv));
        assert_eq!(format("b.yaml"), Ok(Format::Yaml));
        assert_eq!(format("b.tar.yml"), Ok(Format::Yaml));
        for name in ["b.txt", "json", ".csv", "b.", ""] {
            let message = format(name).expect_err("no format of ours").to_string();
            assert!(message.contains(name) && message.contains(".json, .csv, .yaml"), "{message}");
        }
    }
}
