//! Line maps, preference files and occupancy maps: read, converted to metres, and used for planning.

mod lines;
mod mutations;
mod occupancy;
mod pictures;
mod published;
mod rectangles;

use cplan::input::{InputError, LoadedProblem, Overrides, World, load, load_scene};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Creates a folder with these files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

fn robot() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("robots/room_gantry.urdf")
}

/// Reads the world `world.toml` of a folder, with the gantry that spans a room.
fn world_in(folder: &TempDir) -> Result<World, InputError> {
    load_scene(robot(), &folder.path().join("world.toml")).map(|loaded| loaded.world)
}

/// Reads the problem of `world.toml`.
fn problem_in(folder: &TempDir) -> Result<LoadedProblem, InputError> {
    load(robot(), &folder.path().join("world.toml"), &Overrides::default())
}

/// Checks that the error contains all of these parts.
fn assert_refused<T>(result: Result<T, InputError>, parts: &[&str]) {
    let Err(error) = result else { panic!("should be refused for {parts:?}") };
    let error = error.to_string();
    for part in parts {
        assert!(error.contains(part), "no \"{part}\" in:\n{error}");
    }
}
