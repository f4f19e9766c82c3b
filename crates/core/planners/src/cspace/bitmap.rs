//! A configuration space with one bit per cell.

use super::slabs::block_centers;
use cplan_model::Scene;

/// The cells of a [`super::Grid`] with one bit each: set if the cell's *centre* is within the clearance of an
/// obstacle.
///
/// The bits are proven for the centres, up to [`cplan_geometry::ROUNDING`]. They prove nothing about configurations in
/// between ([`super::Proves::Sampled`]).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bitmap {
    cells: [usize; 2],
    /// Number of words per row.
    words: usize,
    bits: Vec<u64>,
}

/// Number of bits in a word.
const WORD_BITS: usize = u64::BITS as usize;

impl Bitmap {
    /// Returns the number of cells along each axis.
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Returns true if the centre of cell `(i, j)` is blocked.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn blocked(&self, i: usize, j: usize) -> bool {
        assert!(i < self.cells[0] && j < self.cells[1], "a cell of the bitmap");
        self.bits[i * self.words + j / WORD_BITS] >> (j % WORD_BITS) & 1 == 1
    }

    /// Returns the number of blocked cells.
    pub fn count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Returns the words of row `i`. Cell 0 is the lowest bit of the first word; bits beyond the last cell are 0.
    ///
    /// # Panics
    /// If the row does not exist.
    pub fn row(&self, i: usize) -> &[u64] {
        &self.bits[i * self.words..(i + 1) * self.words]
    }
}

/// Computes the bitmap of a scene. The cells are those of [`super::grid_from_slices`], in an eighth of the memory. Each
/// pair is examined only in the rows where link 2 can reach its piece. `O(reached slices * contacts + cells / 64)`.
pub fn bitmap(scene: &Scene, cells: [usize; 2], clearance: f64) -> Bitmap {
    let words = cells[1].div_ceil(WORD_BITS);
    let mut bits = vec![0_u64; words * cells[0]];
    block_centers(scene, cells, clearance, |row, columns| {
        fill(&mut bits[row * words..(row + 1) * words], columns.start, columns.end);
    });
    Bitmap { cells, words, bits }
}

/// Sets the bits from `from` up to, but not including, `to`.
fn fill(words: &mut [u64], from: usize, to: usize) {
    if from >= to {
        return;
    }
    let (first, last) = (from / WORD_BITS, (to - 1) / WORD_BITS);
    let head = u64::MAX << (from % WORD_BITS);
    let tail = u64::MAX >> (WORD_BITS - 1 - (to - 1) % WORD_BITS);
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
                let set = |i: usize| words[i / WORD_BITS] >> (i % WORD_BITS) & 1 == 1;
                assert!((0..256).all(|i| set(i) == (from <= i && i < to)), "{from} {to}");
            }
        }
    }
}
