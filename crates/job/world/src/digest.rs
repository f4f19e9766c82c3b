//! Digests of the files that a problem was read from.

use cplan_robot::{FileIdentity, InputError, RobotFile, read_bytes};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// SHA-256 of each file, in hexadecimal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Digests {
    /// Digest of the URDF. For xacro, it is the digest of the URDF that `cplan inspect --expanded` prints.
    pub urdf: String,
    /// Digest of the world file.
    pub world: String,
    /// Digests of all other files that URDF and world refer to, in ascending order.
    pub others: Vec<String>,
}

impl Digests {
    /// Returns the digests of a URDF, of a world file and of all other `files`. `files` must list every file that was read: see
    /// [`LoadedScene::files`](super::LoadedScene::files).
    ///
    /// # Errors
    /// A file that can no longer be read.
    pub fn of(robot: &RobotFile, world: &Path, files: &[PathBuf]) -> Result<Self, InputError> {
        let given: Vec<FileIdentity> = [&robot.path, world].into_iter().filter_map(FileIdentity::of).collect();
        let mut known = given;
        let mut others = Vec::new();
        for path in files {
            let Some(identity) = FileIdentity::of(path) else { continue };
            if known.iter().all(|one| !one.is_same_file(&identity)) {
                known.push(identity);
                others.push(digest(path)?);
            }
        }
        others.sort();
        let expanded = robot.read()?;
        let urdf = match expanded.is_converted() {
            true => digest_of(expanded.text().as_bytes()),
            false => digest(&robot.path)?,
        };
        Ok(Self { urdf, world: digest(world)?, others })
    }
}

/// Returns the SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// A file that cannot be read.
pub fn digest(path: &Path) -> Result<String, InputError> {
    Ok(digest_of(&read_bytes(path)?))
}

fn digest_of(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
