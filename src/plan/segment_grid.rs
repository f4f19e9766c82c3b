//! A uniform grid over segments: which of them can a straight line meet?

use crate::geometry::Point;
use std::ops::{ControlFlow, Range};

/// Part of a cell by which a segment is taken to be longer and wider when it is entered in cells or walked along.
/// Rounding errors here are of the order of `MAX_CELLS` times the machine precision, about 1e-13 of a cell.
const PAD: f64 = 1e-6;

/// Most cells along one axis.
const MAX_CELLS: usize = 512;

/// Cells along one axis for `n` segments: `CELLS_PER_ROOT * sqrt(n)`, so that there are four cells a segment.
const CELLS_PER_ROOT: f64 = 2.0;

/// Segments by the cells that they pass through.
#[derive(Debug, Clone)]
pub(super) struct SegmentGrid {
    origin: Point,
    /// Side lengths of a cell.
    step: [f64; 2],
    /// Cells along both axes.
    count: usize,
    /// Segments of cell `c` are `segments[first[c]..first[c + 1]]`.
    first: Vec<usize>,
    segments: Vec<usize>,
}

impl SegmentGrid {
    /// Enters all segments; `O(n sqrt n)` at worst, when all are as long as the grid.
    pub fn new(segments: impl ExactSizeIterator<Item = (Point, Point)> + Clone) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in segments.clone().flat_map(|(a, b)| [a, b]) {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let count = ((CELLS_PER_ROOT * (segments.len() as f64).sqrt()) as usize).clamp(1, MAX_CELLS);
        let step = [0, 1].map(|k| {
            let step = (high[k] - low[k]) / count as f64;
            if step > 0.0 && step.is_finite() { step } else { 1.0 }
        });
        let mut grid = Self {
            origin: Point::new(low[0], low[1]),
            step,
            count,
            first: vec![0; count * count + 1],
            segments: Vec::new(),
        };
        let mut entries: Vec<(usize, usize)> = Vec::new();
        for (k, (a, b)) in segments.enumerate() {
            let _ = grid.cells(a, b, |cells| {
                entries.extend(cells.map(|c| (c, k)));
                ControlFlow::Continue::<()>(())
            });
        }
        entries.sort_unstable();
        for &(cell, _) in &entries {
            grid.first[cell + 1] += 1;
        }
        for c in 0..count * count {
            grid.first[c + 1] += grid.first[c];
        }
        grid.segments = entries.into_iter().map(|(_, k)| k).collect();
        grid
    }

    /// Calls `visit` with at least every segment that meets the segment from `a` to `b`, some of them repeatedly, till
    /// it breaks.
    pub fn along<B>(&self, a: Point, b: Point, mut visit: impl FnMut(usize) -> ControlFlow<B>) -> ControlFlow<B> {
        self.cells(a, b, |cells| {
            // Cells of one column are stored one after the other.
            let segments = &self.segments[self.first[cells.start]..self.first[cells.end]];
            segments.iter().try_for_each(|&k| visit(k))
        })
    }

    /// Calls `visit` with the range of cells in each column that the segment touches, till it breaks.
    ///
    /// A point that two segments share is in a cell of both: its column lies between those of the ends because
    /// [`SegmentGrid::index`] is monotone even when rounded, and in that column both ranges contain its row because
    /// they are padded.
    fn cells<B>(&self, a: Point, b: Point, mut visit: impl FnMut(Range<usize>) -> ControlFlow<B>) -> ControlFlow<B> {
        let (left, right) = if a.x <= b.x { (a, b) } else { (b, a) };
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let (begin, end) = (self.index(0, left.x), self.index(0, right.x));
        for column in begin..=end {
            let (mut from, mut to) = (low, high);
            if begin < end {
                let border = |k: usize, pad: f64| self.origin.x + (k as f64 + pad) * self.step[0];
                let slope = (right.y - left.y) / (right.x - left.x);
                let ordinate = |x: f64| (left.y + (x.clamp(left.x, right.x) - left.x) * slope).clamp(low, high);
                let (y, z) = (ordinate(border(column, -PAD)), ordinate(border(column + 1, PAD)));
                (from, to) = (y.min(z), y.max(z));
            }
            let pad = PAD * self.step[1];
            let rows = self.index(1, from - pad)..self.index(1, to + pad) + 1;
            visit(column * self.count + rows.start..column * self.count + rows.end)?;
        }
        ControlFlow::Continue(())
    }

    /// The column or row of a coordinate, the outermost one if it is outside.
    fn index(&self, axis: usize, coordinate: f64) -> usize {
        // A cast from a float saturates: 0 below the origin.
        (((coordinate - self.origin[axis]) / self.step[axis]) as usize).min(self.count - 1)
    }
}
