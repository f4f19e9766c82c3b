//! The files that belong to a certificate: the URDF, the world, and the files to which these refer.

use cplan_check::CheckError;
use cplan_check::certificate::Certificate;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::PathBuf;

mod named;

/// Access to the files to which the URDF and the world refer.
pub struct Files {
    /// Paths of the URDF and the world; `None` if they were given as texts.
    given: [Option<PathBuf>; 2],
    /// Digests of the other files, in hex; `None` if the certificate does not list them.
    others: Option<Vec<String>>,
}

/// Returns the SHA-256 of some bytes, in hex.
fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

impl Files {
    /// Prepares access to the files. Checks that the certificate belongs to these texts of the URDF and the world.
    ///
    /// # Errors
    /// If the certificate has digests that do not match the texts.
    pub fn new(
        certificate: &Certificate,
        [urdf, world]: [&str; 2],
        given: [Option<PathBuf>; 2],
    ) -> Result<Self, CheckError> {
        for (what, text, stated) in [("URDF", urdf, &certificate.urdf), ("world", world, &certificate.world)] {
            if let Some(stated) =
                stated.as_ref().filter(|stated| !stated.eq_ignore_ascii_case(&digest(text.as_bytes())))
            {
                return CheckError::fails(format!(
                    "the certificate is about another {what}, with the SHA-256 {stated}"
                ));
            }
        }
        Ok(Self { given, others: certificate.others.clone() })
    }
}
