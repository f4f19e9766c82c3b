//! The free cells of a grid, one bit each, and the moves between them.

use crate::cspace::Grid;
use serde::{Deserialize, Serialize};

/// The cells that count as neighbours of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Neighborhood {
    /// Cells that share a side.
    #[default]
    Four,
    /// Cells that share a side or a corner. A diagonal move passes through a corner that four cells share. The other
    /// two of these must be free, because touching a blocked cell is contact.
    Eight,
}

impl Neighborhood {
    /// Returns the number of neighbours.
    pub fn count(self) -> u8 {
        match self {
            Self::Four => 4,
            Self::Eight => 8,
        }
    }
}

/// A move between neighbouring cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Move {
    /// Index of the cell to which the move leads.
    pub to: usize,
    /// True for a move through a corner.
    pub is_diagonal: bool,
}

/// The free cells of a grid, one bit each. 4096 x 4096 cells take 2 MiB, which fits in the cache. Cell `(i, j)` has
/// its index in the grid, `i * cells[1] + j`.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeCells {
    cells: [usize; 2],
    circles: [bool; 2],
    /// Number of words per row. Each row begins in a new word.
    words: usize,
    /// One bit per cell, 1 if free. Bits beyond the last column are 0.
    bits: Vec<u64>,
}

impl FreeCells {
    /// Collects the free cells. Linear in the number of cells.
    ///
    /// # Panics
    /// If there are `2^32 - 1` cells or more.
    pub fn new(grid: &Grid) -> Self {
        let [rows, columns] = grid.cells;
        assert!(rows.saturating_mul(columns) < u32::MAX as usize, "the grid has too many cells for 32-bit labels");
        let packed = |chunk: &[bool]| chunk.iter().enumerate().fold(0, |word, (k, &b)| word | u64::from(!b) << k);
        let lines = grid.blocked.chunks_exact(columns.max(1));
        Self {
            cells: grid.cells,
            circles: grid.topology.ranges.map(|axis| axis.is_circle()),
            words: columns.div_ceil(64),
            bits: lines.flat_map(|line| line.chunks(64)).map(packed).collect(),
        }
    }

    /// Returns the number of rows and columns.
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Returns true for each axis whose last row or column is next to the first.
    pub fn circles(&self) -> [bool; 2] {
        self.circles
    }

    /// Returns the number of free cells.
    pub fn count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Returns true if cell `index` is free.
    pub fn is_free(&self, index: usize) -> bool {
        self.has(index / self.cells[1], index % self.cells[1])
    }

    /// Iterates over the moves from cell `from`, also across the seams of circles. Moves to cells that share a side
    /// come first, in the order `-q1, +q1, -q2, +q2`, then diagonal ones: `-q1 -q2`, `-q1 +q2`, `+q1 -q2`,
    /// `+q1 +q2`.
    pub fn moves(&self, from: usize, neighborhood: Neighborhood) -> impl Iterator<Item = Move> + use<> {
        let columns = self.cells[1];
        let (i, j) = (from / columns, from % columns);
        let (rows, around) = (self.adjacent_lines(0, i), self.adjacent_lines(1, j));
        let free = |i: Option<usize>, j: Option<usize>| match (i, j) {
            (Some(i), Some(j)) if self.has(i, j) => Some(i * columns + j),
            _ => None,
        };
        let straight = [(rows[0], Some(j)), (rows[1], Some(j)), (Some(i), around[0]), (Some(i), around[1])];
        let straight = straight.map(|(i, j)| free(i, j));
        let diagonal = |(a, b): (usize, usize)| {
            let allowed = neighborhood == Neighborhood::Eight && straight[a].and(straight[2 + b]).is_some();
            if allowed { free(rows[a], around[b]) } else { None }
        };
        let diagonals = [(0, 0), (0, 1), (1, 0), (1, 1)].map(diagonal);
        let moves = |to: [Option<usize>; 4], is_diagonal: bool| {
            to.into_iter().flatten().map(move |to| Move { to, is_diagonal })
        };
        moves(straight, false).chain(moves(diagonals, true))
    }

    /// Returns the previous and the next row or column of number `at`. `None` beyond a limit.
    pub(super) fn adjacent_lines(&self, axis: usize, at: usize) -> [Option<usize>; 2] {
        let (last, is_circle) = (self.cells[axis] - 1, self.circles[axis]);
        let before = if at > 0 { Some(at - 1) } else { is_circle.then_some(last) };
        let after = if at < last { Some(at + 1) } else { is_circle.then_some(0) };
        [before, after]
    }

    pub(super) fn words(&self) -> usize {
        self.words
    }

    /// Returns the bits of all rows.
    pub(super) fn bits(&self) -> &[u64] {
        &self.bits
    }

    fn has(&self, i: usize, j: usize) -> bool {
        self.bits[i * self.words + j / 64] >> (j % 64) & 1 == 1
    }

    fn row(&self, i: usize) -> &[u64] {
        &self.bits[i * self.words..(i + 1) * self.words]
    }

    /// Returns the number of runs in all rows. A run is a sequence of free cells in a row that cannot be extended.
    pub(super) fn runs(&self) -> usize {
        let mut runs = 0;
        for line in self.bits.chunks_exact(self.words.max(1)) {
            let mut before = 0;
            for &word in line {
                runs += (word & !(word << 1 | before)).count_ones() as usize;
                before = word >> 63;
            }
        }
        runs
    }

    /// Returns the first free column from `from` to before `to`, or the first blocked one if `free` is false. `to` if
    /// there is none.
    pub(super) fn next(&self, i: usize, from: usize, to: usize, free: bool) -> usize {
        if from >= to {
            return to;
        }
        let flip = if free { 0 } else { u64::MAX };
        let line = self.row(i);
        let mut mask = u64::MAX << (from % 64);
        for (k, &word) in line.iter().enumerate().take(to.div_ceil(64)).skip(from / 64) {
            let word = (word ^ flip) & mask;
            if word != 0 {
                return (k * 64 + word.trailing_zeros() as usize).min(to);
            }
            mask = u64::MAX;
        }
        to
    }

    /// Returns the first column of the free run that ends before column `end`. `end` if the previous cell is blocked.
    pub(super) fn run_start(&self, i: usize, end: usize) -> usize {
        let line = self.row(i);
        let mut start = end;
        while start > 0 {
            // The bits of the word up to the previous column, shifted to the top of the word.
            let held = (start - 1) % 64 + 1;
            let ones = ((line[(start - 1) / 64] << (64 - held)).leading_ones() as usize).min(held);
            start -= ones;
            if ones < held {
                break;
            }
        }
        start
    }
}
