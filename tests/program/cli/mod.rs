//! The program from outside: arguments, streams, files and exit codes.

mod batch;
mod certificates;
mod certified_lines;
mod certified_motions;
mod certified_movers;
mod certified_robots;
mod certified_tasks;
mod commands;
mod compare;
mod controller_languages;
mod converge;
mod cspace;
mod demo_and_init;
mod diagnostics;
mod drives;
mod error_json;
mod exact;
mod explain;
mod explore;
mod fields;
mod figures;
mod follow;
mod followed_pages;
mod wrist_lines;
mod free_joint;
mod gcode;
mod grids;
pub mod help;
mod implausible_robots;
mod import;
mod inputs;
mod large_turns;
mod lines_in_toml;
mod many_corners;
mod mazes;
mod moving;
mod narrow;
mod numbers;
mod outputs;
mod own_body;
mod path_kind;
mod polygons;
mod placed_heights;
mod pressing_depth;
mod programs;
mod proof_sizes;
mod reach;
mod results;
mod supports;
mod tolerant_reading;
#[cfg(feature = "study")]
mod study;
mod tasks;
mod terminal;
mod torques;
mod xacro;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// Returns the path of a file of the repository.
fn shipped(file: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file).display().to_string()
}

fn shelf() -> [String; 2] {
    [shipped("robots/planar_2r.urdf"), shipped("workspaces/shelf.toml")]
}

/// Start and goal in free space for `planar_2r`.
const FREE: &str = "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n";

/// A folder in which the program runs.
pub struct Place(TempDir);

/// Result of a run.
pub struct Done {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub fn write(&self, file: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(file), content).unwrap();
    }

    pub fn read(&self, file: &str) -> String {
        std::fs::read_to_string(self.path(file)).unwrap()
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cplan"));
        command.current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    pub fn run<S: AsRef<str>>(&self, files: &[S], options: &str) -> Done {
        let mut command = self.command();
        command.args(files.iter().map(AsRef::as_ref)).args(options.split_whitespace());
        let Output { status, stdout, stderr } = command.output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Done { code: status.code().expect("no signal"), stdout: text(stdout), stderr: text(stderr) }
    }

    /// Plans for `planar_2r` in the given world.
    fn plan(&self, world: impl AsRef<[u8]>, options: &str) -> Done {
        self.write("world.toml", world);
        self.run(&[shipped("robots/planar_2r.urdf"), "world.toml".into()], options)
    }
}

impl Done {
    /// Checks that a command is refused: the exit code, an empty stdout, and a message that has all `parts`.
    fn refused(&self, code: i32, parts: &[&str]) {
        assert_eq!((self.code, self.stdout.as_str()), (code, ""), "{}", self.stderr);
        assert!(self.stderr.starts_with("error: ") && !self.stderr.contains("panicked"), "{}", self.stderr);
        assert_eq!(self.stderr.matches("error: ").count(), 1, "{}", self.stderr);
        for part in parts {
            assert!(self.stderr.contains(part), "{part:?} is not in: {}", self.stderr);
        }
    }

    fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).expect("one JSON document and nothing else")
    }
}
