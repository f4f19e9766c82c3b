//! Which file names ask for the configuration space.

use super::CSpaces;
use std::path::Path;

/// A format of configuration spaces as data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CSpaceFormat {
    /// All of it, as `docs/cspace.schema.json` has it.
    Json,
    /// What has coordinates, as features.
    GeoJson,
}

impl CSpaceFormat {
    /// The format that a file's name stands for, in upper or lower case: `cspace.json`, what ends in `.cspace.json`, and what
    /// ends in `.geojson`. None of other names.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        if name == "cspace.json" || name.ends_with(".cspace.json") {
            Some(Self::Json)
        } else {
            path.extension()?.eq_ignore_ascii_case("geojson").then_some(Self::GeoJson)
        }
    }

    /// The file's text.
    #[must_use]
    pub fn text(self, spaces: &CSpaces) -> String {
        match self {
            Self::Json => spaces.json(),
            Self::GeoJson => spaces.geojson(),
        }
    }
}
