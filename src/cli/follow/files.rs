//! The files that the answer is written to.

use super::{Answered, FollowArgs, json, picture};
use crate::cli::failure::Failure;
use crate::cli::sinks;
use crate::model::Outcome;
use crate::motion::{JointMotion, check_writable, csv, ros_yaml, write_whole_set};
use crate::output::PictureFormat;
use std::path::{Path, PathBuf};

/// The contents of an output.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Content {
    Json,
    Csv,
    Yaml,
}

/// The outputs that are requested.
pub struct Outputs {
    results: Vec<(PathBuf, Content)>,
    pictures: Vec<(PathBuf, PictureFormat)>,
}

impl Outputs {
    /// Checks the names of the outputs before any work is done.
    ///
    /// # Errors
    /// Unknown extensions, outputs that are the same file, and files that cannot be written.
    pub fn new(args: &FollowArgs) -> Result<Self, Failure> {
        let ends = [("json", Content::Json), ("csv", Content::Csv), ("yaml", Content::Yaml), ("yml", Content::Yaml)];
        let expected = "the name of a motion must end in .json, .csv, .yaml or .yml";
        let results = sinks::outputs(&args.output, &ends, expected)?;
        let pictures = args.picture.iter().map(|path| match PictureFormat::from_path(path)? {
            format if format.is_animated() && format != PictureFormat::Html => {
                Err(Failure::Usage(format!("{}: a line is drawn as .svg, .png or .html", path.display())))
            }
            format => Ok((path.clone(), format)),
        });
        let pictures = pictures.collect::<Result<Vec<_>, Failure>>()?;
        pictures.iter().try_for_each(|(path, _)| check_writable(path))?;
        let outputs = Self { results, pictures };
        sinks::distinct(outputs.paths())?;
        Ok(outputs)
    }

    /// Returns the names of all files.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let results = self.results.iter().map(|(path, _)| path.as_path());
        results.chain(self.pictures.iter().map(|(path, _)| path.as_path()))
    }

    /// Writes all files. Without a motion, warns about those that can only contain one.
    ///
    /// # Errors
    /// I/O, and pictures that cannot be drawn.
    pub fn write(&self, answered: &Answered) -> Result<(), Failure> {
        let mut files = Vec::new();
        for (path, content) in &self.results {
            match text(answered, *content)? {
                Some(text) => files.push((path.clone(), text.into_bytes())),
                None => sinks::warn_unwritten(path, "trajectory"),
            }
        }
        if !self.pictures.is_empty() {
            let view = answered.args.theme.apply(picture::view(answered));
            for (path, format) in &self.pictures {
                files.push((path.clone(), format.bytes(&view)?));
            }
        }
        Ok(write_whole_set(&files)?)
    }
}

/// Returns the text of a file; `None` if it can only contain a motion and the answer has no motion.
fn text(answered: &Answered, content: Content) -> Result<Option<String>, Failure> {
    let trajectory = match answered.answer {
        Outcome::Found(found) => Some(&found.timed.trajectory),
        _ => None,
    };
    let loaded = answered.loaded;
    Ok(match content {
        Content::Json => Some(sinks::pretty(&json::object(answered))?),
        Content::Csv => {
            let joints = loaded.scene.arm().joints.each_ref().map(|joint| joint.name.clone());
            trajectory.map(|trajectory| csv(&joints, trajectory, false, None))
        }
        Content::Yaml => {
            trajectory.map(|trajectory| ros_yaml(&JointMotion::new(&loaded.robot.joints, trajectory, false)))
        }
    })
}
