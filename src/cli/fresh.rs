//! Files with default names, which must not replace files of the user by accident.

use super::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// Creates a folder, with the folders above it. Does nothing if it exists.
///
/// # Errors
/// I/O errors.
pub fn folder(path: &Path) -> Result<(), Failure> {
    if path.as_os_str().is_empty() || path.is_dir() {
        return Ok(());
    }
    fs::create_dir_all(path).map_err(|error| {
        let why = if path.exists() { "a file of this name exists".into() } else { error.kind().to_string() };
        Failure::Io(format!("cannot make the folder {}: {why}", path.display()))
    })
}

/// Returns the files that exist. A symbolic link without a target counts as an existing file.
pub fn existing_files(files: &[PathBuf]) -> Vec<&PathBuf> {
    files.iter().filter(|file| file.symlink_metadata().is_ok()).collect()
}

/// Checks that files do not exist, unless `force` is set. `elsewhere` is the alternative that the message suggests.
///
/// # Errors
/// Existing files. The message names all of them.
pub fn refuse_existing_files(files: &[PathBuf], force: bool, elsewhere: &str) -> Result<(), Failure> {
    let there: Vec<String> = existing_files(files).iter().map(|file| file.display().to_string()).collect();
    if force || there.is_empty() {
        return Ok(());
    }
    let (exist, them) = if there.len() == 1 { ("exists", "it") } else { ("exist", "them") };
    Err(Failure::Refused(format!(
        "{} {exist} already; nothing was written\n  hint: --force replaces {them}, {elsewhere}",
        there.join(" and ")
    )))
}

/// Returns a path as a word for a shell, quoted if necessary.
pub fn word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "._-/\\:+~".contains(c);
    if !text.is_empty() && text.chars().all(plain) { text } else { format!("\"{text}\"") }
}
