//! Digests of the files that a problem was read from.

use cplan_robot::{FileIdentity, InputError, RobotFile, files_read, read_bytes};
use sha2::{Digest, Sha256};
use std::path::Path;

/// SHA-256 of files, in hex.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Digests {
    /// The URDF; of xacro the one that it expands to, as `cplan inspect --expanded` writes it.
    pub urdf: String,
    /// The world file.
    pub world: String,
    /// All other files that were read because these refer to them, in ascending order.
    pub others: Vec<String>,
}

impl Digests {
    /// Returns the digests of a URDF, a world, and all other files that this process has read so far.
    ///
    /// # Errors
    /// A file that can no longer be read.
    pub fn of(robot: &RobotFile, world: &Path) -> Result<Self, InputError> {
        let given: Vec<FileIdentity> = [&robot.path, world].into_iter().filter_map(FileIdentity::of).collect();
        let is_other =
            |path: &Path| FileIdentity::of(path).is_some_and(|other| !given.iter().any(|one| one.is(&other)));
        let others = files_read().into_iter().filter(|path| is_other(path)).map(|path| digest(&path));
        let mut others: Vec<String> = others.collect::<Result<_, _>>()?;
        others.sort();
        let expanded = robot.read()?;
        let urdf = match expanded.is_expanded() {
            true => digest_of(expanded.text().as_bytes()),
            false => digest(&robot.path)?,
        };
        Ok(Self { urdf, world: digest(world)?, others })
    }
}

fn digest(path: &Path) -> Result<String, InputError> {
    Ok(digest_of(&read_bytes(path)?))
}

fn digest_of(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
