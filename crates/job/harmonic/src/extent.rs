//! Boxes of cells: rectangles that may continue across the seam of a circle.

use cplan_multigrid::Ends;

/// A box of cells of a grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    /// First row and column of the box.
    pub first: [usize; 2],
    /// Numbers of rows and columns.
    pub cells: [usize; 2],
    /// Boundary condition of each axis. If the box covers a whole circle, its two ends are neighbours.
    pub ends: [Ends; 2],
}

impl Extent {
    /// Returns the index in the box, row by row, of a row and column of the grid.
    pub fn at(&self, [i, j]: [usize; 2]) -> usize {
        (i - self.first[0]) * self.cells[1] + j - self.first[1]
    }
}

/// The smallest box around a set of cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: [usize; 2],
    high: [usize; 2],
    /// For each axis, true if some cells are neighbours across the seam of the circle.
    joined: [bool; 2],
}

impl Bounds {
    /// Creates bounds without any cell.
    pub fn new() -> Self {
        Self { low: [usize::MAX; 2], high: [0; 2], joined: [false; 2] }
    }

    /// Adds a cell, by row and column.
    pub fn include(&mut self, place: [usize; 2]) {
        for k in [0, 1] {
            self.low[k] = self.low[k].min(place[k]);
            self.high[k] = self.high[k].max(place[k] + 1);
        }
    }

    /// Records whether two of the cells are neighbours across the seam of an axis.
    pub fn join(&mut self, axis: usize, joined: bool) {
        self.joined[axis] |= joined;
    }

    /// Returns the box in a grid of this shape. If cells are neighbours across a seam, it covers that whole circle. `None`
    /// without cells.
    pub fn extent(self, shape: [usize; 2]) -> Option<Extent> {
        if self.high == [0; 2] {
            return None;
        }
        let whole = |k: usize| if self.joined[k] { (0, shape[k]) } else { (self.low[k], self.high[k]) };
        let [rows, columns] = [0, 1].map(whole);
        let ends = self.joined.map(|joined| if joined { Ends::Joined } else { Ends::High });
        Some(Extent { first: [rows.0, columns.0], cells: [rows.1 - rows.0, columns.1 - columns.0], ends })
    }
}
