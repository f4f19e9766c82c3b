//! The file of a robot: URDF, or xacro that is expanded to URDF.

use super::error::{Diagnostic, InputError};
use super::source::{Source, read_bounded};
use cplan_xacro::{Settings, expand, is_xacro};
use std::path::{Path, PathBuf};

/// The file of a robot, with arguments for its expansion.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct RobotFile {
    /// Path of a URDF or of xacro.
    pub path: PathBuf,
    /// Names and values of xacro arguments, which override the defaults in the file.
    pub xacro_args: Vec<(String, String)>,
}

impl From<&RobotFile> for RobotFile {
    fn from(file: &RobotFile) -> Self {
        file.clone()
    }
}

impl<P: AsRef<Path>> From<P> for RobotFile {
    fn from(path: P) -> Self {
        Self { path: path.as_ref().to_owned(), xacro_args: Vec::new() }
    }
}

impl RobotFile {
    /// Reads the file as URDF. If it is xacro, which its name or content shows, expands it. Positions in messages then
    /// refer to the xacro files.
    ///
    /// # Errors
    /// A file that cannot be read or expanded, and arguments for a file that is not xacro.
    pub fn read(&self) -> Result<Source, InputError> {
        let source = Source::read(&self.path)?;
        let is_named_so = self.path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xacro"));
        if !is_named_so && !is_xacro(source.text()) {
            return match self.xacro_args.first() {
                None => Ok(source),
                Some((name, _)) => {
                    let message = format!("this is a plain URDF, which has no argument \"{name}\"");
                    Err(source.diagnostic(message).help("leave --xacro-arg out").into())
                }
            };
        }
        let settings = Settings { arguments: self.xacro_args.clone(), read: read_bounded };
        match expand(&self.path, &settings) {
            Ok(expansion) => Ok(source.expanded(expansion)),
            Err(error) => Err(diagnostic(error).into()),
        }
    }
}

/// Converts the error to a diagnostic with its line.
fn diagnostic(error: cplan_xacro::Error) -> Diagnostic {
    let diagnostic = match error.place {
        None => Diagnostic::new(error.path.display().to_string(), error.message),
        Some(place) => {
            let (file, place) = *place;
            Source::in_memory(file.path, &*file.text).diagnostic_at(place.range, error.message)
        }
    };
    diagnostic.help(error.hint.unwrap_or_else(|| "correct it, or expand the file with ROS's own xacro".into()))
}
