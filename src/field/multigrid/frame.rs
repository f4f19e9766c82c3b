//! How cells lie in memory: rows padded to whole vectors, in a frame that says what is beyond the ends.

use std::ops::{Add, Mul, Range, Sub};

/// Rows are padded to a multiple of this many cells. Loops over whole rows then need no remainder.
pub(super) const LANES: usize = 8;

/// What lies beyond the two ends of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// The value 0: limits repel like obstacles (Dirichlet).
    High,
    /// The value of the cell at the end itself: nothing flows across the limit (Neumann).
    Reflecting,
    /// The other end: a circle.
    Joined,
}

/// The layout of one level. Each row has a cell before its first and one after its last; there is a row above the first
/// and one below the last. They hold what [`Ends`] says, once the row is finished.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub rows: usize,
    pub columns: usize,
    pub ends: [Ends; 2],
    /// `columns` padded.
    pub width: usize,
    stride: usize,
}

impl Frame {
    pub fn new([rows, columns]: [usize; 2], ends: [Ends; 2]) -> Self {
        let width = columns.next_multiple_of(LANES);
        Self { rows, columns, ends, width, stride: width + LANES }
    }

    /// The frame of coefficients: nothing couples across the ends of an interval.
    pub fn of_coefficients(self) -> Self {
        let ends = self.ends.map(|ends| if ends == Ends::Joined { Ends::Joined } else { Ends::High });
        Self { ends, ..self }
    }

    /// Cells to allocate.
    pub fn len(&self) -> usize {
        (self.rows + 2) * self.stride
    }

    /// The cells of row `i`, padding included.
    pub fn row(&self, i: usize) -> Range<usize> {
        let start = (i + 1) * self.stride + 1;
        start..start + self.width
    }

    /// The same row with the one cell before and one after.
    pub fn framed(&self, i: usize) -> Range<usize> {
        let start = (i + 1) * self.stride;
        start..start + self.width + 2
    }

    /// Where row `i - 1` starts, which may be the one above the first.
    pub fn above(&self, i: usize) -> usize {
        i * self.stride + 1
    }

    /// Where row `i + 1` starts, which may be the one below the last.
    pub fn below(&self, i: usize) -> usize {
        (i + 2) * self.stride + 1
    }

    /// Row `i` in the middle of the rows above and below it, each with the cell before and the one after.
    pub fn three<'a, T>(&self, data: &'a [T], i: usize) -> [&'a [T]; 3] {
        [0, 1, 2].map(|k| &data[(i + k) * self.stride..(i + k) * self.stride + self.width + 2])
    }

    /// Sets the frame as far as it depends on row `i`.
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

    /// Sets the cell before and the one after a row.
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

    /// The order in which rows can be made when a row is used as soon as the one after it is there: on a circle the last
    /// row goes first, since it is the one above the first.
    pub fn starts_with_last(&self) -> bool {
        self.ends[0] == Ends::Joined && self.rows > 1
    }
}

/// Some neighbouring cells of a row, handled together; compiles to vector instructions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pack(pub [f32; LANES]);

impl Pack {
    pub const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    pub fn load(from: &[f32], at: usize) -> Self {
        let mut pack = [0.0; LANES];
        pack.copy_from_slice(&from[at..at + LANES]);
        Self(pack)
    }

    #[inline(always)]
    pub fn store(self, to: &mut [f32], at: usize) {
        to[at..at + LANES].copy_from_slice(&self.0);
    }

    /// Where it is positive its reciprocal, elsewhere 0.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self(self.0.map(|x| if x > 0.0 { 1.0 / x } else { 0.0 }))
    }
}

impl Add for Pack {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let mut result = self;
        for k in 0..LANES {
            result.0[k] += other.0[k];
        }
        result
    }
}

impl Sub for Pack {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let mut result = self;
        for k in 0..LANES {
            result.0[k] -= other.0[k];
        }
        result
    }
}

impl Mul for Pack {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut result = self;
        for k in 0..LANES {
            result.0[k] *= other.0[k];
        }
        result
    }
}
