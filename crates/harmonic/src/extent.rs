//! Boxes of cells.

use cplan_multigrid::Ends;

/// A box of cells of a grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    /// Its first row and column.
    pub first: [usize; 2],
    /// Rows and columns.
    pub cells: [usize; 2],
    /// What is beyond the box: nothing, or its other end on a circle.
    pub ends: [Ends; 2],
}

impl Extent {
    /// Where in the box, row by row, a row and column of the grid is.
    pub fn at(&self, [i, j]: [usize; 2]) -> usize {
        (i - self.first[0]) * self.cells[1] + j - self.first[1]
    }
}

/// The smallest box around some cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: [usize; 2],
    high: [usize; 2],
    /// Whether some of the cells are neighbours across the seam of a circle.
    joined: [bool; 2],
}

impl Bounds {
    /// Around no cell.
    pub fn new() -> Self {
        Self { low: [usize::MAX; 2], high: [0; 2], joined: [false; 2] }
    }

    /// One more cell, by row and column.
    pub fn include(&mut self, place: [usize; 2]) {
        for k in [0, 1] {
            self.low[k] = self.low[k].min(place[k]);
            self.high[k] = self.high[k].max(place[k] + 1);
        }
    }

    /// Whether two of the cells are neighbours across the seam of an axis.
    pub fn join(&mut self, axis: usize, joined: bool) {
        self.joined[axis] |= joined;
    }

    /// The box in a grid of this shape: all of a circle whose seam is crossed. None around no cell.
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
