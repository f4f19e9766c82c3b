//! Files that are written completely or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reason why a file could not be written. No file has changed.
#[derive(Debug, Error)]
pub enum WriteError {
    /// A folder, device, pipe or the like has that name.
    #[error("cannot write {}: it exists and is not a file", path.display())]
    NotAFile {
        /// The file as given.
        path: PathBuf,
    },
    /// The folder does not exist.
    #[error("cannot write {}: the folder {} does not exist; create it first", path.display(), folder.display())]
    NoFolder {
        /// The file as given.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// The operating system refused. Only the kind is shown, because the full error names a temporary file that is
    /// already gone.
    #[error("cannot write {}: {}", path.display(), source.kind())]
    Refused {
        /// The file as given.
        path: PathBuf,
        /// The operating system's reason.
        source: io::Error,
    },
}

/// Writes `bytes` to a temporary file in the folder of `path`, and renames it in one step. At any moment, the file has either its
/// old or its new content, even if the program is killed. (After a loss of power at that moment, this depends on the file
/// system.)
///
/// An existing file keeps its permissions; a new one gets those of the user's umask. If `path` is a symbolic link, the file
/// behind it is replaced.
///
/// # Errors
/// [`WriteError`]; nothing is left behind.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    TemporaryFile::new(path, bytes)?.move_into_place()
}

/// Writes several files like [`write_whole`]. All temporary files are written before the first one is renamed, so lack of space
/// or permissions is detected while all files are unchanged. If the system refuses to rename one of them, earlier files have
/// their new content, and the others are unchanged.
///
/// # Errors
/// [`WriteError`] for the first file that fails; no temporary file is left behind.
pub fn write_whole_set<B: AsRef<[u8]>>(files: &[(PathBuf, B)]) -> Result<(), WriteError> {
    let prepared = files.iter().map(|(path, bytes)| TemporaryFile::new(path, bytes.as_ref()));
    prepared.collect::<Result<Vec<_>, _>>()?.into_iter().try_for_each(TemporaryFile::move_into_place)
}

/// A temporary file with the new content; removed unless it is renamed.
struct TemporaryFile {
    /// The path of the file to write, as given.
    path: PathBuf,
    target: PathBuf,
    /// The temporary file, closed, so that the limit on open files does not limit the number of files.
    temporary: tempfile::TempPath,
}

impl TemporaryFile {
    fn new(path: &Path, bytes: &[u8]) -> Result<Self, WriteError> {
        let refused = |source: io::Error| WriteError::Refused { path: path.to_owned(), source };
        let Target { file: target, folder, kept } = target(path)?;
        let mut file = new_temporary(&folder).map_err(refused)?;
        file.write_all(bytes).map_err(refused)?;
        // WASI has no permissions.
        if let Some(permissions) = kept.filter(|_| !cfg!(target_os = "wasi")) {
            file.as_file().set_permissions(permissions).map_err(refused)?;
        }
        Ok(Self { path: path.to_owned(), target, temporary: file.into_temp_path() })
    }

    /// Renames the temporary file to the file's name.
    fn move_into_place(self) -> Result<(), WriteError> {
        let refused = |e: tempfile::PathPersistError| WriteError::Refused { path: self.path, source: e.error };
        self.temporary.persist(&self.target).map_err(refused)
    }
}

/// Checks, as far as possible without writing it, whether a file of that name could be written. Called before long computations,
/// whose result might otherwise be lost.
///
/// # Errors
/// [`WriteError`].
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let Target { folder, .. } = target(path)?;
    // The temporary file is removed at once, so its name is visible only briefly.
    new_temporary(&folder).map(drop).map_err(|source| WriteError::Refused { path: path.to_owned(), source })
}

/// The place of a file to write.
struct Target {
    /// The file itself, at the end of symbolic links.
    file: PathBuf,
    folder: PathBuf,
    /// Permissions of the existing file. `None` if there is no such file.
    kept: Option<fs::Permissions>,
}

fn target(path: &Path) -> Result<Target, WriteError> {
    let refused = |source: io::Error| WriteError::Refused { path: path.to_owned(), source };
    let target = match (path.is_symlink(), fs::canonicalize(path)) {
        (false, _) => path.to_owned(),
        // The target of the link does not exist yet.
        (true, Err(error)) if error.kind() == io::ErrorKind::NotFound => {
            path.with_file_name(fs::read_link(path).map_err(refused)?)
        }
        (true, found) => found.map_err(refused)?,
    };
    let kept = match fs::metadata(&target) {
        Ok(found) if found.is_file() => Some(found.permissions()),
        Ok(_) => return Err(WriteError::NotAFile { path: path.to_owned() }),
        Err(_) => None,
    };
    let folder = match target.parent() {
        Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
        Some(folder) => folder,
        None => return Err(WriteError::NotAFile { path: path.to_owned() }),
    };
    if !folder.is_dir() {
        return Err(WriteError::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
    }
    let folder = folder.to_owned();
    Ok(Target { file: target, folder, kept })
}

/// Creates a temporary file with the permissions of an ordinary new file, because by default only the owner could read it.
#[cfg(unix)]
fn new_temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    use std::os::unix::fs::PermissionsExt;
    tempfile::Builder::new().prefix(".cplan").permissions(fs::Permissions::from_mode(0o666)).tempfile_in(folder)
}

#[cfg(not(unix))]
fn new_temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    tempfile::Builder::new().prefix(".cplan").tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_created_or_replaced_as_a_whole() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.json");
        write_whole(&file, b"one").unwrap();
        write_whole(&file, b"two").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["a.json"]);
    }

    #[test]
    fn failures_name_the_file_and_leave_no_temporary_file() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner.csv");
        fs::create_dir(&inner).unwrap();
        let message = write_whole(&inner, b"x").unwrap_err().to_string();
        assert!(message.contains("inner.csv") && message.contains("not a file"), "{message}");
        let message = write_whole(&folder.path().join("absent/a.csv"), b"x").unwrap_err().to_string();
        assert!(
            message.contains("a.csv: the folder") && message.ends_with("absent does not exist; create it first"),
            "{message}"
        );
        assert_eq!(names(folder.path()), ["inner.csv"]);
        assert!(names(&inner).is_empty());
    }

    #[test]
    fn sets_are_written_together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let [one, two, inner] = ["1.csv", "2.csv", "inner.csv"].map(|name| folder.path().join(name));
        fs::create_dir(&inner).unwrap();
        let message = write_whole_set(&[(one.clone(), "a"), (inner.clone(), "b")]).unwrap_err().to_string();
        assert!(message.contains("inner.csv"), "{message}");
        assert_eq!(names(folder.path()), ["inner.csv"]);
        write_whole_set(&[(one.clone(), "a"), (two.clone(), "b")]).unwrap();
        assert_eq!((fs::read(&one).unwrap(), fs::read(&two).unwrap()), (b"a".to_vec(), b"b".to_vec()));
        assert_eq!(names(folder.path()), ["1.csv", "2.csv", "inner.csv"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_default_and_preserved() {
        use std::os::unix::fs::PermissionsExt;
        let mode = |file: &Path| fs::metadata(file).unwrap().permissions().mode() & 0o777;
        let folder = tempfile::tempdir().unwrap();
        let (ordinary, ours) = (folder.path().join("ordinary"), folder.path().join("ours.csv"));
        fs::write(&ordinary, "x").unwrap();
        write_whole(&ours, b"x").unwrap();
        assert_eq!(mode(&ours), mode(&ordinary));
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).unwrap();
        write_whole(&ours, b"y").unwrap();
        assert_eq!(mode(&ours), 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_devices_refused() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.csv"), folder.path().join("link.csv"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        let device = write_whole(Path::new("/dev/null"), b"x").unwrap_err().to_string();
        assert!(device.contains("not a file"), "{device}");
    }
}
