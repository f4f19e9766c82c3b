//! Writes the files of a result.

use super::failure::Failure;
use super::outputs::{Outputs, distinct, refuse_to_overwrite_inputs};
use super::program_args::ProgramArgs;
use super::sinks;
use crate::engine::Plan;
use crate::motion::{Format, check_writable, write_whole_set};
use crate::output::{CSpaceFormat, FileFormat, PlanOutput as _};
use serde_json::value::RawValue;
use std::path::{Path, PathBuf};

/// Least number of digits of a step's number in a file name. Zeros pad the numbers, so that names sort in the order of
/// the steps.
const MIN_STEP_DIGITS: usize = 3;

/// The content of a file that `cplan plan` writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlanContent {
    /// The result.
    Result(Format),
    /// The configuration space as data.
    CSpace(CSpaceFormat),
    /// A program for a controller.
    Program,
}

impl PlanContent {
    /// Returns the content of a file by its name.
    ///
    /// # Errors
    /// An extension of no known format, unless a template writes the file.
    pub fn of(path: &Path, program: &ProgramArgs) -> Result<Self, Failure> {
        match CSpaceFormat::from_path(path) {
            Some(format) => Ok(Self::CSpace(format)),
            None => {
                Format::from_path(path).map(Self::Result).or_else(|error| program.accept(error).map(|()| Self::Program))
            }
        }
    }
}

/// The result files that are requested.
pub struct ResultFiles {
    results: Vec<(Format, PathBuf)>,
    /// True if each step has its own file.
    per_step: bool,
    /// Number of steps of the task; 1 for a single motion.
    steps: usize,
}

impl ResultFiles {
    /// Creates the list of requested files. `steps` is the number of steps, and `inputs` are the files that were read.
    ///
    /// # Errors
    /// Files per step without a suitable format, and files that cannot be written.
    pub fn new(
        outputs: &Outputs<PlanContent>,
        inputs: &[PathBuf],
        per_step: bool,
        steps: usize,
    ) -> Result<Self, Failure> {
        let results = outputs.results.iter().filter_map(|(path, content)| match content {
            PlanContent::Result(format) => Some((*format, path.clone())),
            PlanContent::CSpace(_) | PlanContent::Program => None,
        });
        let files = Self { results: results.collect(), per_step, steps };
        let parted: Vec<&Path> =
            files.results.iter().filter(|(format, _)| files.parts(*format)).map(|(_, path)| path.as_path()).collect();
        if per_step && parted.is_empty() {
            let message = "--per-step needs an --output file for motions: .csv or .yaml";
            return Err(Failure::Usage(message.into()));
        }
        let parts: Vec<PathBuf> =
            parted.iter().flat_map(|path| (1..=steps).map(|number| files.part(path, number))).collect();
        parts.iter().try_for_each(|part| check_writable(part))?;
        let others = outputs.paths().filter(|path| !per_step || !parted.contains(path));
        distinct(others.chain(parts.iter().map(PathBuf::as_path)))?;
        refuse_to_overwrite_inputs(parts.iter().map(PathBuf::as_path), inputs)?;
        Ok(files)
    }

    /// Writes all files, or none if a problem can be foreseen. Warns on stderr about formats that cannot represent a result
    /// without a trajectory. A given certificate becomes a member of one of the files. Returns the names of the written files.
    ///
    /// # Errors
    /// I/O.
    pub fn write(&self, plan: &Plan, certificate: Option<(&Path, &RawValue)>) -> Result<Vec<String>, Failure> {
        let mut files = Vec::new();
        let mut names = Vec::new();
        for (format, path) in &self.results {
            let is_parted = self.parts(*format) && plan.trajectory().is_some();
            let parts = is_parted.then(|| plan.encoded_per_step(*format)).flatten();
            if let Some(parts) = parts {
                files.extend(parts.into_iter().zip(1..).map(|(bytes, number)| (self.part(path, number), bytes)));
                names.push(self.span(path));
                self.warn_of_more(path);
                continue;
            }
            let bytes = match certificate {
                Some((into, certificate)) if into == path => Some(plan.to_json_with(certificate).into_bytes()),
                _ => plan.bytes(FileFormat::Result(*format))?,
            };
            if let Some(bytes) = bytes {
                files.push((path.clone(), bytes));
                names.push(path.display().to_string());
            } else {
                sinks::warn_unwritten(path, "trajectory");
            }
        }
        write_whole_set(&files)?;
        Ok(names)
    }

    /// Returns true if each step has its own file in this format.
    fn parts(&self, format: Format) -> bool {
        self.per_step && matches!(format, Format::Csv | Format::Yaml)
    }

    /// Returns the path for a step, numbered from 1: `plan-001.yaml` for `plan.yaml`.
    fn part(&self, path: &Path, number: usize) -> PathBuf {
        let digits = self.steps.to_string().len().max(MIN_STEP_DIGITS);
        let mut name = path.file_stem().unwrap_or_default().to_os_string();
        name.push(format!("-{number:0digits$}"));
        if let Some(extension) = path.extension() {
            name.push(".");
            name.push(extension);
        }
        path.with_file_name(name)
    }

    /// Describes the files of all steps by the names of the first and the last one.
    fn span(&self, path: &Path) -> String {
        let first = self.part(path, 1).display().to_string();
        if self.steps == 1 { first } else { format!("{first} to {}", self.part(path, self.steps).display()) }
    }

    /// Warns about existing files with higher numbers. They come from an earlier, longer task, and could be mistaken
    /// for files of this one.
    fn warn_of_more(&self, path: &Path) {
        let next = self.part(path, self.steps + 1);
        if next.exists() {
            sinks::print_status(&format!(
                "warning: {} is left from an earlier task; there may be more such files",
                next.display()
            ));
        }
    }
}
