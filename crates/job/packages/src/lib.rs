//! Finds packages of ROS: folders with a `package.xml` that states their name.

#![forbid(unsafe_code)]

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// Number of folders above a file whose contents are searched for packages. They include the file's package, its repository, and
/// the workspace around the repository.
const SEARCHED_PARENTS: usize = 5;

/// Largest depth of the search below each of these folders.
const SEARCHED_DEPTH: usize = 4;

/// Largest number of folders that are searched below each of these folders.
const MAX_FOLDERS: usize = 1_000;

/// Largest size of a `package.xml`, bytes.
const MAX_MANIFEST_BYTES: u64 = 1 << 20;

/// Returns the folders that may be the package `name` to which a file refers, the most likely first.
///
/// A folder is the package if its `package.xml` has the name in `<name>`. Folders above the file come first. Next are folders
/// below these, up to the root of a Git repository, and folders below `ROS_PACKAGE_PATH`. The last ones only share the package's
/// name: folders above the file, and folders in `ROS_PACKAGE_PATH` and `AMENT_PREFIX_PATH`.
pub fn packages(name: &str, file: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let above: Vec<PathBuf> = folder.ancestors().map(Path::to_owned).collect();
    let repository = above.iter().position(|folder| folder.join(".git").exists());
    let mut near: Vec<PathBuf> = above.iter().take(repository.map_or(SEARCHED_PARENTS, |at| at + 1)).cloned().collect();
    let listed = search_path("ROS_PACKAGE_PATH");
    near.extend(listed.iter().cloned());
    let with_child = |folders: Vec<PathBuf>| {
        let name = name.to_owned();
        folders.into_iter().flat_map(move |folder| [folder.clone(), folder.join(&name)])
    };
    let has_name = |folder: &PathBuf, name: &str| manifest_name(folder).is_some_and(|found| found == name);
    let (in_manifest, in_path, in_folder) = (name.to_owned(), name.to_owned(), name.to_owned());
    let about = with_child(above.clone()).filter(move |folder| has_name(folder, &in_manifest));
    let below =
        near.into_iter().flat_map(|folder| folders_below(&folder)).filter(move |folder| has_name(folder, &in_path));
    let called = with_child(above.into_iter().chain(listed).collect())
        .filter(move |folder| folder.is_dir() && folder.file_name().is_some_and(|own| *own == *in_folder));
    let name = name.to_owned();
    let installed = search_path("AMENT_PREFIX_PATH").into_iter().map(move |path| path.join("share").join(&name));
    about.chain(below).chain(called).chain(installed.filter(|folder| folder.is_dir()))
}

/// Returns all folders below a folder, breadth first and sorted by name. Skips hidden folders.
fn folders_below(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = Vec::new();
    let mut next = VecDeque::from([(folder.to_owned(), SEARCHED_DEPTH)]);
    while let Some((folder, levels)) = next.pop_front() {
        let Ok(entries) = folder.read_dir() else { continue };
        let mut inside: Vec<PathBuf> = entries
            .filter_map(Result::ok)
            .filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'))
            .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
            .map(|entry| entry.path())
            .collect();
        inside.sort();
        inside.truncate(MAX_FOLDERS - found.len());
        found.extend(inside.iter().cloned());
        if levels > 1 {
            next.extend(inside.into_iter().map(|folder| (folder, levels - 1)));
        }
        if found.len() >= MAX_FOLDERS {
            break;
        }
    }
    found
}

/// Returns the package name in a folder's `package.xml`.
fn manifest_name(folder: &Path) -> Option<String> {
    let path = folder.join("package.xml");
    if path.metadata().ok()?.len() > MAX_MANIFEST_BYTES {
        return None;
    }
    let text = std::fs::read_to_string(path).ok()?;
    let manifest = roxmltree::Document::parse(text.trim_start()).ok()?;
    let root = manifest.root_element();
    let name = root.children().find(|node| root.has_tag_name("package") && node.has_tag_name("name"))?;
    name.text().map(|name| name.trim().to_owned())
}

fn search_path(variable: &str) -> Vec<PathBuf> {
    let paths = std::env::var_os(variable).unwrap_or_default();
    std::env::split_paths(&paths).filter(|path| !path.as_os_str().is_empty()).collect()
}
