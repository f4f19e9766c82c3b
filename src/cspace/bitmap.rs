//! A configuration space as bits.

use super::rows::{Row, Rows};
use crate::model::Scene;
use crate::space::{Configuration, Topology};

/// Cells as in [`super::Grid`], one bit each: set where the cell's *centre* comes within the clearance of an obstacle.
///
/// What it proves: the centres, exactly up to [`crate::geometry::ROUNDING`]; nothing between them ([`super::Proves::Sampled`]).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bitmap {
    cells: [usize; 2],
    /// Of a row.
    words: usize,
    bits: Vec<u64>,
}

/// Bits of a word.
const WORD: usize = u64::BITS as usize;

impl Bitmap {
    /// Number of cells along each axis.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Whether the centre of cell `(i, j)` is blocked.
    ///
    /// # Panics
    /// If there is no such cell.
    #[must_use]
    pub fn blocked(&self, i: usize, j: usize) -> bool {
        assert!(i < self.cells[0] && j < self.cells[1], "a cell of the bitmap");
        self.bits[i * self.words + j / WORD] >> (j % WORD) & 1 == 1
    }

    /// Number of blocked cells.
    #[must_use]
    pub fn count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// The words of row `i`, cell 0 in the lowest bit of the first; bits beyond the last cell are 0.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn row(&self, i: usize) -> &[u64] {
        &self.bits[i * self.words..(i + 1) * self.words]
    }
}

/// The bitmap of a scene: [`super::grid_from_rows`] in an eighth of the memory, row by row from exact intervals.
/// `O(rows * contacts + cells / 64)`.
#[must_use]
pub fn bitmap(scene: &Scene, cells: [usize; 2], clearance: f64) -> Bitmap {
    let rows = Rows::new(scene);
    let topology: Topology = scene.arm.topology();
    let words = cells[1].div_ceil(WORD);
    let mut bits = vec![0_u64; words * cells[0]];
    let step = [0, 1].map(|k| topology.axes[k].extent() / cells[k] as f64);
    let (first, second) = (topology.axes[0].domain().0, topology.axes[1].domain().0);
    let bands = rows.bands(clearance);
    let mut row = Row::default();
    for (i, words) in bits.chunks_exact_mut(words.max(1)).enumerate() {
        let q = Configuration::new(first + (i as f64 + 0.5) * step[0], second);
        if bands.forbids(q[0]) {
            fill(words, 0, cells[1]);
            continue;
        }
        rows.row(q[0], clearance, &mut row);
        for &[start, end] in &row.merged {
            let from = ((start - second) / step[1] - 0.5).ceil().max(0.0) as usize;
            let to = (((end - second) / step[1] - 0.5).floor() + 1.0).max(0.0) as usize;
            fill(words, from, to.min(cells[1]));
        }
    }
    Bitmap { cells, words, bits }
}

/// Sets the bits `from..to`.
fn fill(words: &mut [u64], from: usize, to: usize) {
    if from >= to {
        return;
    }
    let (first, last) = (from / WORD, (to - 1) / WORD);
    let head = u64::MAX << (from % WORD);
    let tail = u64::MAX >> (WORD - 1 - (to - 1) % WORD);
    if first == last {
        words[first] |= head & tail;
    } else {
        words[first] |= head;
        words[first + 1..last].fill(u64::MAX);
        words[last] |= tail;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_set_from_the_first_to_before_the_last() {
        for from in 0..200 {
            for to in 0..=200 {
                let mut words = [0; 4];
                fill(&mut words, from, to);
                let set = |i: usize| words[i / WORD] >> (i % WORD) & 1 == 1;
                assert!((0..256).all(|i| set(i) == (from <= i && i < to)), "{from} {to}");
            }
        }
    }
}
