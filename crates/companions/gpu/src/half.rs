//! Memory layout of red-black grids: each colour is a grid of half the width.

/// The memory layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Half {
    pub rows: usize,
    pub columns: usize,
    /// Number of places per row of one colour.
    pub half: usize,
}

impl Half {
    pub fn new([rows, columns]: [usize; 2]) -> Self {
        Self { rows, columns, half: columns.div_ceil(2) }
    }

    /// Returns the number of places of both colours. With an odd number of columns, some places have no cell.
    pub fn places(self) -> usize {
        2 * self.rows * self.half
    }

    fn place(self, i: usize, j: usize) -> usize {
        ((i + j) % 2 * self.rows + i) * self.half + j / 2
    }

    /// Moves the numbers of cells to their places. Places without a cell get the default value.
    pub fn spread<T: Copy + Default>(self, of: impl Fn(usize) -> T) -> Vec<T> {
        let mut spread = vec![T::default(); self.places()];
        for i in 0..self.rows {
            for j in 0..self.columns {
                spread[self.place(i, j)] = of(i * self.columns + j);
            }
        }
        spread
    }

    /// Returns one number per cell, row by row, from the places. The inverse of [`Half::spread`].
    pub fn gathered(self, spread: &[f32]) -> Vec<f64> {
        let cells = (0..self.rows).flat_map(|i| (0..self.columns).map(move |j| (i, j)));
        cells.map(|(i, j)| f64::from(spread[self.place(i, j)])).collect()
    }

    /// Packs one flag per place into bits, 32 per word.
    pub fn mask(self, of: &[bool]) -> Vec<u32> {
        let bits = self.spread(|cell| of[cell]);
        bits.chunks(32).map(|bits| bits.iter().rev().fold(0, |word, &bit| word << 1 | u32::from(bit))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_go_to_their_places_and_back() {
        for cells in [[1, 1], [1, 5], [4, 6], [5, 7], [3, 2], [0, 4], [4, 0]] {
            let half = Half::new(cells);
            let count = cells[0] * cells[1];
            let spread = half.spread(|cell| cell as f32 + 1.0);
            let back: Vec<f64> = (0..count).map(|cell| cell as f64 + 1.0).collect();
            assert_eq!(half.gathered(&spread), back);
            assert_eq!(spread.iter().filter(|&&value| value != 0.0).count(), count, "no two at one place");
            let mask = half.mask(&(0..count).map(|cell| cell % 3 == 0).collect::<Vec<_>>());
            assert_eq!(mask.iter().map(|word| word.count_ones()).sum::<u32>() as usize, count.div_ceil(3));
        }
    }

    #[test]
    fn a_colour_has_its_cells_in_the_order_of_their_rows() {
        // In the source, place j of row i is column 2 j + (i mod 2) of one colour, and column 2 j + 1 - (i mod 2) of the other.
        let half = Half::new([3, 6]);
        for i in 0..3 {
            for j in 0..3 {
                assert_eq!(half.place(i, 2 * j + i % 2), i * 3 + j);
                assert_eq!(half.place(i, 2 * j + 1 - i % 2), 9 + i * 3 + j);
            }
        }
    }
}
