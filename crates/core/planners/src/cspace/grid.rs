//! The configuration space as a grid of cells.

use super::Proves;
use cplan_model::space::{Configuration, Topology};

/// A rectangular grid over the fundamental domain. Cell `(i, j)` covers
/// `[lower_1 + i h_1, lower_1 + (i + 1) h_1] x [lower_2 + j h_2, lower_2 + (j + 1) h_2]`. On a circle the last cell
/// borders on the first. Cells are stored row by row: cell `(i, j)` has the index `i * cells[1] + j`.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Topology of the configuration space.
    pub topology: Topology,
    /// Statement that a free or a blocked cell proves about its configurations.
    pub proves: Proves,
    /// Number of cells along each axis.
    pub cells: [usize; 2],
    /// For each cell, true if it is blocked.
    pub blocked: Vec<bool>,
}

impl Grid {
    /// Returns the side lengths of a cell, radians or metres.
    pub fn step(&self) -> [f64; 2] {
        [0, 1].map(|k| self.topology.ranges[k].extent() / self.cells[k] as f64)
    }

    /// Blocks the cells at whose centres the sum of joint values is not allowed. Lines between the other centres are
    /// allowed, because the allowed sums form a convex set.
    pub(super) fn block_sums(&mut self) {
        let Some(sum) = self.topology.sum else { return };
        for index in 0..self.blocked.len() {
            self.blocked[index] |= !sum.contains(self.center(index));
        }
    }

    /// Returns the centre of cell `index`, in the fundamental domain.
    pub fn center(&self, index: usize) -> Configuration {
        let step = self.step();
        let [i, j] = self.place(index);
        Configuration::new(
            self.topology.ranges[0].domain().0 + (i as f64 + 0.5) * step[0],
            self.topology.ranges[1].domain().0 + (j as f64 + 0.5) * step[1],
        )
    }

    /// Returns the index of the cell that contains `q`, or the copy of `q` in the domain. A configuration on a common
    /// side belongs to the cell that starts there.
    pub fn locate(&self, q: Configuration) -> usize {
        let step = self.step();
        let at = |k: usize| {
            let axis = self.topology.ranges[k];
            let steps = (axis.wrap(q[k]) - axis.domain().0) / step[k];
            (steps.max(0.0) as usize).min(self.cells[k] - 1)
        };
        at(0) * self.cells[1] + at(1)
    }

    /// Iterates over the cells that share a side with `index`, at most four, also across the seam of a circle. The
    /// order is `-q1, +q1, -q2, +q2`.
    pub fn neighbors(&self, index: usize) -> impl Iterator<Item = usize> {
        let at = self.place(index);
        [(0, false), (0, true), (1, false), (1, true)]
            .into_iter()
            .filter_map(move |(k, up)| self.adjacent_place(at, k, up))
    }

    /// Returns the neighbour of `index` along axis `k`, in the positive direction if `up`, also across the seam of a
    /// circle. `None` beyond a limit.
    pub fn adjacent_cell(&self, index: usize, k: usize, up: bool) -> Option<usize> {
        self.adjacent_place(self.place(index), k, up)
    }

    /// Returns the row and column of a cell.
    fn place(&self, index: usize) -> [usize; 2] {
        [index / self.cells[1], index % self.cells[1]]
    }

    fn adjacent_place(&self, mut at: [usize; 2], k: usize, up: bool) -> Option<usize> {
        let last = self.cells[k] - 1;
        let (end, beyond) = if up { (last, 0) } else { (0, last) };
        at[k] = match at[k] {
            here if here == end => self.topology.ranges[k].is_circle().then_some(beyond)?,
            here if up => here + 1,
            here => here - 1,
        };
        Some(at[0] * self.cells[1] + at[1])
    }
}
