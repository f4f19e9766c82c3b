//! `cplan verify`: recorded motions against closed forms, dense sampling and tampering.

mod all_joints;
mod bad_input;
mod claims;
mod command;
mod controller;
mod corners;
mod dialects;
mod files;
mod held_joints;
mod limits;
mod motion;
mod recordings;
mod plan_distance;
mod tasks;
mod tool_values;

use crate::cli::{Done, Place, has};
use cplan::input::InputError;
use cplan_testkit::judged::{Question, judge, plan_result};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Returns the path of a file of the repository.
fn root(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file)
}

fn shipped(robot: &str, world: &str) -> [PathBuf; 2] {
    [root(&format!("robots/{robot}.urdf")), root(&format!("workspaces/{world}.toml"))]
}

/// Judges a file with this name and content.
fn judged(
    [robot, world]: &[PathBuf; 2],
    name: &str,
    content: impl AsRef<[u8]>,
    question: &Question,
) -> Result<Value, InputError> {
    let place = Place::new().with(name, content);
    judge(robot, world, &place.path(name), question)
}

/// Returns the findings about a file with this name and content.
#[track_caller]
fn findings(files: &[PathBuf; 2], name: &str, content: impl AsRef<[u8]>) -> Value {
    judged(files, name, content, &Question::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs `verify` on a table for a shipped robot and world.
fn verify_table(place: &Place, [robot, world]: [&str; 2], table: &str, options: &str) -> Done {
    place.write("m.csv", table);
    let [robot, world] = shipped(robot, world).map(|file| file.display().to_string());
    place.run(&["verify", &robot, &world, "m.csv"], options)
}
