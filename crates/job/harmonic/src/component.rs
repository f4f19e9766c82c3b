//! The free cells connected with the goal, as a graph.

use super::{Lattice, Wave};
use cplan_interrupt::checkpoint;

/// The free cells that a wave from the goals reached. Each has a *position*: its number in the order of the wave, which has first
/// the goals, then level by level. The algorithms of this crate use positions instead of indices of the grid. In this order, one
/// sweep of a relaxation carries information away from the goal through a whole corridor. Neighbours lie on consecutive levels
/// (never on the same one, except on circles of odd size), so this is a consistent ordering, for which Young's theory of
/// over-relaxation holds. Each cell needs two 32-bit numbers. The neighbours of a cell follow from its place in the grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Number of goals, which are the first positions.
    pub goals: usize,
    /// Number of levels of the wave.
    pub levels: usize,
    /// Rows and columns of the grid.
    pub shape: [usize; 2],
    /// Place of each position in the framed grid, which has one more cell on each side.
    places: Vec<u32>,
    /// Position at each place, or [`Component::wall`]. On a circle, a place in the frame has the position of the cell
    /// on the other side.
    positions: Vec<u32>,
}

/// Number of cells between two checkpoints. They take less than a millisecond.
const CELLS_BETWEEN_CHECKPOINTS: usize = 4096;

impl Component {
    /// Numbers the cells that a wave over this lattice reached. Linear in the number of cells.
    pub fn new(lattice: &Lattice, wave: Wave) -> Self {
        let Wave { order: places, sources: goals, levels, labels: mut positions } = wave;
        positions.fill(places.len() as u32);
        for (chunk, first) in places.chunks(CELLS_BETWEEN_CHECKPOINTS).zip((0..).step_by(CELLS_BETWEEN_CHECKPOINTS)) {
            checkpoint();
            chunk.iter().zip(first..).for_each(|(&place, position)| positions[place as usize] = position);
        }
        lattice.cell_copies().for_each(|[place, twin]| positions[place] = positions[twin]);
        Self { goals, levels, shape: lattice.cells(), places, positions }
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Returns true if there are no cells.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Returns the position that stands for all cells that are not free.
    pub fn wall(&self) -> usize {
        self.places.len()
    }

    /// Returns the positions of the four neighbours, in the order `-q1, +q1, -q2, +q2`. A neighbour that is not free is
    /// [`Component::wall`].
    pub fn neighbors(&self, position: usize) -> [usize; 4] {
        let (place, stride) = (self.places[position] as usize, self.shape[1] + 2);
        [place - stride, place + stride, place - 1, place + 1].map(|place| self.positions[place] as usize)
    }

    /// Returns the position of cell `index` of the grid, or `None` if the wave did not reach it.
    pub fn position_of(&self, index: usize) -> Option<usize> {
        let [i, j] = [index / self.shape[1], index % self.shape[1]];
        Some(self.row(i)[j] as usize).filter(|&position| position != self.wall())
    }

    /// Returns the positions in row `i` of the grid, by column. Cells that the wave did not reach are
    /// [`Component::wall`].
    pub(super) fn row(&self, i: usize) -> &[u32] {
        let columns = self.shape[1];
        let first = (i + 1) * (columns + 2) + 1;
        &self.positions[first..first + columns]
    }

    /// Returns the row and column of a position.
    pub fn place(&self, position: usize) -> [usize; 2] {
        // 32-bit divisions are several times as fast.
        let (place, stride) = (self.places[position], self.shape[1] as u32 + 2);
        [(place / stride - 1) as usize, (place % stride - 1) as usize]
    }

    /// Returns the index in the grid of a position.
    pub fn cell(&self, position: usize) -> usize {
        let [i, j] = self.place(position);
        i * self.shape[1] + j
    }

    /// Computes two measures of the room at each position. Linear in the number of cells.
    pub fn room(&self) -> Room {
        let mut clearance = vec![u32::MAX; self.len()];
        let beside_wall = |&i: &u32| self.neighbors(i as usize).contains(&self.wall());
        let mut queue: Vec<u32> = (0..self.len() as u32).filter(beside_wall).collect();
        if queue.is_empty() {
            queue.extend(0..self.goals as u32);
        }
        for &i in &queue {
            clearance[i as usize] = 1;
        }
        let mut at = 0;
        while at < queue.len() {
            if at.is_multiple_of(CELLS_BETWEEN_CHECKPOINTS) {
                checkpoint();
            }
            let from = queue[at] as usize;
            at += 1;
            for next in self.neighbors(from) {
                if next != self.wall() && clearance[next] == u32::MAX {
                    clearance[next] = clearance[from] + 1;
                    queue.push(next as u32);
                }
            }
        }
        let mut widest = clearance.clone();
        checkpoint();
        for &i in queue.iter().rev() {
            for n in self.neighbors(i as usize) {
                if n != self.wall() && clearance[n] > clearance[i as usize] {
                    widest[i as usize] = widest[i as usize].max(widest[n]);
                }
            }
        }
        Room { clearance, widest }
    }
}

/// Measures of the room at each position of a [`Component`].
#[derive(Debug, Clone)]
pub struct Room {
    /// Number of steps to the nearest wall: 1 for a cell beside a wall. If there are no walls, it is the number of
    /// steps to a goal plus 1.
    pub clearance: Vec<u32>,
    /// Greatest clearance that is reached by moving away from walls: about half the width of the room or corridor that contains
    /// the cell.
    pub widest: Vec<u32>,
}
