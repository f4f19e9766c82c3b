//! The free cells connected with the goal, as a graph.

use super::{Lattice, Wave};
use crate::interrupt::checkpoint;

/// The free cells that a wave from the goal reached, numbered in the order in which it came: the goals first, then level
/// by level. Positions within this numbering, not indices of the grid, are the currency of the field algorithms.
///
/// Relaxing in this order carries information away from the goal through a whole corridor in one sweep; and because
/// neighbours lie on consecutive levels (never on one, but for circles of odd size) it is a consistent ordering, for
/// which Young's theory of over-relaxation holds.
#[derive(Debug, Clone)]
pub struct Component {
    /// Index in the grid of each position.
    pub cells: Vec<u32>,
    /// Positions of the four neighbours of each position, in the order `-q1, +q1, -q2, +q2`; [`Component::wall`] where
    /// there is no free cell.
    pub neighbors: Vec<[u32; 4]>,
    /// How many of the first positions are goals.
    pub goals: usize,
    /// Levels of the wave.
    pub levels: usize,
    /// Shape of the grid.
    pub shape: [usize; 2],
    /// Position of each cell of the grid, or [`Component::wall`].
    position: Vec<u32>,
}

/// So many cells take less than a millisecond.
const CELLS_BETWEEN_CHECKPOINTS: usize = 4096;

impl Component {
    /// From the wave, in linear time.
    #[must_use]
    pub fn new(lattice: &Lattice, wave: &Wave) -> Self {
        let wall = wave.order.len() as u32;
        let [rows, columns] = lattice.cells();
        let mut position = vec![wall; (rows + 2) * (columns + 2)];
        for (at, &framed) in wave.order.iter().enumerate() {
            position[framed as usize] = at as u32;
        }
        let neighbors = wave.order.iter().enumerate().map(|(at, &framed)| {
            if at.is_multiple_of(CELLS_BETWEEN_CHECKPOINTS) {
                checkpoint();
            }
            lattice.around(framed as usize).map(|place| match lattice.resolve(place) {
                Some(cell) => position[cell],
                None => wall,
            })
        });
        let cells: Vec<u32> = wave.order.iter().map(|&framed| lattice.index(framed as usize) as u32).collect();
        let goals = cells.iter().take_while(|&&cell| wave.label(lattice, cell as usize) == 0).count();
        let neighbors = neighbors.collect();
        position.truncate((rows + 1) * (columns + 2));
        let position =
            position.chunks_exact(columns + 2).skip(1).flat_map(|line| &line[1..=columns]).copied().collect();
        Self { neighbors, cells, goals, levels: wave.levels, shape: [rows, columns], position }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there is no cell at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The position that stands for all that is not free.
    #[must_use]
    pub fn wall(&self) -> usize {
        self.cells.len()
    }

    /// Position of cell `index` of the grid, if the wave came there.
    #[must_use]
    pub fn position_of(&self, index: usize) -> Option<usize> {
        Some(self.position[index] as usize).filter(|&position| position != self.wall())
    }

    /// Row and column of a position.
    #[must_use]
    pub fn place(&self, position: usize) -> [usize; 2] {
        // Divisions of 32 bits take a fraction of the time.
        let (cell, columns) = (self.cells[position], self.shape[1] as u32);
        [(cell / columns) as usize, (cell % columns) as usize]
    }

    /// How much room there is at each position, in two ways. Linear.
    #[must_use]
    pub fn room(&self) -> Room {
        let mut clearance = vec![u32::MAX; self.len()];
        let beside_wall = |around: &[u32; 4]| around.iter().any(|&n| n as usize == self.wall());
        let mut queue: Vec<u32> =
            (0..self.len() as u32).filter(|&i| beside_wall(&self.neighbors[i as usize])).collect();
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
            for next in self.neighbors[from] {
                let next = next as usize;
                if next != self.wall() && clearance[next] == u32::MAX {
                    clearance[next] = clearance[from] + 1;
                    queue.push(next as u32);
                }
            }
        }
        let mut widest = clearance.clone();
        checkpoint();
        for &i in queue.iter().rev() {
            for n in self.neighbors[i as usize].map(|n| n as usize) {
                if n != self.wall() && clearance[n] > clearance[i as usize] {
                    widest[i as usize] = widest[i as usize].max(widest[n]);
                }
            }
        }
        Room { clearance, widest }
    }
}

/// The room at each position of a [`Component`].
#[derive(Debug, Clone)]
pub struct Room {
    /// Steps to the nearest wall, 1 for a cell beside one. Where there are no walls at all: steps to a goal, and 1.
    pub clearance: Vec<u32>,
    /// Greatest clearance that can be reached by going away from walls: that of the room or corridor a cell belongs to.
    pub widest: Vec<u32>,
}
