//! Cells and the preference regions that they lie in.

use super::Grid;
use crate::model::Scene;

/// The effect of a preference.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// The user's name for it.
    pub name: String,
    /// Strength of the drift, per cell.
    pub epsilon: f64,
    /// Direction of the drift in joint space, of length 1.
    pub direction: Option<[f64; 2]>,
}

/// A grid whose cells know the preference that holds at their centres.
#[derive(Debug, Clone, PartialEq)]
pub struct ZonedGrid {
    /// The cells, free and blocked.
    pub grid: Grid,
    /// Zones, in the order of the world file.
    pub zones: Vec<Zone>,
    of_cell: Vec<Option<u32>>,
}

impl ZonedGrid {
    /// Creates the zones of the preferences of the scene's workspace. If several apply, the last one counts.
    /// `O(cells * corners of all regions)`.
    #[must_use]
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

    /// Returns the zone of a cell.
    ///
    /// # Panics
    /// If the cell does not exist.
    #[must_use]
    pub fn zone(&self, cell: usize) -> Option<&Zone> {
        self.of_cell[cell].map(|index| &self.zones[index as usize])
    }
}
