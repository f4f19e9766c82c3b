//! The program, run in a folder of its own.

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A folder in which the program runs.
pub struct Folder(TempDir);

/// Exit code and standard output of a run.
pub struct Done {
    pub code: i32,
    pub stdout: String,
    /// The command, with everything that it printed, for messages.
    pub transcript: String,
}

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub fn write(&self, file: &str, text: &str) {
        std::fs::write(self.path(file), text).unwrap();
    }

    /// Returns the text of a file. `None` if there is no such file.
    pub fn read(&self, file: &str) -> Option<String> {
        std::fs::read_to_string(self.path(file)).ok()
    }

    /// Runs the program with the words of a command line.
    pub fn run(&self, command: &str) -> Done {
        let mut program = Command::new(env!("CARGO_BIN_EXE_cplan"));
        program.current_dir(self.0.path()).stdin(Stdio::null()).args(command.split_whitespace());
        let output = program.output().unwrap();
        let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        let code = output.status.code().expect("no signal");
        let transcript = format!("cplan {command}: {code}\n{stderr}{stdout}");
        Done { code, stdout, transcript }
    }
}

impl Done {
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.transcript))
    }
}
