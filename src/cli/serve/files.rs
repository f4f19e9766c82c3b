//! Results and pictures as files, for a page to save.

use super::options::Options;
use super::result::Found;
use crate::cli::output::{self, PictureFormat};
use crate::cli::{task, task_summary};
use crate::engine::task::{Manner, TaskReport};
use crate::input::{LoadedScene, Overrides};
use crate::motion::{Format, Report};
use std::path::Path;

/// What a file holds, by the extension of its name.
enum Kind {
    Result(Format),
    Picture(PictureFormat),
}

/// The file's content.
///
/// # Errors
/// In words: a format that is none of ours, bad input, a result without what the format is for.
pub fn content(loaded: LoadedScene, options: &Options, format: &str) -> Result<Vec<u8>, String> {
    let name = format!("plan.{format}");
    let name = Path::new(&name);
    let kind = match output::picture_format(name) {
        Ok(picture) => Kind::Picture(picture),
        Err(_) => Kind::Result(Format::from_path(name).map_err(|error| error.to_string())?),
    };
    let effort = options.effort(&loaded.scene)?;
    let in_words = |error: &dyn ToString| error.to_string();
    let nothing = || "there is no trajectory to put into it".to_owned();
    if loaded.has_steps() {
        let mut loaded = loaded.task(&Overrides::default()).map_err(|error| in_words(&error))?;
        options.override_limits(&mut loaded.task.arm.joints);
        let manner = Manner { method: options.method(), effort, drive: options.drive() };
        let answer = crate::engine::task::plan(&loaded.task, &manner, &mut |_| ());
        let mut report = TaskReport::new(options.method().name(), &loaded.task, &answer);
        report.assumed = loaded.robot.assumed.clone();
        let named = report.name_joints(&loaded.robot.joints, &loaded.task, &answer, false);
        named.map_err(|error| in_words(&error))?;
        return match kind {
            Kind::Result(format) => report.bytes(format).ok_or_else(nothing),
            Kind::Picture(format) => {
                let facts = || task_summary::facts(&loaded.task, &answer, &report);
                let picture = task::picture(&loaded, &answer, &report);
                output::drawn_task(format, &picture, facts).map_err(|error| in_words(&error))
            }
        };
    }
    let mut loaded = loaded.problem(&Overrides::default()).map_err(|error| in_words(&error))?;
    options.override_limits(loaded.problem.joints_mut());
    let found = Found::in_full(&loaded.problem, options, &effort);
    let planned = found.planned()?;
    match kind {
        Kind::Result(format) => {
            let mut report: Report = planned.report.clone();
            report.robot = loaded.robot.joints.clone();
            report.assumed = loaded.robot.assumed.clone();
            format.bytes(&report).ok_or_else(nothing)
        }
        Kind::Picture(format) => planned.bytes(format).map_err(|error| in_words(&error)),
    }
}
