//! The wave cell by cell, through a queue.

use super::{FreeCells, Neighborhood, UNREACHED};

/// Labels every cell that a wave from `sources` (free cells) reaches. `labels` must be [`UNREACHED`] everywhere.
///
/// Which cells wait for a label is kept in bits beside the labels: those are written only, once each.
pub(super) fn queue_wave(free: &FreeCells, sources: &[usize], neighborhood: Neighborhood, labels: &mut [u32]) {
    let mut wave = QueueWave { free, labels, waiting: free.bits().to_vec(), level: 0, front: Vec::new() };
    for &source in sources {
        let columns = free.cells()[1];
        wave.reach(source / columns, source % columns);
    }
    let mut front = Vec::new();
    while !wave.front.is_empty() {
        std::mem::swap(&mut front, &mut wave.front);
        wave.level += 1;
        for &[i, j] in &front {
            match neighborhood {
                Neighborhood::Four => wave.step_to_sides(i as usize, j as usize),
                Neighborhood::Eight => wave.step(i as usize, j as usize),
            }
        }
        front.clear();
    }
}

struct QueueWave<'a> {
    free: &'a FreeCells,
    labels: &'a mut [u32],
    /// Free cells without a label, packed like the free cells.
    waiting: Vec<u64>,
    level: u32,
    /// Row and column of the cells with that label.
    front: Vec<[u32; 2]>,
}

impl QueueWave<'_> {
    /// Gives a cell the label of the level, if it waits for one.
    fn reach(&mut self, i: usize, j: usize) {
        let at = i * self.free.words() + j / 64;
        self.reach_bit(at, 1 << (j % 64), i * self.free.cells()[1] + j, i, j);
    }

    /// The same for a cell whose places are known.
    fn reach_bit(&mut self, word: usize, bit: u64, index: usize, i: usize, j: usize) {
        let word = &mut self.waiting[word];
        if *word & bit != 0 {
            *word ^= bit;
            self.labels[index] = self.level;
            self.front.push([i as u32, j as u32]);
        }
    }

    /// From a cell to those that share a side.
    fn step_to_sides(&mut self, i: usize, j: usize) {
        let [rows, columns] = self.free.cells();
        if i == 0 || i + 1 == rows || j == 0 || j + 1 == columns {
            for i in self.free.beside(0, i).into_iter().flatten() {
                self.reach(i, j);
            }
            for j in self.free.beside(1, j).into_iter().flatten() {
                self.reach(i, j);
            }
            return;
        }
        let (line, index) = (i * self.free.words(), i * columns + j);
        let (word, bit) = (line + j / 64, 1 << (j % 64));
        self.reach_bit(word - self.free.words(), bit, index - columns, i - 1, j);
        self.reach_bit(word + self.free.words(), bit, index + columns, i + 1, j);
        self.reach_bit(line + (j - 1) / 64, 1 << ((j - 1) % 64), index - 1, i, j - 1);
        self.reach_bit(line + (j + 1) / 64, 1 << ((j + 1) % 64), index + 1, i, j + 1);
    }

    /// From a cell to those that share a corner too.
    fn step(&mut self, i: usize, j: usize) {
        let columns = self.free.cells()[1];
        for next in self.free.moves(i * columns + j, Neighborhood::Eight) {
            if self.labels[next.to] == UNREACHED {
                self.reach(next.to / columns, next.to % columns);
            }
        }
    }
}
