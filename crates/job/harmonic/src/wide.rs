//! Solves wide windows by multigrid, and refines the solution until every value has its relative precision.
//!
//! A solve leaves an error that is small compared with the greatest value. The residual, in contrast, is accurate to a few
//! roundings of the values *at the cell*, because it is a sum of differences of neighbours. So the same solver computes further
//! corrections, with zero residuals at cells that are already settled. Each round lowers the greatest remaining residual, and
//! with it the error, by several digits, down to a floor.

use super::extent::Extent;
use super::network::RIGHT_SIDES;
use cplan_multigrid::{Ends, Multigrid, Workspace};

/// A value is precise if its relative residual is below this. A walk loses a quarter of [`WALK_LOSS`](super::laplace::WALK_LOSS)
/// per step. This is half of that, so the loss exceeds the residual, and many times the rounding error.
const PRECISE_RESIDUAL: f64 = 64.0 * f64::EPSILON;

/// A cell with a smaller relative residual needs no correction. The rounding error of a correction is about 2 units in the last
/// place, far less than the difference from [`PRECISE_RESIDUAL`]. If both limits were equal, each round would move some of the
/// many cells just below the limit across it, and windows of 10^5 cells would never converge.
const SETTLED_RESIDUAL: f64 = PRECISE_RESIDUAL / 4.0;

/// The equations `(4 + loss) u = source + sum of the neighbours' u` for the unknowns in a box of cells. Other cells of
/// the box count as 0.
#[derive(Debug, Clone)]
pub(super) struct WideSystem {
    pub extent: Extent,
    /// Weight with which a walk ends at each step; each neighbour has the weight 1.
    loss: f64,
    /// True at the places in the box that are unknowns.
    free: Vec<bool>,
    /// The known values that enter the equations. An entry has an unknown next to known values, and a sum over these neighbours:
    /// in the first list, the sum of their potentials; in the second, the number of neighbours beyond the cut of the window.
    sources: [Vec<(u32, f64)>; RIGHT_SIDES],
}

/// The solutions for both right-hand sides at each place in the box. An empty list stands for zeros everywhere.
pub(super) struct Values([Vec<f64>; RIGHT_SIDES]);

/// A round solves up to this error, relative to the greatest correction. In single precision, this takes a few steps.
const ROUND_ERROR: f64 = 1e-8;

/// Largest number of rounds of refinement. Each gains several digits, and at most 36 are needed.
const MAX_ROUNDS: usize = 24;

/// Assumed error of the solution for the second right-hand side, which is not refined. It exceeds the error of a round.
const SHARE_ERROR: f64 = 1e-7;

impl WideSystem {
    /// Creates a box without unknowns.
    pub fn new(extent: Extent, loss: f64) -> Self {
        let free = vec![false; extent.cells[0] * extent.cells[1]];
        Self { extent, loss, free, sources: Default::default() }
    }

    /// Returns the flags of row `i` of the grid, by column: true for unknowns.
    pub fn row_mut(&mut self, i: usize) -> &mut [bool] {
        let columns = self.extent.cells[1];
        let first = (i - self.extent.first[0]) * columns;
        &mut self.free[first..first + columns]
    }

    /// Makes a place in the box an unknown.
    pub fn free(&mut self, at: usize) {
        self.free[at] = true;
    }

    /// Adds known values next to an unknown.
    pub fn add(&mut self, at: usize, source: [f64; RIGHT_SIDES]) {
        for (of, source) in self.sources.iter_mut().zip(source) {
            if source != 0.0 {
                of.push((at as u32, source));
            }
        }
    }

    /// Solves for both right-hand sides. The first solution is precise down to `floor`, or down to its value at the place `above`
    /// if that is given and greater. The second has an absolute error of at most [`SHARE_ERROR`]. `None` if the refinement does
    /// not converge.
    pub fn solve(&self, floor: f64, above: Option<usize>) -> Option<Values> {
        let inner = Multigrid::new(self.extent.cells, self.extent.ends, &self.free, 0.0);
        let mut workspace = inner.workspace();
        let lowest = |x: &[f64]| above.map_or(floor, |at| x[at].max(floor));
        let u = self.side(0, lowest, MAX_ROUNDS, (&inner, &mut workspace))?;
        let e = self.side(1, |_| 1.0, 1, (&inner, &mut workspace))?;
        Some(Values([u, e]))
    }

    /// Returns both solutions at a place in the box. The second is an upper bound.
    pub fn at(&self, Values([u, e]): &Values, at: usize) -> [f64; RIGHT_SIDES] {
        [u.get(at).copied().unwrap_or(0.0), e.get(at).copied().unwrap_or(0.0) + SHARE_ERROR]
    }

    /// Solves for one right-hand side, at all places in the box. The solution is precise down to `floor`. `None` if the
    /// refinement does not converge.
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
                inner.solve(&right, &mut x, ROUND_ERROR, workspace);
            } else {
                correction.clear();
                correction.resize(x.len(), 0.0);
                inner.solve(&right, &mut correction, ROUND_ERROR, workspace);
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

    /// Computes the residual of the solution `x`, with 0 at values that need no correction. Returns true if all values are
    /// precise.
    fn residual(&self, x: &[f64], floor: f64, residual: &mut [f64]) -> bool {
        let Extent { cells: [rows, columns], ends, .. } = self.extent;
        let joined = ends.map(|ends| ends == Ends::Joined);
        let nothing = vec![0.0; columns];
        let row = |i: Option<usize>| i.map_or(&nothing[..], |i| &x[i * columns..(i + 1) * columns]);
        // The row, with one more cell at either end.
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
                precise &= left.abs() <= PRECISE_RESIDUAL * scale;
                *to = if left.abs() <= SETTLED_RESIDUAL * scale { 0.0 } else { left };
            }
        }
        precise
    }
}

/// Returns a list of zeros that has been written once. If memory is read before it is written, the system maps its pages twice.
fn written(len: usize) -> Vec<f64> {
    let mut zeros = Vec::with_capacity(len);
    zeros.resize(len, 0.0);
    zeros
}

/// Adds the sources to the right-hand side at their places.
fn spread(sources: &[(u32, f64)], to: &mut [f64]) {
    sources.iter().for_each(|&(at, source)| to[at as usize] += source);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks a straight corridor between walls with the value 1 at its near end. Its potential is the sum of
    /// `sin(k pi i / (w + 1)) sinh(theta_k (n + 1 - j)) / sinh(theta_k (n + 1))` over `k`, of which only the first term matters
    /// far away.
    #[test]
    fn a_long_wide_corridor_is_precise_to_its_far_end() {
        let (w, n) = (50, 1500);
        let mut wide = WideSystem::new(Extent { first: [0; 2], cells: [w, n], ends: [Ends::High; 2] }, 0.0);
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
