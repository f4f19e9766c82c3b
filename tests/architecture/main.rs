//! Tests of the source text itself: imports between crates, external dependencies, reproducible random tests, and no
//! test left out.

mod dependencies;
mod imports;
mod seeds;
mod targets;

use std::path::{Path, PathBuf};

/// Returns all Rust files in a folder and its subfolders, in order.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}
