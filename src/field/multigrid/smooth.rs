//! Smoothing: two steps of Jacobi's method with the weights of Chebyshev, and residuals.
//!
//! The spectrum of `D^-1 A` lies within 0..2. The weights make the polynomial of degree 2 that is least on its upper part,
//! `0.5..2`, which coarser levels do not see. No order of cells is involved, so that whole rows are vectors, and the
//! cycle is symmetric.

use super::frame::Frame;
use super::machine::{LANES, Machine, Pack};
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
    fn from_zero<M: Machine>(&self, m: M, vectors: &mut Vectors);
    /// Two steps more, from a solution without frame.
    fn again<M: Machine>(&self, m: M, vectors: &mut Vectors);
    /// Row `i` of the residual, padding included.
    fn residual<M: Machine>(&self, m: M, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]);
}

impl FivePoint {
    fn step<M: Machine>(&self, m: M, weight: f32, right: &[f32], from: &[f32], to: &mut [f32]) {
        let keep = m.all(1.0 - weight);
        let take = m.all(weight / self.degree as f32);
        m.run(
            #[inline(always)]
            || {
                for i in 0..self.frame.rows {
                    let [above, middle, below] = self.frame.three(from, i);
                    let row = self.frame.row(i);
                    for j in (0..row.len()).step_by(LANES) {
                        let sum = around(m, above, middle, below, j) + m.load(right, row.start + j);
                        let free = m.load(&self.free, row.start + j);
                        (keep * m.load(middle, j + 1) + take * free * sum).store(to, row.start + j);
                    }
                    self.frame.finish_row(to, i);
                }
            },
        );
    }
}

/// Sum over the four neighbours.
#[inline(always)]
fn around<M: Machine>(m: M, above: &[f32], middle: &[f32], below: &[f32], j: usize) -> M::Single {
    (m.load(middle, j) + m.load(middle, j + 2)) + (m.load(above, j + 1) + m.load(below, j + 1))
}

impl Smooth for FivePoint {
    fn from_zero<M: Machine>(&self, m: M, vectors: &mut Vectors) {
        let inverse = 1.0 / self.degree as f32;
        let (own, next) = (m.all(OWN * inverse), m.all(AROUND * inverse * inverse));
        m.run(
            #[inline(always)]
            || {
                for i in 0..self.frame.rows {
                    let [above, middle, below] = self.frame.three(&vectors.right, i);
                    let row = self.frame.row(i);
                    for j in (0..row.len()).step_by(LANES) {
                        let sum = own * m.load(middle, j + 1) + next * around(m, above, middle, below, j);
                        (sum * m.load(&self.free, row.start + j)).store(&mut vectors.solution, row.start + j);
                    }
                    self.frame.finish_row(&mut vectors.solution, i);
                }
            },
        );
    }

    fn again<M: Machine>(&self, m: M, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        self.frame.finish(solution);
        self.step(m, WEIGHTS[1], right, solution, other);
        self.step(m, WEIGHTS[0], right, other, solution);
    }

    fn residual<M: Machine>(&self, m: M, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]) {
        let degree = m.all(self.degree as f32);
        let [above, middle, below] = self.frame.three(solution, i);
        let row = self.frame.row(i);
        m.run(
            #[inline(always)]
            || {
                for j in (0..row.len()).step_by(LANES) {
                    let sum = m.load(right, row.start + j) + around(m, above, middle, below, j);
                    (sum - degree * m.load(middle, j + 1)).store(out, j);
                }
            },
        );
    }
}

impl Stencil {
    /// Sum over the eight neighbours of coupling times value.
    #[inline(always)]
    fn around<M: Machine>(&self, m: M, of: [&[f32]; 3], i: usize, j: usize) -> M::Single {
        let [above, middle, below] = of;
        let (at, over) = (self.frame.row(i).start + j, self.frame.above(i) + j);
        (m.load(&self.east, at) * m.load(middle, j + 2) + m.load(&self.east, at - 1) * m.load(middle, j))
            + (m.load(&self.south, at) * m.load(below, j + 1) + m.load(&self.south, over) * m.load(above, j + 1))
            + (m.load(&self.south_east, at) * m.load(below, j + 2)
                + m.load(&self.south_east, over - 1) * m.load(above, j))
            + (m.load(&self.south_west, at) * m.load(below, j)
                + m.load(&self.south_west, over + 1) * m.load(above, j + 2))
    }

    fn step<M: Machine>(&self, m: M, weight: f32, right: &[f32], from: &[f32], to: &mut [f32]) {
        let (keep, take) = (m.all(1.0 - weight), m.all(weight));
        m.run(
            #[inline(always)]
            || {
                for i in 0..self.frame.rows {
                    let of = self.frame.three(from, i);
                    let row = self.frame.row(i);
                    for j in (0..row.len()).step_by(LANES) {
                        let sum = self.around(m, of, i, j) + m.load(right, row.start + j);
                        let inverse = m.load(&self.inverse, row.start + j);
                        (keep * m.load(of[1], j + 1) + take * inverse * sum).store(to, row.start + j);
                    }
                    self.frame.finish_row(to, i);
                }
            },
        );
    }
}

impl Smooth for Stencil {
    fn from_zero<M: Machine>(&self, m: M, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        m.run(
            #[inline(always)]
            || {
                for i in 0..self.frame.rows {
                    let row = self.frame.row(i);
                    for at in row.step_by(LANES) {
                        (m.load(&self.inverse, at) * m.load(right, at)).store(other, at);
                    }
                    self.frame.finish_row(other, i);
                }
            },
        );
        let (own, next) = (m.all(OWN), m.all(AROUND));
        m.run(
            #[inline(always)]
            || {
                for i in 0..self.frame.rows {
                    let of = self.frame.three(other, i);
                    let row = self.frame.row(i);
                    for j in (0..row.len()).step_by(LANES) {
                        let inverse = m.load(&self.inverse, row.start + j);
                        let sum = own * m.load(of[1], j + 1) + next * inverse * self.around(m, of, i, j);
                        sum.store(solution, row.start + j);
                    }
                    self.frame.finish_row(solution, i);
                }
            },
        );
    }

    fn again<M: Machine>(&self, m: M, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        self.frame.finish(solution);
        self.step(m, WEIGHTS[1], right, solution, other);
        self.step(m, WEIGHTS[0], right, other, solution);
    }

    fn residual<M: Machine>(&self, m: M, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]) {
        let of = self.frame.three(solution, i);
        let row = self.frame.row(i);
        m.run(
            #[inline(always)]
            || {
                for j in (0..row.len()).step_by(LANES) {
                    let at = row.start + j;
                    let sum = m.load(right, at) + self.around(m, of, i, j);
                    (sum - m.load(&self.diagonal, at) * m.load(of[1], j + 1)).store(out, j);
                }
            },
        );
    }
}
