//! Exit codes of `cplan-check`.

use cplan_check_files::{CheckError, check};

/// Checks a certificate, and returns the exit code.
pub fn code(urdf: &str, world: &str, certificate: &str) -> i32 {
    match check(urdf, world, certificate) {
        Ok(_) => 0,
        Err(CheckError::Fails(_)) => 3,
        Err(CheckError::Input { .. }) => 1,
    }
}
