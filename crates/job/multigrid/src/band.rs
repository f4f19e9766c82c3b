//! Rows of cells of one colour of a chessboard, and their neighbours of the other colour.

use super::machine::{LANES, Machine, packs, packs_mut};

/// Largest number of stages of a pipeline. The last stage is `STAGES - 1` rows behind the first stage, and reads one
/// more row.
pub(super) const STAGES: usize = 5;

/// The cells of one colour in several rows. Each row has an extra cell at either end, and there are extra rows above the first
/// and below the last. A band may keep only the last few of many rows.
#[derive(Debug, Clone)]
pub(super) struct Band<T> {
    pub width: usize,
    kept: usize,
    pub data: Vec<T>,
}

impl<T: Copy + Default> Band<T> {
    pub fn new(width: usize, kept: usize) -> Self {
        Self { width, kept, data: vec![T::default(); kept * (width + LANES) + LANES] }
    }

    /// Returns the start of the row above row `i`.
    #[inline(always)]
    pub fn above(&self, i: usize) -> usize {
        let slot = if i < self.kept { i } else { i % self.kept };
        slot * (self.width + LANES) + LANES
    }

    #[inline(always)]
    pub fn start(&self, i: usize) -> usize {
        self.above(i + 1)
    }

    #[inline(always)]
    pub fn below(&self, i: usize) -> usize {
        self.above(i + 2)
    }

    /// Returns row `i`, including padding, as `count` packs. The caller passes the count, so that loops over several rows need no
    /// bounds checks.
    #[inline(always)]
    pub fn row(&self, i: usize, count: usize) -> &[[T; LANES]] {
        packs(&self.data, self.start(i), count)
    }

    #[inline(always)]
    pub fn row_mut(&mut self, i: usize, count: usize) -> &mut [[T; LANES]] {
        let start = self.start(i);
        packs_mut(&mut self.data, start, count)
    }

    /// Returns row `i` as single cells.
    #[inline(always)]
    pub fn cells_mut(&mut self, i: usize) -> &mut [T] {
        let start = self.start(i);
        &mut self.data[start..start + self.width]
    }

    /// Returns the neighbours, which have the other colour, of the cells of `colour` in row `i`.
    #[inline(always)]
    pub fn around(&self, i: usize, colour: Color, count: usize) -> Around<'_, T> {
        let at = self.start(i);
        let west = (colour == Color::Odd) == i.is_multiple_of(2);
        let packs = |at: usize| packs(&self.data, at, count);
        let side = packs(if west { at - 1 } else { at + 1 });
        Around { above: packs(self.above(i)), below: packs(self.below(i)), beside: [packs(at), side] }
    }
}

/// The colour of a cell on the chessboard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Color {
    Even,
    Odd,
}

/// The neighbours of the cells of a row.
pub(super) struct Around<'a, T> {
    above: &'a [[T; LANES]],
    below: &'a [[T; LANES]],
    beside: [&'a [[T; LANES]]; 2],
}

impl Around<'_, f32> {
    #[inline(always)]
    pub fn sum<M: Machine>(&self, m: M, k: usize) -> M::Single {
        (m.pack(&self.beside[0][k]) + m.pack(&self.beside[1][k])) + (m.pack(&self.above[k]) + m.pack(&self.below[k]))
    }

    /// Returns the sum of the neighbours in pack `k`, without rounding to single precision.
    #[inline(always)]
    pub fn exact_sum<M: Machine>(&self, m: M, k: usize) -> M::Double {
        let [a, b] = self.beside.map(|row| m.double(m.pack(&row[k])));
        let [c, d] = [self.above, self.below].map(|row| m.double(m.pack(&row[k])));
        (a + b) + (c + d)
    }
}

impl Around<'_, f64> {
    #[inline(always)]
    pub fn sum<M: Machine>(&self, m: M, k: usize) -> M::Double {
        let [a, b] = self.beside.map(|row| m.pack_double(&row[k]));
        let [c, d] = [self.above, self.below].map(|row| m.pack_double(&row[k]));
        (a + b) + (c + d)
    }
}
