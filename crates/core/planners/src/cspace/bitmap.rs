//! A configuration space with one bit per cell.

use super::Slice;
use cplan_model::space::JointRange;
use cplan_model::{Contacts, Scene, on_axis};
use std::ops::Range;

/// The cells of a [`super::Grid`] with one bit each: set if the cell's *centre* is within the clearance of an
/// obstacle.
///
/// The bits prove the state of the centres, up to [`cplan_geometry::ROUNDING`], and nothing about configurations in
/// between ([`super::Proves::Sampled`]).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bitmap {
    cells: [usize; 2],
    /// Number of 64-bit words per row.
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

/// Computes the bitmap of a scene. It has the same cells as [`super::grid_from_slices`], in an eighth of the memory.
/// Each pair is examined only in the rows where link 2 can reach its piece.
/// `O(reached slices * contacts + cells / 64)`.
pub fn bitmap(scene: &Scene, cells: [usize; 2], clearance: f64) -> Bitmap {
    let slices = Contacts::new(scene);
    let axes: [JointRange; 2] = scene.arm().topology().ranges;
    let words = cells[1].div_ceil(WORD_BITS);
    let mut bits = vec![0_u64; words * cells[0]];
    let [lines, columns] = [0, 1].map(|k| Centers::new(axes[k], cells[k]));

    let banned = Slice::bands(&slices, clearance).merged;
    let banned: Vec<Range<usize>> = banned.into_iter().map(|band| lines.within(band)).collect();
    for band in &banned {
        for i in band.clone() {
            fill(&mut bits[i * words..(i + 1) * words], 0, cells[1]);
        }
    }
    let elbows: Vec<_> = (0..cells[0]).map(|i| slices.elbow(lines.at(i))).collect();
    let (mut reached, mut intervals) = (Vec::new(), Vec::new());
    for index in slices.second_link_pairs() {
        reached.clear();
        let hits = slices.reach_range(index, clearance, &mut reached);
        on_axis(&scene.arm().joints[0], hits, &reached, |range| {
            // Add a row at either end, for the rounding of the range.
            let range = lines.within(range);
            let range = range.start.saturating_sub(1)..(range.end + 1).min(cells[0]);
            for i in without(range, &banned) {
                let (elbow, heading) = elbows[i];
                let row = &mut bits[i * words..(i + 1) * words];
                intervals.clear();
                let hits = slices.at_elbow(index, elbow, heading, clearance, &mut intervals);
                on_axis(&scene.arm().joints[1], hits, &intervals, |blocked| {
                    let blocked = columns.within(blocked);
                    fill(row, blocked.start, blocked.end);
                });
            }
        });
    }
    Bitmap { cells, words, bits }
}

/// The centres of the cells along one axis.
struct Centers {
    lower: f64,
    step: f64,
    per_cell: f64,
    count: usize,
}

impl Centers {
    fn new(range: JointRange, count: usize) -> Self {
        let step = range.extent() / count as f64;
        Self { lower: range.domain().0, step, per_cell: 1.0 / step, count }
    }

    fn at(&self, i: usize) -> f64 {
        self.lower + (i as f64 + 0.5) * self.step
    }

    /// Returns the cells whose centres lie in the closed interval.
    fn within(&self, [start, end]: [f64; 2]) -> Range<usize> {
        // Conversions truncate and saturate, which is cheaper than rounding up or down without SSE 4.1.
        let at = |value: f64| (value - self.lower) * self.per_cell - 0.5;
        let up = |x: f64| x as usize + usize::from(x > (x as usize) as f64);
        let (start, end) = (at(start), at(end));
        let to = if end >= 0.0 { end as usize + 1 } else { 0 };
        let (from, to) = (up(start), to.min(self.count));
        from..to
    }
}

/// Iterates over the members of `range` that are in none of the `others`, which must be ascending.
fn without<'a>(range: Range<usize>, others: &'a [Range<usize>]) -> impl Iterator<Item = usize> + 'a {
    let ends = others.iter().map(|o| o.start).chain([usize::MAX]);
    let starts = [0].into_iter().chain(others.iter().map(|o| o.end));
    starts.zip(ends).flat_map(move |(from, to)| from.max(range.start)..to.min(range.end))
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
