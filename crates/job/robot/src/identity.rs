//! Identities of files, so that no output overwrites an input.

use std::fs;
use std::path::{Path, PathBuf};

/// Identity of a file. It depends neither on links nor on the spelling of the path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileIdentity {
    /// Absolute path, without links.
    path: PathBuf,
    /// Device and inode number, if the system has them. All hard links to a file share them.
    number: Option<(u64, u64)>,
}

impl FileIdentity {
    /// Returns the identity of a file. The file need not exist, but its folder must. Returns `None` if the path cannot
    /// be a file.
    pub fn of(path: &Path) -> Option<Self> {
        if let Ok(path) = fs::canonicalize(path) {
            let number = fs::metadata(&path).ok().and_then(|found| number(&found));
            return Some(Self { path, number });
        }
        // Writing follows a link even if its target does not exist yet.
        let target = fs::read_link(path).map(|target| path.with_file_name(target));
        let path = target.as_deref().unwrap_or(path);
        let folder = match path.parent() {
            Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
            Some(folder) => folder,
            None => return None,
        };
        Some(Self { path: fs::canonicalize(folder).ok()?.join(path.file_name()?), number: None })
    }

    /// Returns true if both are the same file.
    pub fn is_same_file(&self, other: &Self) -> bool {
        self.path == other.path || (self.number.is_some() && self.number == other.number)
    }
}

#[cfg(unix)]
fn number(found: &fs::Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn number(_: &fs::Metadata) -> Option<(u64, u64)> {
    None
}
