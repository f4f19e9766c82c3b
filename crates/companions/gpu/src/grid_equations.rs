//! The problem to solve: a grid of cells with an equation at each.

use super::GpuError;

/// Boundary condition at the first and the last cell of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Edge {
    /// The axis is a circle: beyond its end lie the cells of the other end.
    Circle,
    /// Beyond the end lies a wall with the value `outside`.
    Wall,
    /// The end reflects: a cell at the end is its own neighbour.
    Mirror,
}

/// The equation at a cell. Neighbours are in the order previous row, next row, previous column, next column.
#[derive(Debug, Clone, PartialEq)]
pub enum Stencil {
    /// The value is the mean of the four neighbours.
    Mean,
    /// The value is a weighted mean of the neighbours. The four weights of each cell add up to 1. With negative
    /// weights, relaxation may diverge.
    Weights(Vec<[f64; 4]>),
    /// The value is the mean of the neighbours plus a multiple of `(|difference of rows| + |difference of columns|) /
    /// 2`. Each cell has its own factor.
    Altered(Vec<f64>),
}

/// A grid of cells with their values, equations and boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct GridEquations {
    pub(super) cells: [usize; 2],
    pub(super) edges: [Edge; 2],
    pub(super) outside: f64,
    pub(super) values: Vec<f64>,
    pub(super) unknown: Vec<bool>,
    pub(super) stencil: Stencil,
}

/// Largest number of cells: places are counted in 32 bits, with four weights per cell.
const MAX_CELLS: usize = 1 << 29;

impl GridEquations {
    /// Creates a grid of `cells[0]` rows and `cells[1]` columns. `edges[0]` applies beyond the first and the last row.
    /// `outside` is the value beyond walls. Lists have one entry per cell, row by row. Where `unknown` is false,
    /// `values` are fixed; where it is true, they are the initial values. Takes `O(cells)`.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if a list does not have one entry per cell, a number is not finite, or there are more than
    /// 2^29 cells.
    pub fn new(
        cells: [usize; 2],
        edges: [Edge; 2],
        outside: f64,
        values: Vec<f64>,
        unknown: Vec<bool>,
        stencil: Stencil,
    ) -> Result<Self, GpuError> {
        let refused = |what: &str| Err(GpuError::Refused(what.into()));
        let (given, fine) = match &stencil {
            Stencil::Mean => (values.len(), true),
            Stencil::Weights(weights) => (weights.len(), weights.iter().flatten().all(|w| w.is_finite())),
            Stencil::Altered(strength) => (strength.len(), strength.iter().all(|s| s.is_finite())),
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
        Ok(Self { cells, edges, outside, values, unknown, stencil })
    }

    /// Replaces the values, one per cell.
    ///
    /// # Errors
    /// Same as [`GridEquations::new`].
    pub fn from(self, values: Vec<f64>) -> Result<Self, GpuError> {
        Self::new(self.cells, self.edges, self.outside, values, self.unknown, self.stencil)
    }

    /// Returns the axes that are circles with an odd number of cells, as bits; rows are bit 0.
    pub(super) fn odd_circles(cells: [usize; 2], edges: [Edge; 2]) -> u32 {
        let odd = |axis: usize| u32::from(edges[axis] == Edge::Circle && cells[axis] % 2 == 1);
        odd(0) + 2 * odd(1)
    }
}

impl Edge {
    /// Returns the code used by the kernels.
    pub(super) fn code(self) -> u32 {
        match self {
            Self::Circle => 0,
            Self::Wall => 1,
            Self::Mirror => 2,
        }
    }
}
