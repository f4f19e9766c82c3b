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
    /// The values of a grid as a matrix.
    Csv,
}

impl CSpaceFormat {
    /// The format that a file's name stands for, in upper or lower case: `cspace.json` and `cspace.csv`, what ends in
    /// `.cspace.json` or `.cspace.csv`, and what ends in `.geojson`. None of other names.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let is = |end: &str| name.strip_suffix(end).is_some_and(|before| before.is_empty() || before.ends_with('.'));
        if is("cspace.json") {
            Some(Self::Json)
        } else if is("cspace.csv") {
            Some(Self::Csv)
        } else {
            path.extension()?.eq_ignore_ascii_case("geojson").then_some(Self::GeoJson)
        }
    }

    /// Returns the file's text; nothing for a matrix if there is no grid.
    #[must_use]
    pub fn text(self, spaces: &CSpaces) -> Option<String> {
        match self {
            Self::Json => Some(spaces.json()),
            Self::GeoJson => Some(spaces.geojson()),
            Self::Csv => spaces.csv(),
        }
    }
}
