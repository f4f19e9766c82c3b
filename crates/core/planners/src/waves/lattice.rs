//! Converts a grid to the lattice of the crate `harmonic`.

use crate::cspace::Grid;
use cplan_harmonic::Lattice;

impl From<&Grid> for Lattice {
    fn from(grid: &Grid) -> Self {
        Self::new(grid.cells, grid.topology.ranges.map(|range| range.is_circle()), &grid.blocked)
    }
}
