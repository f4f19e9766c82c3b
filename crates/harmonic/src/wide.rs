//! Wide windows: multigrid, refined until every value has its relative precision.
//!
//! A solve leaves an error that is small beside the greatest value. The residual, in contrast, is known at each cell to
//! some roundings of the values *there*: it is a sum of differences of neighbours. So the same solver is asked for the
//! correction again, with the residuals of the cells that are settled already taken as 0: the greatest of the rest, and
//! with it the error, falls by some digits each time, down to the floor, below which nothing is wanted.

use super::extent::Extent;
use super::network::SIDES;
use cplan_multigrid::{Ends, Multigrid, Workspace};

/// Relative residual of a value at which it is precise: half of what walks lose a step
/// ([`LOSS`](super::laplace::LOSS) over four neighbours), so that the loss outweighs it, and many roundings.
const PRECISE: f64 = 64.0 * f64::EPSILON;

/// Relative residual at which a cell asks for no correction, less than [`PRECISE`] by far more than a correction rounds
/// (some 2 units in the last place). If both were the same, each round would lift some of the many cells that lie just
/// below above it, and in windows of 10^5 cells there would be no end to it.
const SETTLED: f64 = PRECISE / 4.0;

/// Unknowns in a box of cells: `(4 + loss) u = source + sum of the neighbours' u`, where cells of the box that are no unknowns count
/// as 0.
#[derive(Debug, Clone)]
pub(super) struct Wide {
    pub extent: Extent,
    /// What is added to the four neighbours.
    loss: f64,
    /// For each place in the box whether it is an unknown.
    free: Vec<bool>,
    /// Sums of known values around the unknowns that have any: the potential, and 1 at what is cut off.
    sources: [Vec<(u32, f64)>; SIDES],
}

/// Both sides for each place in the box; nothing for a side that is 0 everywhere.
pub(super) struct Values([Vec<f64>; SIDES]);

/// Error of a round, relative to the greatest correction: as much as single precision gains in a few steps.
const DIGITS: f64 = 1e-8;

/// Rounds of refinement: each gains some digits of the 36 that there are at the most.
const ROUNDS: usize = 24;

/// The error of the second side, which is not refined: above that of a round.
const SHARE_ERROR: f64 = 1e-7;

impl Wide {
    /// No unknowns yet.
    pub fn new(extent: Extent, loss: f64) -> Self {
        let free = vec![false; extent.cells[0] * extent.cells[1]];
        Self { extent, loss, free, sources: Default::default() }
    }

    /// For each column of row `i` of the grid whether it is an unknown.
    pub fn row_mut(&mut self, i: usize) -> &mut [bool] {
        let columns = self.extent.cells[1];
        let first = (i - self.extent.first[0]) * columns;
        &mut self.free[first..first + columns]
    }

    /// Makes a place in the box an unknown.
    pub fn free(&mut self, at: usize) {
        self.free[at] = true;
    }

    /// Adds known values around an unknown.
    pub fn add(&mut self, at: usize, source: [f64; SIDES]) {
        for (of, source) in self.sources.iter_mut().zip(source) {
            if source != 0.0 {
                of.push((at as u32, source));
            }
        }
    }

    /// Both sides for each place: the first precise down to `floor`, and no farther than to its value at the place `above`, the second within
    /// [`SHARE_ERROR`] of 1. Nothing if the refinement does not get there.
    pub fn solve(&self, floor: f64, above: Option<usize>) -> Option<Values> {
        let inner = Multigrid::new(self.extent.cells, self.extent.ends, &self.free, 0.0);
        let mut workspace = inner.workspace();
        let lowest = |x: &[f64]| above.map_or(floor, |at| x[at].max(floor));
        let u = self.side(0, lowest, ROUNDS, (&inner, &mut workspace))?;
        let e = self.side(1, |_| 1.0, 1, (&inner, &mut workspace))?;
        Some(Values([u, e]))
    }

    /// Both sides for a place in the box; the second from above.
    pub fn at(&self, Values([u, e]): &Values, at: usize) -> [f64; SIDES] {
        [u.get(at).copied().unwrap_or(0.0), e.get(at).copied().unwrap_or(0.0) + SHARE_ERROR]
    }

    /// Values of one side for all places in the box, precise down to the floor that they ask for.
    fn side(
        &self,
        side: usize,
        floor: impl Fn(&[f64]) -> f64,
        rounds: usize,
        (inner, workspace): (&Multigrid, &mut Workspace),
    ) -> Option<Vec<f64>> {
        let sources = &self.sources[side];
        if sources.is_empty() {
            return Some(Vec::new());
        }
        let mut right = written(self.free.len());
        let mut x = written(self.free.len());
        let mut correction = Vec::new();
        spread(sources, &mut right);
        for round in 1..=rounds {
            if round == 1 {
                inner.solve(&right, &mut x, DIGITS, workspace);
            } else {
                correction.clear();
                correction.resize(x.len(), 0.0);
                inner.solve(&right, &mut correction, DIGITS, workspace);
                x.iter_mut().zip(&correction).for_each(|(x, correction)| *x += correction);
            }
            right.fill(0.0);
            spread(sources, &mut right);
            let precise = self.residual(&x, floor(&x), &mut right);
            if precise || (side == 1 && round == rounds) {
                return Some(x);
            }
        }
        None
    }

    /// Puts the residual at `x` in place of the sources, 0 where a value is settled; whether all are precise.
    fn residual(&self, x: &[f64], floor: f64, residual: &mut [f64]) -> bool {
        let Extent { cells: [rows, columns], ends, .. } = self.extent;
        let joined = ends.map(|ends| ends == Ends::Joined);
        let nothing = vec![0.0; columns];
        let row = |i: Option<usize>| i.map_or(&nothing[..], |i| &x[i * columns..(i + 1) * columns]);
        // The row with the cell before and the one after it.
        let mut here = vec![0.0; columns + 2];
        let mut precise = true;
        for i in 0..rows {
            let above = row(i.checked_sub(1).or(joined[0].then_some(rows - 1)));
            let below = row((i + 1 < rows).then_some(i + 1).or(joined[0].then_some(0)));
            here[1..=columns].copy_from_slice(row(Some(i)));
            if joined[1] {
                (here[0], here[columns + 1]) = (here[columns], here[1]);
            }
            let range = i * columns..(i + 1) * columns;
            let beside = here.windows(3).zip(above).zip(below);
            let known = self.free[range.clone()].iter().zip(&mut residual[range]);
            for (((three, above), below), (&free, to)) in beside.zip(known) {
                let at = three[1];
                let around = (above - at) + (below - at) + (three[0] - at) + (three[2] - at);
                let left = if free { around + (*to - self.loss * at) } else { 0.0 };
                let scale = 4.0 * (at + floor);
                precise &= left.abs() <= PRECISE * scale;
                *to = if left.abs() <= SETTLED * scale { 0.0 } else { left };
            }
        }
        precise
    }
}

/// Zeros that are in memory: what comes as zero pages of the system and is read before it is written is mapped twice.
fn written(len: usize) -> Vec<f64> {
    let mut zeros = Vec::with_capacity(len);
    zeros.resize(len, 0.0);
    zeros
}

/// Adds sources to where they are.
fn spread(sources: &[(u32, f64)], to: &mut [f64]) {
    sources.iter().for_each(|&(at, source)| to[at as usize] += source);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight corridor between walls with 1 at its near end, where the potential is the sum of
    /// `sin(k pi i / (w + 1)) sinh(theta_k (n + 1 - j)) / sinh(theta_k (n + 1))` and far away the first of them alone.
    #[test]
    fn a_long_wide_corridor_is_precise_to_its_far_end() {
        let (w, n) = (50, 1500);
        let mut wide = Wide::new(Extent { first: [0; 2], cells: [w, n], ends: [Ends::High; 2] }, 0.0);
        (0..w * n).for_each(|at| wide.free(at));
        (0..w).for_each(|row| wide.add(row * n, [1.0, 0.0]));
        let values = wide.solve(1e-60, None).expect("precise within the rounds that there are");
        let beta = std::f64::consts::PI / (w + 1) as f64;
        let theta = (2.0 - beta.cos()).acosh();
        let at = |j: usize| wide.at(&values, w / 2 * n + j)[0];
        for (near, far) in [(600, 800), (800, 1200), (1200, 1499)] {
            let fall = |j: usize| (theta * (n - j) as f64).sinh();
            let (expected, found) = (fall(far) / fall(near), at(far) / at(near));
            assert!((found / expected - 1.0).abs() < 1e-9, "{near} to {far}: {found:e}, expected {expected:e}");
        }
    }
}
