//! Files that the URDF and the world refer to.

use super::{Files, digest};
use cplan_check::{CheckError, Input};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Maximum size of a file, bytes.
const MAX_FILE_BYTES: u64 = 256 << 20;

impl Files {
    /// Returns the path of the URDF or the world. Names of other files are relative to this path.
    ///
    /// # Errors
    /// If only the text was given, without a path.
    pub fn path(&self, input: Input) -> Result<&Path, CheckError> {
        let path = self.given[usize::from(input == Input::World)].as_deref();
        path.ok_or_else(|| {
            CheckError::in_file(
                input,
                "this text names other files: call `check_files` with the paths of URDF and world",
            )
        })
    }

    /// Reads a file that the URDF or the world refers to.
    ///
    /// # Errors
    /// If the file cannot be read, is larger than 256 MiB, or is not the file to which the certificate belongs.
    pub fn bytes(&self, input: Input, path: &Path) -> Result<Vec<u8>, CheckError> {
        if !path.is_file() {
            return Err(CheckError::in_file(
                input,
                format!("{} cannot be read: there is no such file", path.display()),
            ));
        }
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes));
        let name = path.display();
        read.map_err(|error| CheckError::in_file(input, format!("{name} cannot be read: {error}")))?;
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(CheckError::in_file(input, format!("{name} is larger than {} MiB", MAX_FILE_BYTES >> 20)));
        }
        let is_said = |stated: &Vec<String>| stated.iter().any(|stated| stated.eq_ignore_ascii_case(&digest(&bytes)));
        match self.others.as_ref().is_none_or(is_said) {
            true => Ok(bytes),
            false => CheckError::fails(format!(
                "the certificate is about another {name}: \"others\" does not contain the SHA-256 of this file"
            )),
        }
    }
}
