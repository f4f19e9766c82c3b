//! Finds packages by the name in their `package.xml`.

use roxmltree::Document;
use std::path::{Path, PathBuf};

/// Maximum depth of the search below a folder.
const MAX_FOLDER_DEPTH: usize = 4;

/// Maximum number of folders searched below a folder.
const MAX_FOLDERS: usize = 1_000;

/// Finds the packages with this name: the folder itself, or folders below it, nearest first.
pub fn declared(package: &str, folder: &Path) -> Vec<PathBuf> {
    let mut level = vec![folder.to_owned()];
    let (mut found, mut seen) = (Vec::new(), 0);
    for _ in 0..=MAX_FOLDER_DEPTH {
        found.extend(level.iter().filter(|folder| name(folder).as_deref() == Some(package)).cloned());
        level = level.iter().flat_map(|folder| subfolders(folder)).take(MAX_FOLDERS - seen).collect();
        seen += level.len();
    }
    found
}

/// Returns the name in the `package.xml` of a folder.
fn name(folder: &Path) -> Option<String> {
    let text = std::fs::read_to_string(folder.join("package.xml")).ok()?;
    let document = Document::parse(text.trim_start()).ok()?;
    let name = document.root_element().children().find(|node| node.has_tag_name("name"))?;
    Some(name.text()?.trim().to_owned())
}

/// Returns the folders in a folder, sorted by name, except hidden ones.
fn subfolders(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().filter_map(Result::ok);
    let is_folder = |entry: &std::fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_dir());
    let shown = entries.filter(|entry| is_folder(entry) && !entry.file_name().to_string_lossy().starts_with('.'));
    let mut folders: Vec<PathBuf> = shown.map(|entry| entry.path()).collect();
    folders.sort();
    folders
}
