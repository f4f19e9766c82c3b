//! Grids that know the preference of each cell.

use super::Grid;
use cplan_model::Scene;

/// The drift that a preference adds to the field in its region.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// The user's name for the preference.
    pub name: String,
    /// Strength of the drift per grid cell.
    pub epsilon: f64,
    /// Direction of the drift in joint space, of length 1. `None` if the preference gives none.
    pub direction: Option<[f64; 2]>,
}

/// A grid, with the preference that applies at the centre of each cell.
#[derive(Debug, Clone, PartialEq)]
pub struct ZonedGrid {
    /// The grid of free and blocked cells.
    pub grid: Grid,
    /// One zone per preference, in the order of the world file.
    pub zones: Vec<Zone>,
    of_cell: Vec<Option<u32>>,
}

impl ZonedGrid {
    /// Finds the preference that applies at each cell's centre. If several apply, the last one counts.
    /// `O(cells * corners of all regions)`.
    pub fn new(grid: Grid, scene: &Scene) -> Self {
        let preferences = &scene.workspace().preferences;
        let zones =
            preferences.iter().map(|p| Zone { name: p.name.clone(), epsilon: p.epsilon, direction: p.direction });
        let of = |cell| {
            let center = grid.center(cell);
            let holding = preferences.iter().rposition(|preference| preference.holds_at(scene.arm(), center));
            holding.map(|index| index as u32)
        };
        let of_cell = if preferences.is_empty() {
            vec![None; grid.blocked.len()]
        } else {
            (0..grid.blocked.len()).map(of).collect()
        };
        Self { zones: zones.collect(), of_cell, grid }
    }

    /// Returns the zone of a cell; `None` if no preference applies.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn zone(&self, cell: usize) -> Option<&Zone> {
        self.of_cell[cell].map(|index| &self.zones[index as usize])
    }
}
