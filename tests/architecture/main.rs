//! The source text itself: who imports whom, what comes from outside, and that no test is left to chance or left out.

mod dependencies;
mod imports;
mod seeds;
mod targets;

use std::path::{Path, PathBuf};

/// All files of Rust in a folder and the folders in it, in order.
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
