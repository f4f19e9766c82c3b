//! Published data and robots that are not part of the project.

use std::path::PathBuf;

/// Returns a file or folder of the published data. Tests that need such data are ignored by default. To run them:
/// `CPLAN_REFERENCE=folder cargo test -- --ignored`.
pub fn published(part: &str) -> PathBuf {
    let folder = std::env::var_os("CPLAN_REFERENCE");
    let folder = folder.expect("CPLAN_REFERENCE names the folder with the published data: data/map1.map, urdf/...");
    let path = PathBuf::from(folder).join(part);
    assert!(path.exists(), "CPLAN_REFERENCE names a folder without {part}");
    path
}
