//! Smoothing: two steps of Jacobi's method with the weights of Chebyshev, and residuals.
//!
//! The spectrum of `D^-1 A` lies within 0..2. With these weights, both steps together are the polynomial of degree 2 with the
//! least maximum on `0.5..2`, the part of the spectrum that coarser levels cannot represent. The order of cells does not matter,
//! so whole rows are processed as vectors, and the cycle is symmetric.

use super::around::NineCells;
use super::frame::Frame;
use super::machine::{LANES, Machine, Pack, packs, packs_mut};
use super::stencil::Stencil;

/// Weights of the two smoothing steps: `1 / (1.25 +- 0.75 cos(pi / 4))`.
const STEP_WEIGHTS: [f32; 2] = [0.561_731_2, 1.389_488_2];
/// Weight of a cell's own right-hand side in the result of two steps from zero. With weights `w0` and `w1`, the steps
/// give `(w0 + w1 - w0 w1) D^-1 b + w0 w1 D^-1 (sum of couplings times D^-1 b)`.
const OWN_WEIGHT: f32 = STEP_WEIGHTS[0] + STEP_WEIGHTS[1] - STEP_WEIGHTS[0] * STEP_WEIGHTS[1];
const NEIGHBOR_WEIGHT: f32 = STEP_WEIGHTS[0] * STEP_WEIGHTS[1];

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

impl Stencil {
    /// Takes one smoothing step for row `i`, except for the extra cells at its ends.
    #[inline(always)]
    fn step<M: Machine>(&self, m: M, weight: f32, right: &[f32], from: &[f32], to: &mut [f32], i: usize) {
        let (keep, take) = (m.all(1.0 - weight), m.all(weight));
        let (start, count) = (self.frame.row(i).start, self.frame.width / LANES);
        let nine = NineCells::new(self, from, i);
        let [right, inverse] = [right, &self.inverse].map(|part| packs(part, start, count));
        let to = packs_mut(to, start, count);
        for k in 0..count {
            let sum = nine.sum(m, k) + m.pack(&right[k]);
            (keep * m.pack(&nine.middle[k]) + take * m.pack(&inverse[k]) * sum).store(&mut to[k], 0);
        }
    }

    /// Takes two more smoothing steps from a solution whose frame is not set yet.
    pub fn go_on<M: Machine>(&self, m: M, vectors: &mut Vectors) {
        let Vectors { right, solution, other } = vectors;
        self.frame.finish(solution);
        // The second step for a row follows as soon as the first step is done for the rows next to it. From then on, the first
        // step no longer needs the old values of that row.
        m.run(
            #[inline(always)]
            || {
                for i in self.frame.ahead() {
                    if let Some(i) = i.made {
                        self.step(m, STEP_WEIGHTS[1], right, solution, other, i);
                        self.frame.finish_row(other, i);
                    }
                    if let Some(i) = i.used {
                        self.step(m, STEP_WEIGHTS[0], right, other, solution, i);
                    }
                }
            },
        );
        self.frame.finish(solution);
    }

    /// Takes two smoothing steps from zero, for a right-hand side whose frame is set.
    pub fn begin<M: Machine>(&self, m: M, vectors: &mut Vectors) {
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
        let (own, next) = (m.all(OWN_WEIGHT), m.all(NEIGHBOR_WEIGHT));
        m.run(
            #[inline(always)]
            || {
                for i in 0..self.frame.rows {
                    let (start, count) = (self.frame.row(i).start, self.frame.width / LANES);
                    let nine = NineCells::new(self, other, i);
                    let (inverse, to) = (packs(&self.inverse, start, count), packs_mut(solution, start, count));
                    for k in 0..count {
                        let sum = own * m.pack(&nine.middle[k]) + next * m.pack(&inverse[k]) * nine.sum(m, k);
                        sum.store(&mut to[k], 0);
                    }
                    self.frame.finish_row(solution, i);
                }
            },
        );
    }

    /// Computes row `i` of the residual, including padding.
    pub fn residual<M: Machine>(&self, m: M, right: &[f32], solution: &[f32], i: usize, out: &mut [f32]) {
        m.run(
            #[inline(always)]
            || {
                let (start, count) = (self.frame.row(i).start, self.frame.width / LANES);
                let nine = NineCells::new(self, solution, i);
                let [right, diagonal] = [right, &self.diagonal].map(|part| packs(part, start, count));
                let out = packs_mut(out, 0, count);
                for k in 0..count {
                    let sum = m.pack(&right[k]) + nine.sum(m, k);
                    (sum - m.pack(&diagonal[k]) * m.pack(&nine.middle[k])).store(&mut out[k], 0);
                }
            },
        );
    }
}
