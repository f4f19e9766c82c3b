//! Conversion of xacro robots to URDF.

use crate::input::{Conversion, Diagnostic, InputError, Origins, RobotFile, Source};
use cplan_robot::read_bounded;
use cplan_xacro::{Error, Expansion, Settings, expand, is_xacro};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Returns the file of a robot, which may be URDF or xacro. Functions that take the path of a URDF also take this instead.
pub fn robot(path: impl AsRef<Path>) -> RobotFile {
    RobotFile { conversion: Some(EXPANSION), ..RobotFile::from(path) }
}

/// Expands xacro, which the name or the content of the file shows.
const EXPANSION: Conversion = |source, arguments| {
    let is_named_so = source.path().extension().is_some_and(|e| e.eq_ignore_ascii_case("xacro"));
    (is_named_so || is_xacro(source.text())).then(|| expanded(source, arguments))
};

fn expanded(source: &Source, arguments: &[(String, String)]) -> Result<Source, InputError> {
    let settings = Settings { arguments: arguments.to_vec(), read: read_bounded };
    let mut expansion = expand(source.path(), &settings).map_err(diagnostic)?;
    let text = std::mem::take(&mut expansion.text);
    Ok(source.converted(text, Arc::new(Files(expansion))))
}

#[derive(Debug)]
struct Files(Expansion);

impl Origins for Files {
    fn files(&self) -> Vec<PathBuf> {
        self.0.files.iter().map(|file| &file.path).chain(&self.0.yaml).cloned().collect()
    }

    fn place(&self, offset: usize) -> Option<(Source, Range<usize>)> {
        let place = self.0.place(offset)?;
        let file = &self.0.files[place.file];
        Some((Source::in_memory(file.path.clone(), &*file.text), place.range.clone()))
    }
}

/// Converts the error to a diagnostic with its line.
fn diagnostic(Error { path, place, message, hint }: Error) -> Diagnostic {
    let diagnostic = match place {
        None => Diagnostic::new(path.display().to_string(), message),
        Some(place) => Source::in_memory(place.0.path, &*place.0.text).diagnostic_at(place.1.range, message),
    };
    diagnostic.help(hint.unwrap_or_else(|| "correct it, or expand the file with ROS's own xacro".into()))
}
