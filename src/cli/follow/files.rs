//! The files that the answer is written to.

use super::{Answered, FollowArgs, certificate, json, picture};
use crate::cli::failure::Failure;
use crate::cli::sinks;
use crate::model::Outcome;
use crate::motion::{JointMotion, check_writable, csv, csv_of_joints, ros_yaml, write_whole_set};
use crate::output::PictureFormat;
use serde_json::Value;
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
    /// The file of the certificate, if it is requested.
    certificate: Option<PathBuf>,
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
        let certificate = args.certificate.clone();
        certificate.iter().try_for_each(|path| check_writable(path))?;
        let outputs = Self { results, certificate, pictures };
        sinks::distinct(outputs.paths())?;
        Ok(outputs)
    }

    /// Returns the names of all files.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let results = self.results.iter().map(|(path, _)| path.as_path());
        let certificate = self.certificate.iter().filter(|path| !self.is_member(path)).map(PathBuf::as_path);
        results.chain(certificate).chain(self.pictures.iter().map(|(path, _)| path.as_path()))
    }

    /// Returns true if the certificate in this file is a member of a result.
    fn is_member(&self, path: &Path) -> bool {
        self.results.iter().any(|(result, content)| result == path && *content == Content::Json)
    }

    /// Writes all files. Without a motion, warns about those that can only contain one.
    ///
    /// # Errors
    /// I/O, and pictures that cannot be drawn.
    pub fn write(&self, answered: &Answered) -> Result<(), Failure> {
        let mut files = Vec::new();
        let certificate = self.certificate.as_deref().and_then(|path| Some((path, certificate::text(answered, path)?)));
        if let Some((path, text)) = certificate.as_ref().filter(|(path, _)| !self.is_member(path)) {
            files.push((path.to_path_buf(), text.clone().into_bytes()));
        }
        for (path, content) in &self.results {
            let member = certificate.as_ref().filter(|(own, _)| own == path).map(|(_, text)| text.as_str());
            match text(answered, *content, member)? {
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

/// Returns the text of a file; `None` if it can only contain a motion and the answer has no motion. A certificate becomes
/// a member of JSON.
fn text(answered: &Answered, content: Content, certificate: Option<&str>) -> Result<Option<String>, Failure> {
    let trajectory = match answered.answer {
        Outcome::Found(found) => Some(&found.timed.trajectory),
        _ => None,
    };
    let loaded = answered.loaded;
    Ok(match content {
        Content::Json => {
            let mut object = json::object(answered);
            if let Some(certificate) = certificate.and_then(|text| serde_json::from_str::<Value>(text).ok()) {
                object["certificate"] = certificate;
            }
            Some(sinks::pretty(&object)?)
        }
        Content::Csv => {
            let joints = loaded.scene.arm().joints.each_ref().map(|joint| joint.name.clone());
            let table = trajectory.map(|trajectory| {
                let motors = loaded.scene.arm().motor_angles(&trajectory.position);
                match answered.wrist {
                    Some(wrist) => csv_of_joints(&wrist.motion(&joints, trajectory), &motors, None),
                    None => csv(&joints, trajectory, &motors, false, None),
                }
            });
            table.map(|table| with_tool(&table, &answered.tool))
        }
        Content::Yaml => {
            trajectory.map(|trajectory| ros_yaml(&JointMotion::new(&loaded.robot.joints, trajectory, false)))
        }
    })
}

/// Returns a table with a column for the tool: 1 on the line, 0 during travels. Without travels, the table stays the same.
fn with_tool(table: &str, tool: &[bool]) -> String {
    let values = tool.iter().map(|is_on| if *is_on { "1" } else { "0" });
    let column: Vec<&str> = ["tool"].into_iter().chain(values).collect();
    if tool.is_empty() {
        return table.to_owned();
    }
    table.lines().zip(column).map(|(line, value)| format!("{line},{value}\n")).collect()
}
