//! The files that a certificate is about: the URDF, the world, and those that they name.

use crate::certificate::Certificate;
use crate::error::{CheckError, Input};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Bytes of the largest file that is read.
const LARGEST: u64 = 256 << 20;

/// Where the files are that the URDF and the world name.
pub struct Files {
    /// The URDF and the world; none if they are texts.
    given: [Option<PathBuf>; 2],
    /// Digests of the others, if the certificate has them.
    others: Option<Vec<String>>,
}

/// The SHA-256 of some bytes, in hex.
fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

impl Files {
    /// Those of a certificate that is about the URDF and the world, whose texts these are.
    ///
    /// # Errors
    /// If it has digests, and they are those of others.
    pub fn new(
        certificate: &Certificate,
        [urdf, world]: [&str; 2],
        given: [Option<PathBuf>; 2],
    ) -> Result<Self, CheckError> {
        for (what, text, said) in [("URDF", urdf, &certificate.urdf), ("world", world, &certificate.world)] {
            if let Some(said) = said.as_ref().filter(|said| !said.eq_ignore_ascii_case(&digest(text.as_bytes()))) {
                return CheckError::fails(format!("it is about another {what}: one whose SHA-256 is {said}"));
            }
        }
        Ok(Self { given, others: certificate.others.clone() })
    }

    /// The path of one of the two, beside which others lie.
    ///
    /// # Errors
    /// If it is a text.
    pub fn path(&self, of: Input) -> Result<&Path, CheckError> {
        let path = self.given[usize::from(of == Input::World)].as_deref();
        path.ok_or_else(|| CheckError::in_file(of, "it names other files, which only check_files looks for"))
    }

    /// The content of a file that one of the two names.
    ///
    /// # Errors
    /// What cannot be read, is larger than 256 MiB, or is another than the certificate is about.
    pub fn bytes(&self, of: Input, path: &Path) -> Result<Vec<u8>, CheckError> {
        if !path.is_file() {
            return Err(CheckError::in_file(of, format!("{} cannot be read: there is no such file", path.display())));
        }
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes));
        let name = path.display();
        read.map_err(|error| CheckError::in_file(of, format!("{name} cannot be read: {error}")))?;
        if bytes.len() as u64 > LARGEST {
            return Err(CheckError::in_file(of, format!("{name} is larger than {} MiB", LARGEST >> 20)));
        }
        let is_said = |said: &Vec<String>| said.iter().any(|said| said.eq_ignore_ascii_case(&digest(&bytes)));
        match self.others.as_ref().is_none_or(is_said) {
            true => Ok(bytes),
            false => CheckError::fails(format!("it is about another {name}: none of \"others\" is its SHA-256")),
        }
    }
}
