//! Files of the repository.

use std::path::PathBuf;

/// Returns the path of a file of the repository.
pub fn shipped(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..").join(file)
}
