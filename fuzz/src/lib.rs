//! Files for the fuzz targets: a folder for inputs that the library takes as files, and files of the repository.

use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder that lasts as long as the process.
pub struct Files(TempDir);

impl Files {
    /// Creates an empty folder.
    pub fn empty() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    /// Writes a file and returns its path.
    pub fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).expect("a file in a temporary folder");
        path
    }
}

/// Returns the path of a file of the repository.
pub fn shipped(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file)
}
