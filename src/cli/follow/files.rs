//! The files of an answer.

use super::{Answered, FollowArgs, certificate, json, picture};
use crate::cli::failure::Failure;
use crate::cli::outputs::{Outputs, by_extension, drawn};
use crate::cli::sinks;
use crate::model::Outcome;
use crate::motion::{JointMotion, csv, csv_of_joints, ros_yaml};
use serde_json::Value;
use std::path::Path;

/// The contents of an output.
#[derive(Clone, Copy)]
pub enum Content {
    Json,
    Csv,
    Yaml,
}

/// Checks the names of the outputs before any computation.
///
/// # Errors
/// Unknown extensions, outputs that are the same file, and files that cannot be written.
pub fn outputs(args: &FollowArgs) -> Result<Outputs<Content>, Failure> {
    let ends = [("json", Content::Json), ("csv", Content::Csv), ("yaml", Content::Yaml), ("yml", Content::Yaml)];
    let content = by_extension(&ends, "the name of a motion must end in .json, .csv, .yaml or .yml");
    let certificate = args.certificate.clone().filter(|path| !is_member(args, path));
    Outputs::new(&args.output, content, &args.picture, certificate)?.without_animation("a line")
}

/// Returns true if the certificate with this file name is a member of a result.
fn is_member(args: &FollowArgs, path: &Path) -> bool {
    let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    is_json && args.output.iter().any(|result| result == path)
}

/// Writes all files. Without a motion, warns about files that can only contain a motion.
///
/// # Errors
/// I/O, and pictures that cannot be drawn.
pub fn write(outputs: &Outputs<Content>, answered: &Answered) -> Result<(), Failure> {
    let args = answered.args;
    let certificate = args.certificate.as_deref().and_then(|path| Some((path, certificate::text(answered, path)?)));
    let own = certificate.iter().filter(|(path, _)| !is_member(args, path));
    let own = own.map(|(path, text)| (path.to_path_buf(), text.clone().into_bytes())).collect();
    let result = |path: &Path, content| {
        let member = certificate.as_ref().filter(|(own, _)| *own == path).map(|(_, text)| text.as_str());
        let text = text(answered, content, member)?;
        if text.is_none() {
            sinks::warn_unwritten(path, "trajectory");
        }
        Ok(text.map(String::into_bytes))
    };
    outputs.write(own, result, drawn(|| args.theme.apply(picture::view(answered))))
}

/// Returns the text of a file. `None` if it can only contain a motion and there is none. In JSON, a certificate becomes
/// a member.
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

/// Returns a table with an additional column for the tool: 1 on the line, 0 during travels. Without travels, the table
/// is unchanged.
fn with_tool(table: &str, tool: &[bool]) -> String {
    let values = tool.iter().map(|is_on| if *is_on { "1" } else { "0" });
    let column: Vec<&str> = ["tool"].into_iter().chain(values).collect();
    if tool.is_empty() {
        return table.to_owned();
    }
    table.lines().zip(column).map(|(line, value)| format!("{line},{value}\n")).collect()
}
