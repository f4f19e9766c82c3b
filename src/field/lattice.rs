//! The lattice of a grid.

use super::Lattice;
use crate::cspace::Grid;

impl From<&Grid> for Lattice {
    fn from(grid: &Grid) -> Self {
        Self::new(grid.cells, grid.topology.ranges.map(|range| range.is_circle()), &grid.blocked)
    }
}
