//! The problem to solve: a grid of cells, each with a value or an equation.

use super::GpuError;
use cplan_fields::{Boundary, CellEquations};

/// A grid of cells with their values, equations and boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct GridEquations {
    pub(super) cells: [usize; 2],
    pub(super) boundaries: [Boundary; 2],
    pub(super) outside: f64,
    pub(super) values: Vec<f64>,
    pub(super) unknown: Vec<bool>,
    pub(super) equations: CellEquations,
}

/// Largest number of cells. Cells are counted in 32 bits, and each has four weights.
const MAX_CELLS: usize = 1 << 29;

impl GridEquations {
    /// Creates a grid of `cells[0]` rows and `cells[1]` columns. `boundaries[0]` applies beyond the first and the last
    /// row. `outside` is the value beyond [`Boundary::High`]. Lists have one entry per cell, row by row. `values` are
    /// fixed where `unknown` is false. Elsewhere they are the initial values. Takes `O(cells)`.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if a list does not have one entry per cell, a number is not finite, or there are more than
    /// 2^29 cells.
    pub fn new(
        cells: [usize; 2],
        boundaries: [Boundary; 2],
        outside: f64,
        values: Vec<f64>,
        unknown: Vec<bool>,
        equations: CellEquations,
    ) -> Result<Self, GpuError> {
        let refused = |what: &str| Err(GpuError::Refused(what.into()));
        let (given, fine) = match &equations {
            CellEquations::Mean => (values.len(), true),
            CellEquations::Weights(weights) => (weights.len(), weights.iter().flatten().all(|w| w.is_finite())),
            CellEquations::Altered(strength) => (strength.len(), strength.iter().all(|s| s.is_finite())),
        };
        let Some(count) = cells[0].checked_mul(cells[1]).filter(|&count| count <= MAX_CELLS) else {
            return refused("there are more than 2^29 cells");
        };
        if values.len() != count || unknown.len() != count || given != count {
            return refused("there must be one value, one flag and one stencil per cell");
        }
        if !(fine && outside.is_finite() && values.iter().all(|v| v.is_finite())) {
            return refused("values, weights and strengths must be finite numbers");
        }
        Ok(Self { cells, boundaries, outside, values, unknown, equations })
    }

    /// Replaces the values, one per cell.
    ///
    /// # Errors
    /// Same as [`GridEquations::new`].
    pub fn from(self, values: Vec<f64>) -> Result<Self, GpuError> {
        Self::new(self.cells, self.boundaries, self.outside, values, self.unknown, self.equations)
    }

    /// Returns a bit for each axis that is a circle with an odd number of cells. Bit 0 is for the rows.
    pub(super) fn odd_circles(cells: [usize; 2], boundaries: [Boundary; 2]) -> u32 {
        let odd = |axis: usize| u32::from(boundaries[axis] == Boundary::Periodic && cells[axis] % 2 == 1);
        odd(0) + 2 * odd(1)
    }
}

/// Returns the code of a boundary condition in the kernels.
pub(super) fn code(boundary: Boundary) -> u32 {
    match boundary {
        Boundary::Periodic => 0,
        Boundary::High => 1,
        Boundary::Reflecting => 2,
    }
}
