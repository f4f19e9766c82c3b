//! Memory layout of cells: rows are padded to whole vectors, and a frame around them implements the boundary conditions.

use super::machine::LANES;
use std::ops::Range;

/// Boundary condition at the two ends of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Beyond the limit, the value is 0, as in walls (Dirichlet).
    High,
    /// Beyond the limit, the cell at the limit has a mirror image with the same value, so nothing flows across the limit
    /// (Neumann).
    Reflecting,
    /// The axis is a circle, so the two ends are neighbours.
    Joined,
}

/// The layout of one level. Each row has an extra cell at either end, and there are extra rows above the first and below the
/// last. After a row is finished, these cells have the values that [`Ends`] prescribes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub rows: usize,
    pub columns: usize,
    pub ends: [Ends; 2],
    /// The number of `columns`, padded to whole packs.
    pub width: usize,
    stride: usize,
}

impl Frame {
    pub fn new([rows, columns]: [usize; 2], ends: [Ends; 2]) -> Self {
        let width = columns.next_multiple_of(LANES);
        Self { rows, columns, ends, width, stride: width + LANES }
    }

    /// Returns the layout of coefficients, which do not couple across the ends of an interval.
    pub fn of_coefficients(self) -> Self {
        let ends = self.ends.map(|ends| if ends == Ends::Joined { Ends::Joined } else { Ends::High });
        Self { ends, ..self }
    }

    /// Returns the number of cells to allocate.
    pub fn len(&self) -> usize {
        (self.rows + 2) * self.stride
    }

    /// Returns the cells of row `i`, including padding.
    pub fn row(&self, i: usize) -> Range<usize> {
        let start = (i + 1) * self.stride + 1;
        start..start + self.width
    }

    /// Returns the cells of row `i`, including padding and the extra cell at each end.
    pub fn framed(&self, i: usize) -> Range<usize> {
        let start = (i + 1) * self.stride;
        start..start + self.width + 2
    }

    /// Returns the start of row `i - 1`, which may be the extra row above the first.
    pub fn above(&self, i: usize) -> usize {
        i * self.stride + 1
    }

    /// Returns the start of row `i + 1`, which may be the extra row below the last.
    pub fn below(&self, i: usize) -> usize {
        (i + 2) * self.stride + 1
    }

    /// Returns row `i` with the rows above and below it, each with its extra cells.
    pub fn three<'a, T>(&self, data: &'a [T], i: usize) -> [&'a [T]; 3] {
        [0, 1, 2].map(|k| &data[(i + k) * self.stride..(i + k) * self.stride + self.width + 2])
    }

    /// Sets those cells of the frame that depend on row `i`.
    #[inline]
    pub fn finish_row<T: Copy + Default>(&self, data: &mut [T], i: usize) {
        self.finish_ends(&mut data[self.framed(i)]);
        let (above, below) = (0, (self.rows + 1) * self.stride);
        let from = (i + 1) * self.stride;
        let mut copy = |to| data.copy_within(from..from + self.width + 2, to);
        match self.ends[0] {
            Ends::High => {}
            Ends::Reflecting => {
                if i == 0 {
                    copy(above);
                }
                if i + 1 == self.rows {
                    copy(below);
                }
            }
            Ends::Joined => {
                if i == 0 {
                    copy(below);
                }
                if i + 1 == self.rows {
                    copy(above);
                }
            }
        }
    }

    /// Sets the extra cells before and after a row.
    #[inline]
    pub fn finish_ends<T: Copy + Default>(&self, framed: &mut [T]) {
        let last = self.columns;
        (framed[0], framed[last + 1]) = match self.ends[1] {
            Ends::High => (T::default(), T::default()),
            Ends::Reflecting => (framed[1], framed[last]),
            Ends::Joined => (framed[last], framed[1]),
        };
    }

    /// Sets the whole frame.
    pub fn finish<T: Copy + Default>(&self, data: &mut [T]) {
        for i in 0..self.rows {
            self.finish_row(data, i);
        }
    }

    /// Returns true if the axis of rows is a circle.
    pub fn is_joined_at_rows(&self) -> bool {
        self.ends[0] == Ends::Joined
    }

    /// Iterates over the steps of two loops that run together: the first loop makes rows, and the second uses a row as soon as it
    /// and the rows next to it are made, while they are still in the cache. On a circle, the last row is made first, because it
    /// lies above the first one.
    pub fn ahead(&self) -> impl Iterator<Item = AheadStep> + use<> {
        let rows = self.rows;
        let first = (self.is_joined_at_rows() && rows > 1).then(|| AheadStep { made: Some(rows - 1), used: None });
        let last = if first.is_some() { rows - 1 } else { rows };
        let rest = (0..=rows).map(move |i| AheadStep { made: (i < last).then_some(i), used: i.checked_sub(1) });
        first.into_iter().chain(rest)
    }
}

/// A step of [`Frame::ahead`]: the row to make, and then the row to use. `None` if there is no such row in this step.
#[derive(Debug, Clone, Copy)]
pub(super) struct AheadStep {
    pub made: Option<usize>,
    pub used: Option<usize>,
}
