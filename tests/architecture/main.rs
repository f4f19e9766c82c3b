//! Tests of the source text: imports between crates, external dependencies, reproducible random tests, tests that
//! nobody runs, and plain English.

mod dependencies;
mod imports;
mod seeds;
mod targets;
mod words;

use std::path::{Path, PathBuf};

/// Returns all Rust files in a folder and its subfolders, in order.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    files_of(folder, &["rs"])
}

/// Returns all files with one of these extensions in a folder and its subfolders, in order. Leaves out hidden folders
/// and those of builds.
fn files_of(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            if name != "target" && !name.starts_with('.') {
                files.extend(files_of(&path, extensions));
            }
        } else if path.extension().is_some_and(|e| extensions.iter().any(|known| e == *known)) {
            files.push(path);
        }
    }
    files.sort();
    files
}
