//! The file of a robot: URDF, or a file in another language that is converted to URDF.

use super::error::InputError;
use super::source::Source;
use std::path::{Path, PathBuf};

/// Converts a robot's text and its arguments from another language to URDF. Returns `None` if the text is already URDF.
pub type Conversion = fn(&Source, &[(String, String)]) -> Option<Result<Source, InputError>>;

/// The file of a robot, with arguments for its conversion.
#[derive(Debug, Clone)]
pub struct RobotFile {
    /// Path of the file.
    pub path: PathBuf,
    /// Names and values of arguments, which override the defaults in the file.
    pub arguments: Vec<(String, String)>,
    /// The conversion of files that are not URDF. Without it, they are refused.
    pub conversion: Option<Conversion>,
}

impl From<&RobotFile> for RobotFile {
    fn from(file: &RobotFile) -> Self {
        file.clone()
    }
}

impl<P: AsRef<Path>> From<P> for RobotFile {
    fn from(path: P) -> Self {
        Self { path: path.as_ref().to_owned(), arguments: Vec::new(), conversion: None }
    }
}

impl RobotFile {
    /// Reads the file as URDF, and converts it if necessary. Positions in messages refer to the original files.
    ///
    /// # Errors
    /// A file that cannot be read or converted, and arguments for a file that is not converted.
    pub fn read(&self) -> Result<Source, InputError> {
        let source = Source::read(&self.path)?;
        let converted = self.conversion.and_then(|convert| convert(&source, &self.arguments));
        match (converted, self.arguments.first()) {
            (Some(converted), _) => converted,
            (None, None) => Ok(source),
            (None, Some((name, _))) => {
                let message = format!("this is a plain URDF, not xacro, so it has no argument \"{name}\"");
                Err(source.diagnostic(message).help("leave --xacro-arg out").into())
            }
        }
    }
}
