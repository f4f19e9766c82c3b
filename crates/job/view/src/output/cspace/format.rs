//! Formats of configuration spaces, chosen by file name.

use super::{CSpaces, FieldGrid, geojson};
use cplan_motion::field_per_line;
use std::path::Path;

/// A format of configuration spaces as data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CSpaceFormat {
    /// The whole configuration space, as in `docs/cspace.schema.json`.
    Json,
    /// Everything with coordinates, as features.
    GeoJson,
    /// The values of a grid as a matrix.
    Csv,
    /// The potential of a field as a matrix.
    PotentialCsv,
    /// The estimates of a search of a grid as a matrix.
    HeuristicCsv,
}

impl CSpaceFormat {
    /// Returns the format for a file name, in upper or lower case. `cspace.json`, and names that end in `.cspace.json`, mean
    /// JSON; `cspace.csv`, `potential.csv` and `heuristic.csv` likewise mean matrices; `.geojson` means GeoJSON. Returns `None`
    /// for other names.
    pub fn from_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let is = |end: &str| name.strip_suffix(end).is_some_and(|before| before.is_empty() || before.ends_with('.'));
        if is("cspace.json") {
            Some(Self::Json)
        } else if is("cspace.csv") {
            Some(Self::Csv)
        } else if is("potential.csv") {
            Some(Self::PotentialCsv)
        } else if is("heuristic.csv") {
            Some(Self::HeuristicCsv)
        } else {
            path.extension()?.eq_ignore_ascii_case("geojson").then_some(Self::GeoJson)
        }
    }

    /// Returns the text of the file. `None` for a matrix if no grid has such values.
    pub fn text(self, spaces: &CSpaces) -> Option<String> {
        let grid = || spaces.spaces.iter().find_map(|space| space.grid.as_ref());
        match self {
            Self::Json => Some(field_per_line(spaces)),
            Self::GeoJson => Some(geojson::text(spaces)),
            Self::Csv => grid().map(FieldGrid::matrix),
            Self::PotentialCsv => grid()?.potential_matrix(),
            Self::HeuristicCsv => grid()?.estimate_matrix(),
        }
    }
}
