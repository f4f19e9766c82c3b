//! The program from outside: arguments, streams, files and exit codes.

mod batch;
mod calibration;
mod cell;
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
#[cfg(feature = "serve")]
mod course;
mod cspace;
mod demo_and_init;
mod diagnostics;
mod drives;
mod elbow;
mod error_json;
mod exact;
mod explain;
mod explore;
mod fields;
mod figures;
mod fit;
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
mod slips;
mod supports;
mod tolerant_reading;
#[cfg(feature = "study")]
mod study;
mod tasks;
mod terminal;
mod torques;
mod xacro;

use cplan_check_files::{CheckError, check, check_files};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// Returns the path of a file of the repository.
pub fn shipped(file: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file).display().to_string()
}

fn read(path: impl AsRef<Path>) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// Returns the paths of `planar_2r` and of a shipped world.
fn files(world: &str) -> [String; 2] {
    [robot(), shipped(&format!("workspaces/{world}.toml"))]
}

fn robot() -> String {
    shipped("robots/planar_2r.urdf")
}

fn shelf() -> [String; 2] {
    files("shelf")
}

fn maze() -> [String; 2] {
    [shipped("robots/gantry.urdf"), shipped("workspaces/gantry_maze.toml")]
}

/// Returns the URDF of `planar_2r` with changes.
#[track_caller]
fn planar_2r(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(read(shipped("robots/planar_2r.urdf")), |urdf, (from, to)| {
        assert!(urdf.contains(from), "{from}");
        urdf.replace(from, to)
    })
}

/// Start and goal in free space for `planar_2r`.
const FREE: &str = "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n";

/// Returns the position of the tip of `planar_2r`.
fn tip([a, b]: [f64; 2]) -> [f64; 2] {
    [a.cos() + 0.8 * (a + b).cos(), a.sin() + 0.8 * (a + b).sin()]
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

/// A folder in which the program runs.
pub struct Place(TempDir);

/// Result of a run.
pub struct Done {
    /// The arguments of the program.
    words: String,
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// Returns the folder with another file in it.
    pub fn with(self, file: &str, content: impl AsRef<[u8]>) -> Self {
        self.write(file, content);
        self
    }

    pub fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub fn write(&self, file: &str, content: impl AsRef<[u8]>) {
        let path = self.path(file);
        std::fs::create_dir_all(path.parent().expect("a file in a folder")).unwrap();
        std::fs::write(path, content).unwrap();
    }

    pub fn read(&self, file: &str) -> String {
        std::fs::read_to_string(self.path(file)).unwrap()
    }

    /// Reads a JSON file.
    pub fn json(&self, file: &str) -> Value {
        serde_json::from_str(&self.read(file)).unwrap()
    }

    /// Reads a table of numbers, without its header.
    pub fn table(&self, file: &str) -> Vec<Vec<f64>> {
        let row = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
        self.read(file).lines().skip(1).map(row).collect()
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cplan"));
        command.current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    pub fn run<S: AsRef<str>>(&self, files: &[S], options: &str) -> Done {
        let words: Vec<&str> = files.iter().map(AsRef::as_ref).chain(options.split_whitespace()).collect();
        let Output { status, stdout, stderr } = self.command().args(&words).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let code = status.code().expect("no signal");
        Done { words: words.join(" "), code, stdout: text(stdout), stderr: text(stderr) }
    }

    /// Plans for a robot in the given world.
    pub fn run_in(&self, robot: &str, world: impl AsRef<[u8]>, options: &str) -> Done {
        self.write("world.toml", world);
        self.run(&[robot, "world.toml"], options)
    }

    /// Plans for `planar_2r` in the given world.
    pub fn plan(&self, world: impl AsRef<[u8]>, options: &str) -> Done {
        self.run_in(&shipped("robots/planar_2r.urdf"), world, options)
    }

    /// Plans with a certificate. Checks the exit code, and that the checker accepts the certificate. Returns its report, too.
    #[track_caller]
    fn certified(&self, robot: &str, world: &str, options: &str, code: i32) -> (Done, String) {
        let done = self.run(&[robot, world], &format!("--certificate c.json {options}")).exits(code);
        let judged = self.judged([robot, world, "c.json"]);
        (done, judged.unwrap_or_else(|why| panic!("{robot} {world} {options}: {why}")))
    }

    /// Returns the checker's verdict on a robot, a world and a certificate: files here, or shipped ones.
    pub fn judged(&self, files: [&str; 3]) -> Result<String, CheckError> {
        let [urdf, world, certificate] = files.map(|file| self.path(file));
        check_files(&urdf, &world, &certificate)
    }
}

impl Done {
    /// Checks the exit code.
    #[track_caller]
    pub fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, code, "cplan {}\n{}{}", self.words, self.stdout, self.stderr);
        self
    }

    /// Checks that the program succeeded and reported nothing on stderr.
    #[track_caller]
    pub fn succeeds_silently(self) -> Self {
        assert_eq!((self.code, &*self.stderr), (0, ""), "cplan {}\n{}", self.words, self.stdout);
        self
    }

    /// Checks that stdout has all `parts`.
    #[track_caller]
    pub fn says(&self, parts: &[&str]) -> &Self {
        has(&self.stdout, parts);
        self
    }

    /// Checks that stderr has all `parts`.
    #[track_caller]
    pub fn warns(&self, parts: &[&str]) -> &Self {
        has(&self.stderr, parts);
        self
    }

    /// Checks that a command is refused: the exit code, an empty stdout, and a message that has all `parts`.
    #[track_caller]
    pub fn refused(&self, code: i32, parts: &[&str]) {
        assert_eq!((self.code, self.stdout.as_str()), (code, ""), "{}", self.stderr);
        assert!(self.stderr.starts_with("error: ") && !self.stderr.contains("panicked"), "{}", self.stderr);
        assert_eq!(self.stderr.matches("error: ").count(), 1, "{}", self.stderr);
        has(&self.stderr, parts);
    }

    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).expect("one JSON document and nothing else")
    }
}

/// Checks that a text has all `parts`.
#[track_caller]
pub fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
}
