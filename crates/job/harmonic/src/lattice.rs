//! The grid with a frame of cells, in which each cell has four neighbours, and a breadth-first search (wave) over it.

use cplan_interrupt::checkpoint;
use cplan_planners::cspace::Grid;
use cplan_planners::waves::UNREACHED;

/// Label of a [`Site::Twin`].
const TWIN_LABEL: u32 = u32::MAX - 1;
/// Label of a [`Site::Wall`].
const WALL_LABEL: u32 = u32::MAX - 2;

/// Kind of a place in the framed grid, in one byte, because a map of all places is copied for every wave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Site {
    Free,
    /// A place beyond the seam of a circle. It represents the free cell on the other side.
    Twin,
    /// A blocked cell, or a place beyond a limit.
    Wall,
}

/// A grid with a frame of one cell around it, so that every cell has four neighbours at constant offsets. Beyond the
/// limits of an interval, the frame is wall. On a circle, the frame represents the cells of the other side.
///
/// Indices are *framed*: row `i`, column `j` of the grid is `(i + 1) * (cells[1] + 2) + j + 1`, which is less than
/// `2^32 - 3`.
#[derive(Debug, Clone)]
pub struct Lattice {
    cells: [usize; 2],
    stride: usize,
    sites: Vec<Site>,
}

/// The number of steps to the nearest source, for every free cell connected with a source.
#[derive(Debug, Clone)]
pub struct Wave {
    /// Framed cells in the order in which the wave reached them.
    pub(super) order: Vec<u32>,
    /// Number of sources, which come first in the order.
    pub(super) sources: usize,
    /// Number of distinct labels.
    pub levels: usize,
    /// Label of each place.
    pub(super) labels: Vec<u32>,
}

impl From<&Grid> for Lattice {
    fn from(grid: &Grid) -> Self {
        Self::new(grid.cells, grid.topology.ranges.map(|range| range.is_circle()), &grid.blocked)
    }
}

impl Lattice {
    /// Builds the lattice of `cells` rows and columns, with `blocked` row by row. `circles` states which axes are circles, on
    /// which the last row (or column) is a neighbour of the first. Linear.
    ///
    /// # Panics
    /// If the length of `blocked` is not the product of `cells`, or the frame has `2^32 - 3` cells or more.
    pub fn new(cells: [usize; 2], circles: [bool; 2], blocked: &[bool]) -> Self {
        let [rows, columns] = cells;
        assert_eq!(blocked.len(), rows * columns, "one flag a cell");
        let stride = columns + 2;
        assert!(
            (rows + 2).saturating_mul(stride) < WALL_LABEL as usize,
            "the grid has too many cells for 32-bit labels"
        );
        let mut sites = vec![Site::Wall; (rows + 2) * stride];
        for (line, blocked) in sites.chunks_exact_mut(stride).skip(1).zip(blocked.chunks_exact(columns.max(1))) {
            for (cell, &blocked) in line[1..].iter_mut().zip(blocked) {
                if !blocked {
                    *cell = Site::Free;
                }
            }
        }
        let twin = |cell: Site| if cell == Site::Free { Site::Twin } else { Site::Wall };
        if circles[0] {
            for j in 1..=columns {
                sites[j] = twin(sites[rows * stride + j]);
                sites[(rows + 1) * stride + j] = twin(sites[stride + j]);
            }
        }
        if circles[1] {
            for i in 1..=rows {
                sites[i * stride] = twin(sites[i * stride + columns]);
                sites[i * stride + columns + 1] = twin(sites[i * stride + 1]);
            }
        }
        Self { cells, stride, sites }
    }

    /// Returns the number of rows and columns.
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Returns the framed index of cell `index` of the grid.
    pub(super) fn framed(&self, index: usize) -> usize {
        (index / self.cells[1] + 1) * self.stride + index % self.cells[1] + 1
    }

    /// Returns the index in the grid of a framed cell outside the frame.
    fn index(&self, framed: usize) -> usize {
        (framed / self.stride - 1) * self.cells[1] + framed % self.stride - 1
    }

    /// Returns the neighbouring places, in the order `-q1, +q1, -q2, +q2`.
    pub(super) fn neighbors(&self, framed: usize) -> [usize; 4] {
        [framed - self.stride, framed + self.stride, framed - 1, framed + 1]
    }

    /// Returns the free cell that a place is, or represents. `None` for walls.
    pub(super) fn resolve(&self, framed: usize) -> Option<usize> {
        match self.sites[framed] {
            Site::Free => Some(framed),
            Site::Twin => Some(self.other_side(framed)),
            Site::Wall => None,
        }
    }

    /// Iterates over the places in the frame that represent free cells, each with its cell.
    pub(super) fn cell_copies(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let ([rows, columns], stride) = (self.cells, self.stride);
        let lines = (1..=columns).flat_map(move |j| [j, (rows + 1) * stride + j]);
        let ends = (1..=rows).flat_map(move |i| [i * stride, i * stride + columns + 1]);
        let twins = lines.chain(ends).filter(|&place| self.sites[place] == Site::Twin);
        twins.map(|place| [place, self.other_side(place)])
    }

    /// Returns the cell that a place in the frame represents.
    fn other_side(&self, framed: usize) -> usize {
        let wrap = |at: usize, n: usize| match at {
            0 => n,
            at if at == n + 1 => 1,
            at => at,
        };
        let (i, j) = (framed / self.stride, framed % self.stride);
        wrap(i, self.cells[0]) * self.stride + wrap(j, self.cells[1])
    }

    /// Labels all free cells that are connected with `sources` (indices in the grid) with the number of steps to the nearest
    /// source, breadth-first over neighbours with a common side. This is the navigation function in the `L1` metric. Linear; a
    /// few nanoseconds per cell.
    pub fn wave(&self, sources: &[usize]) -> Wave {
        let label = |site: &Site| match site {
            Site::Free => UNREACHED,
            Site::Twin => TWIN_LABEL,
            Site::Wall => WALL_LABEL,
        };
        let mut labels: Vec<u32> = self.sites.iter().map(label).collect();
        let mut order: Vec<u32> = Vec::with_capacity(self.cells[0] * self.cells[1]);
        for &source in sources {
            let source = self.framed(source);
            if labels[source] == UNREACHED {
                labels[source] = 0;
                order.push(source as u32);
            }
        }
        let sources = order.len();
        let mut levels = 0;
        let mut begin = 0;
        while begin < order.len() {
            checkpoint();
            let end = order.len();
            levels += 1;
            for at in begin..end {
                for next in self.neighbors(order[at] as usize) {
                    // This single comparison skips walls and labelled cells.
                    if labels[next] >= TWIN_LABEL {
                        let next = if labels[next] == TWIN_LABEL { self.other_side(next) } else { next };
                        if labels[next] == UNREACHED {
                            labels[next] = levels as u32;
                            order.push(next as u32);
                        }
                    }
                }
            }
            begin = end;
        }
        Wave { order, sources, levels, labels }
    }
}

impl Wave {
    /// Returns the labels of all cells of the grid, without the frame.
    pub fn labels(&self, lattice: &Lattice) -> Vec<u32> {
        let [rows, columns] = lattice.cells;
        let mut labels = Vec::with_capacity(rows * columns);
        for line in self.labels.chunks_exact(lattice.stride).skip(1).take(rows) {
            labels.extend(line[1..=columns].iter().map(|&label| if label >= WALL_LABEL { UNREACHED } else { label }));
        }
        labels
    }

    /// Returns the cells from `index` to a source, always to the neighbour with the smallest label (the first of equals). This is
    /// a shortest path in the `L1` metric. `None` if the wave did not reach `index`.
    pub fn descend(&self, lattice: &Lattice, index: usize) -> Option<Vec<usize>> {
        let mut at = lattice.framed(index);
        let mut label = self.labels[at];
        if label >= WALL_LABEL {
            return None;
        }
        let mut cells = vec![index];
        while label > 0 {
            let around = lattice.neighbors(at).map(|place| lattice.resolve(place));
            at = around.into_iter().flatten().min_by_key(|&next| self.labels[next])?;
            label = self.labels[at];
            cells.push(lattice.index(at));
        }
        Some(cells)
    }
}
