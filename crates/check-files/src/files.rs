//! The files that a certificate is about: the URDF, the world, and those that they name.

use cplan_check::CheckError;
use cplan_check::certificate::Certificate;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::PathBuf;

mod named;

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
}
