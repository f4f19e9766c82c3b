//! The cells of a grid in two colours, as on a chessboard. Each colour has its own array.
//!
//! Neighbours have different colours. So the odd cells, for which row plus column is odd, depend only on even cells and can be
//! eliminated, which leaves a system for half of the cells. In row `i`, even cell `j` is in column `2 j + i mod 2`, and odd cell
//! `j` is in column `2 j + 1 - i mod 2`. The neighbours of cell `j` in the rows above and below also have the number `j`. Its two
//! neighbours in the same row have the numbers `j`, and `j - 1` or `j + 1`.
//!
//! If a limit reflects, or a circle has an odd number of cells, some neighbours have the same colour. The frame of the odd cells
//! has the values of even neighbours of even cells. Two odd neighbours are eliminated together ([`RedBlack::settle`]).

use super::band::{Band, STAGES};
use super::frame::Ends;
use super::machine::LANES;

/// A number in single or double precision.
pub(super) trait Real: Copy + Default + Into<f64> {
    fn of(x: f64) -> Self;
}

impl Real for f32 {
    fn of(x: f64) -> Self {
        x as f32
    }
}

impl Real for f64 {
    fn of(x: f64) -> Self {
        x
    }
}

/// Shape and boundary of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    pub rows: usize,
    pub columns: usize,
    ends: [Ends; 2],
}

/// The five-point operator of the free cells, by colour.
#[derive(Debug, Clone)]
pub(super) struct RedBlack {
    pub shape: Shape,
    /// Diagonal coefficient, `4 + shift`, of cells that are not at reflecting ends.
    pub degree: f64,
    /// For each even cell, 1 if it is free and 0 otherwise.
    pub even: Band<f32>,
    pub odd: Band<f32>,
}

impl RedBlack {
    pub fn new([rows, columns]: [usize; 2], ends: [Ends; 2], free: &[bool], degree: f64) -> Self {
        let width = columns.div_ceil(2).next_multiple_of(LANES);
        let band = || Band::new(width, rows + 2);
        let mut new = Self { shape: Shape { rows, columns, ends }, degree, even: band(), odd: band() };
        for (i, free) in free.chunks_exact(columns.max(1)).enumerate() {
            let [even, odd] = new.halves(i);
            for (j, pair) in free.chunks(2).enumerate() {
                even[j] = f32::from(u8::from(pair[0]));
                if let Some(&free) = pair.get(1) {
                    odd[j] = f32::from(u8::from(free));
                }
            }
        }
        new
    }

    /// Returns the flags of row `i`, split into even and odd columns.
    fn halves(&mut self, i: usize) -> [&mut [f32]; 2] {
        let halves = [self.even.cells_mut(i), self.odd.cells_mut(i)];
        if i.is_multiple_of(2) {
            halves
        } else {
            let [a, b] = halves;
            [b, a]
        }
    }

    /// Returns the largest number of cells of one colour in a row.
    fn half(&self) -> usize {
        self.shape.columns.div_ceil(2)
    }

    /// Returns the number of packs in a row of one colour.
    pub fn count(&self) -> usize {
        self.even.width / LANES
    }

    /// Allocates a band of all rows.
    pub fn band<T: Copy + Default>(&self) -> Band<T> {
        Band::new(self.even.width, self.shape.rows + 2)
    }

    /// Allocates a band with only the rows that one stage of a [`pipeline`](Self::pipeline) passes to the next; on a circle, with
    /// all rows.
    pub fn narrow_band<T: Copy + Default>(&self) -> Band<T> {
        let kept = if self.shape.ends[0] == Ends::Joined { self.shape.rows + 2 } else { STAGES + 1 };
        Band::new(self.even.width, kept)
    }

    /// Calls `stage(s, i)` for all stages `s` (at most [`STAGES`]) and all rows `i`: as soon as the previous stage is done for
    /// row `i` and the rows next to it, while these are still in the cache. If the rows form a circle, each stage is done for all
    /// rows before the next one begins.
    #[inline(always)]
    pub fn pipeline(&self, stages: usize, mut stage: impl FnMut(usize, usize)) {
        if self.shape.ends[0] == Ends::Joined {
            for s in 0..stages {
                // The closure of an iterator would not be inlined.
                for i in 0..self.shape.rows {
                    stage(s, i);
                }
            }
            return;
        }
        for ahead in 0..self.shape.rows + stages - 1 {
            for s in 0..stages.min(ahead + 1) {
                if ahead - s < self.shape.rows {
                    stage(s, ahead - s);
                }
            }
        }
    }

    /// Returns the parity of the number of cells along an axis that is a circle. If it is odd, neighbours across the seam have
    /// the same colour. `None` for an interval.
    fn joined(&self, axis: usize) -> Option<Parity> {
        let odd = [self.shape.rows, self.shape.columns][axis] % 2 == 1;
        (self.shape.ends[axis] == Ends::Joined).then_some(if odd { Parity::Odd } else { Parity::Even })
    }

    /// Sets those extra cells of the even cells' band that depend on row `i`.
    #[inline(always)]
    pub fn frame_even<T: Real>(&self, band: &mut Band<T>, i: usize) {
        let (at, half) = (band.start(i), self.half());
        let joined = self.joined(1) == Some(Parity::Even);
        let [first, last] = [band.data[at], band.data[at + half - 1]];
        (band.data[at - 1], band.data[at + half]) = if joined { (last, first) } else { (T::default(), T::default()) };
        let joined = self.joined(0) == Some(Parity::Even);
        self.rows_beyond(band, i, |band, from, to| match joined {
            true => band.data.copy_within(from - 1..from + band.width + 1, to - 1),
            false => band.data[to - 1..to + band.width + 1].fill(T::default()),
        });
    }

    /// Sets those extra cells of the odd cells' band that depend on row `i`. Where an even cell has even neighbours, at seams and
    /// reflecting limits, the extra cells have the values of these neighbours, so that sums over neighbours are correct there,
    /// too.
    #[inline(always)]
    pub fn frame_odd<T: Real, U: Real + Into<T>>(&self, band: &mut Band<T>, even: &Band<U>, i: usize) {
        let (at, half) = (band.start(i), self.half());
        let even_at = even.start(i);
        let [first, last] = [even.data[even_at], even.data[even_at + half - 1]].map(Into::into);
        let across = i.is_multiple_of(2) && self.shape.columns % 2 == 1;
        match self.shape.ends[1] {
            Ends::High => (band.data[at - 1], band.data[at + half]) = (T::default(), T::default()),
            Ends::Joined if self.shape.columns.is_multiple_of(2) => {
                (band.data[at - 1], band.data[at + half]) = (band.data[at + half - 1], band.data[at]);
            }
            ends => {
                // The extra cells before and after the row. Only the even cells at its ends use them.
                let (before, after) = if ends == Ends::Joined { (last, first) } else { (first, last) };
                band.data[at - 1] = before;
                band.data[at + half] = after;
                if across {
                    band.data[at + half - 1] = after;
                }
            }
        }
        match self.joined(0) {
            Some(Parity::Even) => self.rows_beyond(band, i, |band, from, to| {
                band.data.copy_within(from - 1..from + band.width + 1, to - 1);
            }),
            Some(Parity::Odd) if i + 1 == self.shape.rows => {
                for (to, from) in [(band.above(0), even.start(i)), (band.below(i), even.start(0))] {
                    copy(&even.data[from..from + band.width], &mut band.data[to..to + band.width]);
                }
            }
            Some(Parity::Odd) => {}
            None => {
                let reflecting = self.shape.ends[0] == Ends::Reflecting;
                for (at_end, to) in [(i == 0, band.above(i)), (i + 1 == self.shape.rows, band.below(i))] {
                    if at_end && reflecting {
                        copy(&even.data[even_at..even_at + band.width], &mut band.data[to..to + band.width]);
                    } else if at_end {
                        band.data[to..to + band.width].fill(T::default());
                    }
                }
            }
        }
    }

    /// Calls `set` for each extra row that depends on row `i`, with the starts of row `i` and of the extra row.
    #[inline(always)]
    fn rows_beyond<T: Real>(&self, band: &mut Band<T>, i: usize, mut set: impl FnMut(&mut Band<T>, usize, usize)) {
        let from = band.start(i);
        let joined = self.shape.ends[0] == Ends::Joined;
        if i == 0 {
            let to = if joined { band.below(self.shape.rows - 1) } else { band.above(0) };
            set(band, from, to);
        }
        if i + 1 == self.shape.rows {
            let to = if joined { band.above(0) } else { band.below(i) };
            set(band, from, to);
        }
    }

    /// Returns how many times a cell is its own neighbour along an axis: at a reflecting limit, or on a circle of one
    /// cell.
    fn own(&self, axis: usize, at: usize) -> f64 {
        let cells = [self.shape.rows, self.shape.columns][axis];
        match self.shape.ends[axis] {
            Ends::High => 0.0,
            Ends::Reflecting => f64::from(u8::from(at == 0) + u8::from(at + 1 == cells)),
            Ends::Joined => {
                if cells == 1 {
                    2.0
                } else {
                    0.0
                }
            }
        }
    }

    /// Computes the solution at the odd cells of row `i`. Before, the band has their right-hand sides divided by the degree.
    #[inline(always)]
    pub fn settle<T: Real, U: Real + Into<T>>(&self, band: &mut Band<T>, even: &Band<U>, i: usize) {
        if self.shape.ends != [Ends::High; 2] {
            self.settle_ends(band, i);
        }
        self.frame_odd(band, even, i);
        if self.joined(0) == Some(Parity::Odd) && self.shape.rows > 1 && i + 1 == self.shape.rows {
            self.settle_seam(band);
            self.frame_odd(band, even, 0);
            self.frame_odd(band, even, i);
        }
    }

    fn settle_ends<T: Real>(&self, band: &mut Band<T>, i: usize) {
        let scale = |x: &mut T, by: f64| *x = T::of((*x).into() * by);
        let at = band.start(i);
        let mut diagonal = self.degree;
        let own = self.own(0, i);
        if own > 0.0 {
            let by = diagonal / (diagonal - own);
            band.cells_mut(i).iter_mut().for_each(|x| scale(x, by));
            diagonal -= own;
        }
        let last = self.shape.columns - 1;
        for column in [0, last] {
            let own = self.own(1, column);
            if own > 0.0 && (column + i) % 2 == 1 {
                scale(&mut band.data[at + column / 2], diagonal / (diagonal - own));
            }
            if last == 0 {
                break;
            }
        }
        if self.joined(1) == Some(Parity::Odd) && i % 2 == 1 && last > 0 {
            let [a, b] = [at, at + last / 2];
            (band.data[a], band.data[b]) =
                solve_coupled_pair(diagonal, [band.data[a], band.data[b]], self.free([i, 0]) && self.free([i, last]));
        }
    }

    /// Solves for the odd cells of the first and the last row, which are neighbours.
    fn settle_seam<T: Real>(&self, band: &mut Band<T>) {
        let last = self.shape.rows - 1;
        for column in (1..self.shape.columns).step_by(2) {
            let [a, b] = [0, last].map(|i| band.start(i) + column / 2);
            let diagonal = self.degree - self.own(1, column);
            (band.data[a], band.data[b]) = solve_coupled_pair(
                diagonal,
                [band.data[a], band.data[b]],
                self.free([0, column]) && self.free([last, column]),
            );
        }
    }

    /// Returns true if a cell is free.
    fn free(&self, [i, j]: [usize; 2]) -> bool {
        let band = if (i + j) % 2 == 0 { &self.even } else { &self.odd };
        band.data[band.start(i) + j / 2] > 0.0
    }

    pub fn is_free(&self, cell: usize) -> bool {
        self.free([cell / self.shape.columns, cell % self.shape.columns])
    }

    /// Iterates over the neighbours of a cell.
    pub fn neighbors(&self, cell: usize) -> impl Iterator<Item = usize> + use<'_> {
        let place = [cell / self.shape.columns, cell % self.shape.columns];
        let cells = [self.shape.rows, self.shape.columns];
        [(0, false), (0, true), (1, false), (1, true)].into_iter().filter_map(move |(axis, forward)| {
            let mut place = place;
            let at = &mut place[axis];
            let last = cells[axis] - 1;
            *at = match (self.shape.ends[axis], forward) {
                (_, true) if *at < last => *at + 1,
                (_, false) if *at > 0 => *at - 1,
                (Ends::High, _) => return None,
                (Ends::Reflecting, _) => *at,
                (Ends::Joined, forward) => {
                    if forward {
                        0
                    } else {
                        last
                    }
                }
            };
            Some(place[0] * self.shape.columns + place[1])
        })
    }
}

/// The parity of the number of cells of a circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Parity {
    Even,
    Odd,
}

/// Solves for two neighbouring odd cells, given the value that each would have if the other were 0. If `both` is false, these
/// values are the result.
fn solve_coupled_pair<T: Real>(diagonal: f64, alone: [T; 2], both: bool) -> (T, T) {
    if !both {
        return alone.into();
    }
    let [a, b] = alone.map(Into::<f64>::into);
    let by = diagonal / (diagonal * diagonal - 1.0);
    (T::of((diagonal * a + b) * by), T::of((diagonal * b + a) * by))
}

fn copy<T, U: Copy + Into<T>>(from: &[U], to: &mut [T]) {
    to.iter_mut().zip(from).for_each(|(to, &from)| *to = from.into());
}
