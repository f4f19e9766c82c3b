//! Wide windows: multigrid, refined until every value has its relative precision.
//!
//! A solve leaves an error that is small beside the greatest value. The residual, in contrast, is known at each cell to
//! some roundings of the values *there*: it is a sum of differences of neighbours. So the same solver is asked for the
//! correction again, with the residuals of the cells that are settled already taken as 0: the greatest of the rest, and
//! with it the error, falls by some digits each time, down to the floor, below which nothing is wanted.

use super::network::SIDES;
use crate::field::multigrid::{Ends, Multigrid, Workspace};

/// No unknown.
pub(super) const NONE: u32 = u32::MAX;

/// Relative residual of a value at which it is precise: half of what walks lose a step
/// ([`LOSS`](super::laplace::LOSS) over four neighbours), so that the loss outweighs it, and many roundings.
const PRECISE: f64 = 64.0 * f64::EPSILON;

/// Relative residual at which a cell asks for no correction, less than [`PRECISE`] by far more than a correction rounds
/// (some 2 units in the last place). If both were the same, each round would lift some of the many cells that lie just
/// below above it, and in windows of 10^5 cells there would be no end to it.
const SETTLED: f64 = PRECISE / 4.0;

/// Unknowns of a window: `(ground + number of neighbours) u = source + sum of the neighbours' u`.
#[derive(Debug, Clone)]
pub(super) struct Wide {
    /// Rows and columns of the box that holds the window.
    pub cells: [usize; 2],
    /// What is beyond the box: nothing, or its other end on a circle.
    pub ends: [Ends; 2],
    /// Where in the box each unknown is.
    pub place: Vec<u32>,
    /// Numbers of the neighbouring unknowns, or [`NONE`].
    pub neighbors: Vec<[u32; 4]>,
    /// Neighbours that are known, and loss.
    pub ground: Vec<f64>,
    /// Sums of known values: the potential, and 1 at what is cut off.
    pub source: Vec<[f64; SIDES]>,
}

/// Error of a round, relative to the greatest correction: as much as single precision gains in a few steps.
const DIGITS: f64 = 1e-8;

/// Rounds of refinement: each gains some digits of the 36 that there are at the most.
const ROUNDS: usize = 24;

/// The error of the second side, which is not refined: above that of a round.
const SHARE_ERROR: f64 = 1e-7;

impl Wide {
    /// No unknowns yet.
    pub fn new(cells: [usize; 2], ends: [Ends; 2]) -> Self {
        Self { cells, ends, place: Vec::new(), neighbors: Vec::new(), ground: Vec::new(), source: Vec::new() }
    }

    fn area(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    fn free(&self) -> Vec<bool> {
        let mut free = vec![false; self.area()];
        self.place.iter().for_each(|&place| free[place as usize] = true);
        free
    }

    /// Both sides: the first precise down to `floor`, the second from above, within [`SHARE_ERROR`] of 1. Nothing if the
    /// refinement does not get there.
    pub fn solve(&self, floor: f64) -> Option<Vec<[f64; SIDES]>> {
        let inner = Multigrid::new(self.cells, self.ends, &self.free(), 0.0);
        let mut workspace = inner.workspace();
        let u = self.side(&inner, &mut workspace, 0, floor, ROUNDS)?;
        let e = self.side(&inner, &mut workspace, 1, 1.0, 1)?;
        Some(u.into_iter().zip(e).map(|(u, e)| [u, e + SHARE_ERROR]).collect())
    }

    fn side(
        &self,
        inner: &Multigrid,
        workspace: &mut Workspace,
        side: usize,
        floor: f64,
        rounds: usize,
    ) -> Option<Vec<f64>> {
        let source: Vec<f64> = self.source.iter().map(|source| source[side]).collect();
        let mut x = vec![0.0; source.len()];
        if source.iter().all(|&s| s == 0.0) {
            return Some(x);
        }
        let mut residual = source.clone();
        let (mut right, mut correction) = (vec![0.0; self.area()], vec![0.0; self.area()]);
        for round in 1..=rounds {
            right.fill(0.0);
            correction.fill(0.0);
            self.place.iter().zip(&residual).for_each(|(&place, r)| right[place as usize] = *r);
            inner.solve(&right, &mut correction, DIGITS, workspace);
            x.iter_mut().zip(&self.place).for_each(|(x, &place)| *x += correction[place as usize]);
            let mut precise = true;
            for i in 0..x.len() {
                let at = x[i];
                let around = self.neighbors[i].iter().filter(|&&n| n != NONE);
                residual[i] = around.map(|&n| x[n as usize] - at).sum::<f64>() + (source[i] - self.ground[i] * at);
                let scale = 4.0 * (at + floor);
                precise &= residual[i].abs() <= PRECISE * scale;
                if residual[i].abs() <= SETTLED * scale {
                    residual[i] = 0.0;
                }
            }
            if precise || (side == 1 && round == rounds) {
                return Some(x);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight corridor between walls with 1 at its near end, where the potential is the sum of
    /// `sin(k pi i / (w + 1)) sinh(theta_k (n + 1 - j)) / sinh(theta_k (n + 1))` and far away the first of them alone.
    #[test]
    fn a_long_wide_corridor_is_precise_to_its_far_end() {
        let (w, n) = (50, 1500);
        let mut wide = Wide::new([w, n], [Ends::High; 2]);
        for at in 0..w * n {
            let (i, j) = (at / n, at % n);
            let number = |there: bool, to: usize| if there { to as u32 } else { NONE };
            let around =
                [(i > 0, at.wrapping_sub(n)), (i + 1 < w, at + n), (j > 0, at.wrapping_sub(1)), (j + 1 < n, at + 1)];
            let around = around.map(|(there, to)| number(there, to));
            wide.place.push(at as u32);
            wide.ground.push(around.iter().filter(|&&to| to == NONE).count() as f64);
            wide.source.push([f64::from(u8::from(j == 0)), 0.0]);
            wide.neighbors.push(around);
        }
        let solution = wide.solve(1e-60).expect("precise within the rounds that there are");
        let beta = std::f64::consts::PI / (w + 1) as f64;
        let theta = (2.0 - beta.cos()).acosh();
        let at = |j: usize| solution[w / 2 * n + j][0];
        for (near, far) in [(600, 800), (800, 1200), (1200, 1499)] {
            let fall = |j: usize| (theta * (n - j) as f64).sinh();
            let (expected, found) = (fall(far) / fall(near), at(far) / at(near));
            assert!((found / expected - 1.0).abs() < 1e-9, "{near} to {far}: {found:e}, expected {expected:e}");
        }
    }
}
