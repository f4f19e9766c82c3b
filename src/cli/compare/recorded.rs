//! Paths of other planners, from files. Each planner has a folder, with a file for each problem. The paths are judged
//! as by `cplan verify`.

use super::cases::Case;
use crate::cli::failure::Failure;
use crate::compare::{Family, Row};
use crate::engine::findings::{Judgement, MotionFindings, verify};
use crate::input::{InputError, Overrides, load_recording};
use crate::model::Status;
use crate::space::{Path, Recording};
use std::path::{Path as FilePath, PathBuf};

/// Extensions of files with paths, in the order of the search.
const EXTENSIONS: [&str; 3] = ["csv", "json", "yaml"];

/// The paths of another planner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedPlanner {
    /// Name of the planner in tables: that of its folder.
    pub label: String,
    folder: PathBuf,
}

/// Returns the planners whose folders are in a folder, in the order of their names.
///
/// # Errors
/// A folder that cannot be read, or without folders.
pub fn planners_in(place: &FilePath) -> Result<Vec<RecordedPlanner>, Failure> {
    let refused = |message: String| {
        let cure = "give it one folder for each planner, with one file for each problem, such as mine/shelf.csv";
        Failure::Io(format!("--paths {}: {message}\n  hint: {cure}", place.display()))
    };
    let entries = std::fs::read_dir(place).map_err(|error| refused(format!("cannot be read: {error}")))?;
    let folders = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_dir());
    let name = |folder: &FilePath| folder.file_name().map(|name| name.to_string_lossy().into_owned());
    let planner = |folder: PathBuf| Some(RecordedPlanner { label: name(&folder)?, folder });
    let mut planners: Vec<RecordedPlanner> = folders.filter_map(planner).collect();
    planners.sort_by(|a, b| a.label.cmp(&b.label));
    if planners.is_empty() {
        return Err(refused("it has no folder".into()));
    }
    Ok(planners)
}

/// Returns the name of the files for a problem, without extension. Characters other than letters, digits and `.-_`
/// become `_`. For a problem without a name, it is `problem`.
pub fn file_stem(problem: &str) -> String {
    let is_kept = |c: char| c.is_alphanumeric() || ".-_".contains(c);
    let stem: String = problem.chars().map(|c| if is_kept(c) { c } else { '_' }).collect();
    if stem.is_empty() { "problem".into() } else { stem }
}

impl RecordedPlanner {
    /// Judges the planner's path for a problem. Returns its row, and the path if it is accepted.
    pub fn judged(&self, case: &Case, overrides: &Overrides) -> (Row, Option<Path>) {
        let row = Row::new(self.label.clone(), Family::Other, Status::Unknown);
        let unknown = |reason: String| (Row { reason: Some(reason), ..row.clone() }, None);
        let files = EXTENSIONS.map(|extension| self.folder.join(format!("{}.{extension}", case.file)));
        let Some(file) = files.iter().find(|file| file.exists()) else {
            return unknown(format!("there is no file {} (or .json, .yaml)", files[0].display()));
        };
        match judged_file(file, case, overrides) {
            Err(error) => unknown(error.to_string().lines().next().unwrap_or_default().to_owned()),
            Ok((recording, findings)) if findings.verdict == Judgement::Free => {
                let path = recording.outline();
                let row = Row {
                    outcome: Status::Found,
                    length: Some(path.length()),
                    pieces: Some(path.segments().count()),
                    clearance: findings.collisions.clearance,
                    duration: findings.duration,
                    ..row
                };
                (row, Some(path))
            }
            Ok((_, findings)) => unknown(refusal(&findings)),
        }
    }
}

fn judged_file(file: &FilePath, case: &Case, overrides: &Overrides) -> Result<(Recording, MotionFindings), InputError> {
    let loaded = (*case.scene).clone().with_margins(overrides.clearance, overrides.calibration)?;
    let overrides = match case.query {
        None => overrides.clone(),
        Some([start, goal]) => Overrides { start: Some(start.into()), goal: Some(goal.into()), ..Overrides::default() },
    };
    let recorded = load_recording(file, &loaded)?;
    let findings = verify(&loaded, &recorded, &overrides, false)?;
    Ok((recorded.recording, findings))
}

/// Describes why a path is not accepted.
fn refusal(findings: &MotionFindings) -> String {
    let collisions = &findings.collisions;
    let place = collisions.first_contact.as_ref().or(collisions.undecided.as_ref());
    let at = place.map(|place| format!(": {}", place.pair)).unwrap_or_default();
    let faults = findings.faults.first().map(|fault| format!(": {fault}")).unwrap_or_default();
    match findings.verdict {
        Judgement::Collision => format!("the path collides{at}"),
        Judgement::Undecided => format!("the path is neither proven free nor proven to collide{at}{faults}"),
        Judgement::Limits => "the motion breaks limits of the joints".into(),
        Judgement::Ends => format!("the path does not lead from the start to the goal{faults}"),
        verdict => format!("{}{faults}", verdict.word()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_problems_become_names_of_files() {
        assert_eq!(file_stem("shelf_of_2-1"), "shelf_of_2-1");
        assert_eq!(file_stem("arm 2/no way: x.y"), "arm_2_no_way__x.y");
        assert_eq!(file_stem(""), "problem");
    }
}
