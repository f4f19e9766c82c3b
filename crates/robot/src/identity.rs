//! Which files were read, so that none of them is overwritten.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// What tells a file from others, however its path is spelt and whichever links lead to it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileIdentity {
    /// Absolute, without links.
    path: PathBuf,
    /// Device and number of the file, where the system has them: hard links share these.
    number: Option<(u64, u64)>,
}

impl FileIdentity {
    /// That of a file, which need not exist if its folder does. None of what is no place for a file.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        if let Ok(path) = fs::canonicalize(path) {
            let number = fs::metadata(&path).ok().and_then(|found| number(&found));
            return Some(Self { path, number });
        }
        // What is written goes behind a link, also to a file that is not there yet.
        let target = fs::read_link(path).map(|target| path.with_file_name(target));
        let path = target.as_deref().unwrap_or(path);
        let folder = match path.parent() {
            Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
            Some(folder) => folder,
            None => return None,
        };
        Some(Self { path: fs::canonicalize(folder).ok()?.join(path.file_name()?), number: None })
    }

    /// Whether both are one file.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
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

/// Every input of this process so far: named on the command line, or by another input.
static READ: Mutex<Vec<(PathBuf, FileIdentity)>> = Mutex::new(Vec::new());

/// Takes note of a file that is read.
pub(crate) fn note_read(path: &Path) {
    let Some(identity) = FileIdentity::of(path) else { return };
    let mut read = READ.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if read.iter().all(|(_, known)| !known.is(&identity)) {
        read.push((path.to_owned(), identity));
    }
}

/// The input that this process has read from the same file, by whichever path.
#[must_use]
pub fn read_from(path: &Path) -> Option<PathBuf> {
    let identity = FileIdentity::of(path)?;
    let read = READ.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    read.iter().find(|(_, known)| known.is(&identity)).map(|(path, _)| path.clone())
}

/// The paths of all inputs that this process has read.
#[must_use]
pub fn files_read() -> Vec<PathBuf> {
    let read = READ.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    read.iter().map(|(path, _)| path.clone()).collect()
}
