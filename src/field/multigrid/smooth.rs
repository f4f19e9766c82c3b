//! Smoothing: two steps of Jacobi's method with the weights of Chebyshev, and residuals.
//!
//! The spectrum of `D^-1 A` lies within 0..2. The weights make the polynomial of degree 2 that is least on its upper part,
//! `0.5..2`, which coarser levels do not see. No order of cells is involved, so that whole rows are vectors, and the
//! cycle is symmetric.

use super::frame::{Frame, LANES, Pack};
use super::stencil::{FivePoint, Stencil};

/// `1 / (1.25 +- 0.75 cos(pi / 4))`.
const WEIGHTS: [f32; 2] = [0.561_731_2, 1.389_488_2];
/// Both steps from zero: `(w0 + w1 - w0 w1) D^-1 b + w0 w1 D^-1 (sum of couplings times D^-1 b)`.
const OWN: f32 = WEIGHTS[0] + WEIGHTS[1] - WEIGHTS[0] * WEIGHTS[1];
const AROUND: f32 = WEIGHTS[0] * WEIGHTS[1];

/// The vectors of a level.
#[derive(Debug, Clone)]
pub(super) struct Vectors {
    pub right: Vec<f32>,
    pub solution: Vec<f32>,
    pub other: Vec<f32>,
}

impl Vectors {
    pub fn new(frame: Frame) -> Self {
        let zeros = || vec![0.0; frame.len()];
        Self { right: zeros(), solution: zeros(), other: zeros() }
    }
}

/// What a cycle does on a level.
pub(super) trait Smooth {
    /// Two steps from zero, for a right-hand side that has its frame.
    fn from_zero(&self, vectors: &mut Vectors);
    /// Two steps more, from a solution without frame.
    fn again(&self, vectors: &mut Vectors);
    /// Row `i` of the residual, padding included.
    fn residual(&self, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]);
}

impl FivePoint {
    #[inline(always)]
    fn step(&self, weight: f32, right: &[f32], from: &[f32], to: &mut [f32]) {
        let keep = Pack([1.0 - weight; LANES]);
        let take = Pack([weight / self.degree as f32; LANES]);
        for i in 0..self.frame.rows {
            let [above, middle, below] = self.frame.three(from, i);
            let row = self.frame.row(i);
            for j in (0..row.len()).step_by(LANES) {
                let sum = around(above, middle, below, j) + Pack::load(right, row.start + j);
                let free = Pack::load(&self.free, row.start + j);
                (keep * Pack::load(middle, j + 1) + take * free * sum).store(to, row.start + j);
            }
            self.frame.finish_row(to, i);
        }
    }
}

/// Sum over the four neighbours.
#[inline(always)]
fn around(above: &[f32], middle: &[f32], below: &[f32], j: usize) -> Pack {
    (Pack::load(middle, j) + Pack::load(middle, j + 2)) + (Pack::load(above, j + 1) + Pack::load(below, j + 1))
}

impl Smooth for FivePoint {
    fn from_zero(&self, vectors: &mut Vectors) {
        let inverse = 1.0 / self.degree as f32;
        let (own, next) = (Pack([OWN * inverse; LANES]), Pack([AROUND * inverse * inverse; LANES]));
        for i in 0..self.frame.rows {
            let [above, middle, below] = self.frame.three(&vectors.right, i);
            let row = self.frame.row(i);
            for j in (0..row.len()).step_by(LANES) {
                let sum = own * Pack::load(middle, j + 1) + next * around(above, middle, below, j);
                (sum * Pack::load(&self.free, row.start + j)).store(&mut vectors.solution, row.start + j);
            }
            self.frame.finish_row(&mut vectors.solution, i);
        }
    }

    fn again(&self, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        self.frame.finish(solution);
        self.step(WEIGHTS[1], right, solution, other);
        self.step(WEIGHTS[0], right, other, solution);
    }

    #[inline(always)]
    fn residual(&self, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]) {
        let degree = Pack([self.degree as f32; LANES]);
        let [above, middle, below] = self.frame.three(solution, i);
        let row = self.frame.row(i);
        for j in (0..row.len()).step_by(LANES) {
            let sum = Pack::load(right, row.start + j) + around(above, middle, below, j);
            (sum - degree * Pack::load(middle, j + 1)).store(out, j);
        }
    }
}

impl Stencil {
    /// Sum over the eight neighbours of coupling times value.
    #[inline(always)]
    fn around(&self, of: [&[f32]; 3], i: usize, j: usize) -> Pack {
        let [above, middle, below] = of;
        let (at, over) = (self.frame.row(i).start + j, self.frame.above(i) + j);
        let term = |part: &[f32], at: usize, of: &[f32], j: usize| Pack::load(part, at) * Pack::load(of, j);
        (term(&self.east, at, middle, j + 2) + term(&self.east, at - 1, middle, j))
            + (term(&self.south, at, below, j + 1) + term(&self.south, over, above, j + 1))
            + (term(&self.south_east, at, below, j + 2) + term(&self.south_east, over - 1, above, j))
            + (term(&self.south_west, at, below, j) + term(&self.south_west, over + 1, above, j + 2))
    }

    #[inline(always)]
    fn step(&self, weight: f32, right: &[f32], from: &[f32], to: &mut [f32]) {
        let (keep, take) = (Pack([1.0 - weight; LANES]), Pack([weight; LANES]));
        for i in 0..self.frame.rows {
            let of = self.frame.three(from, i);
            let row = self.frame.row(i);
            for j in (0..row.len()).step_by(LANES) {
                let sum = self.around(of, i, j) + Pack::load(right, row.start + j);
                let inverse = Pack::load(&self.inverse, row.start + j);
                (keep * Pack::load(of[1], j + 1) + take * inverse * sum).store(to, row.start + j);
            }
            self.frame.finish_row(to, i);
        }
    }
}

impl Smooth for Stencil {
    fn from_zero(&self, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        for i in 0..self.frame.rows {
            let row = self.frame.row(i);
            for at in row.step_by(LANES) {
                (Pack::load(&self.inverse, at) * Pack::load(right, at)).store(other, at);
            }
            self.frame.finish_row(other, i);
        }
        let (own, next) = (Pack([OWN; LANES]), Pack([AROUND; LANES]));
        for i in 0..self.frame.rows {
            let of = self.frame.three(other, i);
            let row = self.frame.row(i);
            for j in (0..row.len()).step_by(LANES) {
                let inverse = Pack::load(&self.inverse, row.start + j);
                let sum = own * Pack::load(of[1], j + 1) + next * inverse * self.around(of, i, j);
                sum.store(solution, row.start + j);
            }
            self.frame.finish_row(solution, i);
        }
    }

    fn again(&self, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        self.frame.finish(solution);
        self.step(WEIGHTS[1], right, solution, other);
        self.step(WEIGHTS[0], right, other, solution);
    }

    #[inline(always)]
    fn residual(&self, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]) {
        let of = self.frame.three(solution, i);
        let row = self.frame.row(i);
        for j in (0..row.len()).step_by(LANES) {
            let at = row.start + j;
            let sum = Pack::load(right, at) + self.around(of, i, j);
            (sum - Pack::load(&self.diagonal, at) * Pack::load(of[1], j + 1)).store(out, j);
        }
    }
}
