//! Wide windows: an iterative solver, refined until every value has its relative precision.

use super::multigrid::{Ends, Multigrid, Workspace};
use super::network::SIDES;

/// No unknown.
pub(super) const NONE: u32 = u32::MAX;

/// Relative residual of a value at which it is precise: some roundings of the sum of four neighbours.
const PRECISE: f64 = 16.0 * f64::EPSILON;

/// Unknowns of a window: `(ground + number of neighbours) u = source + sum of the neighbours' u`.
#[derive(Debug, Clone)]
pub(super) struct Wide {
    pub cells: [usize; 2],
    pub ends: [Ends; 2],
    pub place: Vec<u32>,
    pub neighbors: Vec<[u32; 4]>,
    pub ground: Vec<f64>,
    pub source: Vec<[f64; SIDES]>,
}

/// Tolerance of a round.
const DIGITS: f64 = 1e-8;

/// Rounds of refinement.
const ROUNDS: usize = 24;

impl Wide {
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

    pub fn solve(&self, floor: f64) -> Option<Vec<[f64; SIDES]>> {
        let inner = Multigrid::new(self.cells, self.ends, &self.free(), 0.0);
        let mut workspace = inner.workspace();
        let u = self.side(&inner, &mut workspace, 0, floor, ROUNDS)?;
        let e = self.side(&inner, &mut workspace, 1, 1.0, 1)?;
        Some(u.into_iter().zip(e).map(|(u, e)| [u, e + 1e-7]).collect())
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
                if residual[i].abs() <= 4.0 * PRECISE * (at + floor) {
                    residual[i] = 0.0;
                } else {
                    precise = false;
                }
            }
            if precise || (side == 1 && round == rounds) {
                return Some(x);
            }
        }
        None
    }
}
