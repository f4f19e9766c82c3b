//! Command-line options for programs of robot controllers.

use super::failure::Failure;
use super::files::Files;
use super::headings::OUTPUT;
use crate::engine::{Plan, Problem};
use crate::input::{Diagnostic, Digests, InputError, LoadedScene, Overrides};
use crate::model::Status;
use crate::motion::FormatError;
use crate::text::length_up;
use clap::{Args, ValueHint};
use cplan_programs::{JointTolerance, Program, Template};
use std::path::{Path, PathBuf};

/// Options for programs.
#[derive(Debug, PartialEq, Args)]
#[command(next_help_heading = OUTPUT)]
pub struct ProgramArgs {
    /// With --output NAME.EXT: write a program for a controller by this template. The program consists of joint moves
    /// that stop at each target; it is certified as written. FILE can also be the name of a shipped template: epson
    /// (SPEL+), rapid (ABB) or list (a table). EXT can be any extension without another meaning, such as .prg.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub template: Option<String>,
    /// Deviation from straight lines in joint space that the certificate of the program allows: an angle, a length for
    /// sliding joints, or both [default: 0.05deg,0.05mm].
    #[arg(long, value_name = "TOLERANCE", requires = "template", allow_hyphen_values = true)]
    pub joint_tolerance: Option<JointTolerance>,
}

/// A template that writes the program of a plan.
pub struct ProgramWriter {
    pub template: Template,
    pub tolerance: JointTolerance,
    /// The clearance of the program, metres.
    pub clearance: f64,
    /// The additional clearance of the plan, metres.
    room: f64,
}

/// The text of a program, and a line about it for the summary.
pub struct WrittenProgram {
    /// The text. `None` if the plan has no motion.
    pub text: Option<String>,
    pub summary: String,
}

impl ProgramArgs {
    /// Returns the content of a file with an unknown extension.
    ///
    /// # Errors
    /// The error about the format, unless a template writes the file.
    pub fn accept(&self, error: FormatError) -> Result<(), Failure> {
        match (&error, &self.template) {
            (FormatError::Unknown { .. }, Some(_)) => Ok(()),
            (FormatError::Unknown { .. }, None) => {
                let hint = "to write a program for a controller, add --template; other extensions are then allowed";
                Err(Failure::Usage(format!("{error}\n  hint: {hint}")))
            }
            _ => Err(error.into()),
        }
    }

    /// Reads the template. `None` if no program is requested. `has_file` is true if a file is for a program. `blend` is the
    /// requested radius for corners.
    ///
    /// # Errors
    /// A template without an output file, corners that must be rounded, and a defect of the template.
    pub fn writer(&self, has_file: bool, blend: f64) -> Result<Option<ProgramWriter>, Failure> {
        let Some(name) = &self.template else { return Ok(None) };
        if !has_file {
            let message =
                "--template needs an --output file with the extension of the program, such as --output program.prg";
            return Err(Failure::Usage(message.into()));
        }
        if blend > 0.0 && blend.is_finite() {
            let message = "--template writes joint moves that stop at each corner of the path: leave out --blend";
            return Err(Failure::Usage(message.into()));
        }
        let tolerance = self.joint_tolerance.unwrap_or_default();
        Ok(Some(ProgramWriter { template: Template::load(name)?, tolerance, clearance: 0.0, room: 0.0 }))
    }
}

impl ProgramWriter {
    /// Returns the files that were read for the template.
    pub fn files(&self) -> Vec<PathBuf> {
        self.template.files()
    }

    /// Returns the problem for a program: the arm rests during strokes and turns, and the clearance includes the
    /// tolerance. Also sets the clearance of the overrides.
    ///
    /// # Errors
    /// The errors of [`Problem::of_scene`], with a hint if only the larger clearance causes them, and a problem that
    /// cannot have a program.
    pub fn problem(&mut self, loaded: LoadedScene, asked: &mut Overrides) -> Result<Problem, Failure> {
        let loaded = loaded.without_arches();
        let exact = Problem::of_scene(loaded.clone(), asked)?;
        Program::check(&exact)?;
        let (clearance, room) = (exact.scene().workspace().clearance, self.tolerance.room(&exact));
        asked.clearance = Some(clearance + room);
        self.widened(clearance, room, |_| Problem::of_scene(loaded, asked))
    }

    /// Returns the result of `load` with the clearance of the program plus `room`, metres.
    ///
    /// # Errors
    /// The errors of `load`, with a hint for those that only the larger clearance causes.
    pub fn widened<T>(
        &mut self,
        clearance: f64,
        room: f64,
        load: impl FnOnce(f64) -> Result<T, InputError>,
    ) -> Result<T, Failure> {
        (self.clearance, self.room) = (clearance, room);
        load(clearance + room).map_err(|error| {
            let hint = format!("{}; use a smaller --joint-tolerance", self.describe_room());
            let hinted = |found: &Diagnostic| found.clone().help(hint.clone());
            let hinted = InputError::check(error.diagnostics().iter().map(hinted).collect());
            Failure::Input(hinted.err().unwrap_or(error))
        })
    }

    /// Describes the additional clearance for the tolerance.
    fn describe_room(&self) -> String {
        format!("the program's joint tolerance of {} adds {} to the clearance", self.tolerance, length_up(self.room))
    }

    /// Returns the program of a plan. `given` are the input files and their digests.
    ///
    /// # Errors
    /// A plan without a program, a defect of the template, and a program that is not certified as written.
    pub fn write(&self, plan: &Plan, given: Option<(&Files, &Digests)>) -> Result<WrittenProgram, Failure> {
        if plan.status() != Status::Found {
            return Ok(WrittenProgram { text: None, summary: format!("not written; {}", self.describe_room()) });
        }
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let digests = given.map(|(files, digests)| {
            vec![[name(&files.urdf), digests.urdf.clone()], [name(&files.world), digests.world.clone()]]
        });
        let program = Program::of(plan, self.tolerance, self.clearance)?.with_digests(digests.unwrap_or_default());
        Ok(WrittenProgram { text: Some(self.template.write(&program)?.text), summary: program.summary() })
    }
}
