//! Solves linear problems by multigrid, with cycles on the GPU, and residuals in double precision on the CPU.

use super::buffers::with_driver_errors;
use super::cycle::Cycle;
use super::levels::Level;
use super::{Gpu, GpuError, GridEquations};
use cplan_fields::{Boundary, CellEquations};
use cplan_interrupt::checkpoint;

/// Rule that ends a multigrid solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Multigrid {
    /// Residual to reach, as a fraction of the greatest value.
    pub below: f64,
    /// Largest number of cycles.
    pub max_cycles: u32,
}

impl Default for Multigrid {
    fn default() -> Self {
        Self { below: 1e-13, max_cycles: 100 }
    }
}

/// A solution by multigrid.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// One value per cell, row by row.
    pub values: Vec<f64>,
    /// Number of cycles.
    pub cycles: u32,
    /// Largest difference between a value and the one that its neighbours imply, as a fraction of the greatest value.
    pub residual: f64,
    /// True if the requested residual was reached. Otherwise, further cycles made no progress, or their largest number
    /// was reached.
    pub converged: bool,
}

/// Number of cycles between two residuals in double precision.
const CYCLES_PER_ROUND: u32 = 2;

/// Largest fraction of the residual that may remain after a round with progress.
const MAX_RESIDUAL_RATIO: f64 = 0.5;

/// Number of consecutive rounds without progress after which the solver stops.
const MAX_IDLE_ROUNDS: u32 = 4;

impl Gpu {
    /// Solves a linear problem by multigrid. The CPU computes residuals in double precision, and F-cycles in single
    /// precision on the GPU compute corrections. Takes `O(cells)` per cycle and about 38 bytes per cell on the GPU.
    /// With random walls and mild drifts, a cycle leaves about a third of the error.
    ///
    /// The error is at most a multiple of the residual: at most `n^2 / 2` for Laplace's equation in a corridor of `n` cells.
    ///
    /// # Errors
    /// [`GpuError::Refused`] for [`CellEquations::Altered`], which is not linear. [`GpuError::TooLarge`] and
    /// [`GpuError::Failed`] if the GPU cannot solve the problem. A lack of convergence is not an error;
    /// [`Solution::converged`] reports it. It occurs with drifts of 2 or more per cell by central differences, and if
    /// no given value reaches some unknowns.
    pub fn solve(&self, problem: &GridEquations, settings: &Multigrid) -> Result<Solution, GpuError> {
        let weights = |cell: usize| match &problem.equations {
            CellEquations::Weights(weights) => weights[cell],
            CellEquations::Mean | CellEquations::Altered(_) => [0.25; 4],
        };
        if let CellEquations::Altered(_) = problem.equations {
            return Err(GpuError::Refused(
                "multigrid solves only linear equations; use a relaxation for this one".into(),
            ));
        }
        let levels = Level::hierarchy(Level::finest(problem, weights));
        let residual = |values: &[f64]| residual(problem, &levels[0], &weights, values);
        let mut values = problem.values.clone();
        let mut left = residual(&values);
        let mut best = (values.clone(), left.1);
        let mut solved =
            Solution { values: Vec::new(), cycles: 0, residual: left.1, converged: left.1 <= settings.below };
        if !solved.converged {
            with_driver_errors(&self.device, || {
                let cycle = Cycle::new(self, &levels)?;
                let mut idle = 0;
                while !solved.converged && solved.cycles < settings.max_cycles && idle < MAX_IDLE_ROUNDS {
                    checkpoint();
                    let cycles = CYCLES_PER_ROUND.min(settings.max_cycles - solved.cycles);
                    let next = self.values_after_cycles(&cycle, cycles, &values, &left.0)?;
                    solved.cycles += cycles;
                    let after = residual(&next);
                    // NaN also counts as no progress.
                    idle = if after.1 <= MAX_RESIDUAL_RATIO * solved.residual { 0 } else { idle + 1 };
                    if !after.1.is_finite() {
                        break;
                    }
                    (values, left) = (next, after);
                    if left.1 < best.1 {
                        best = (values.clone(), left.1);
                    }
                    (solved.residual, solved.converged) = (left.1, left.1 <= settings.below);
                }
                Ok(())
            })?;
        }
        // Rounds without progress may have increased the residual.
        let (values, residual) = best;
        Ok(Solution { values, residual, ..solved })
    }

    /// Returns the values after these cycles of corrections. `left` is the residual before them.
    fn values_after_cycles(
        &self,
        cycle: &Cycle,
        cycles: u32,
        values: &[f64],
        left: &[f64],
    ) -> Result<Vec<f64>, GpuError> {
        // Scale the residual, so that corrections do not underflow in single precision.
        let scale = left.iter().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
        let right: Vec<f32> = left.iter().map(|value| (value / scale) as f32).collect();
        self.queue.write_buffer(&cycle.right, 0, bytemuck::cast_slice(&right));
        self.queue.write_buffer(&cycle.x, 0, bytemuck::cast_slice(&vec![0.0_f32; right.len()]));
        for _ in 0..cycles {
            self.submit(|pass| cycle.record(self, pass));
        }
        let x: Vec<f32> = self.read(&cycle.x, size_of_val(&right[..]) as u64)?;
        Ok(values.iter().zip(x).map(|(value, x)| value + scale * f64::from(x)).collect())
    }
}

/// Computes the residual of each cell, and the greatest residual as a fraction of the greatest value. Takes `O(cells)`.
fn residual(
    problem: &GridEquations,
    finest: &Level,
    weights: &impl Fn(usize) -> [f64; 4],
    values: &[f64],
) -> (Vec<f64>, f64) {
    let of = |cell: usize| {
        if !problem.unknown[cell] {
            return 0.0;
        }
        let own = values[cell];
        let asked = weights(cell).into_iter().enumerate().map(|(side, weight)| {
            weight
                * match finest.neighbor(cell, side) {
                    Some(next) => values[next],
                    None if problem.boundaries[side / 2] == Boundary::Reflecting => own,
                    None => problem.outside,
                }
        });
        asked.sum::<f64>() - own
    };
    let left: Vec<f64> = (0..values.len()).map(of).collect();
    let largest =
        |numbers: &[f64]| numbers.iter().fold(0.0, |g: f64, x| if x.is_nan() { f64::INFINITY } else { g.max(x.abs()) });
    let greatest = largest(values).max(problem.outside.abs());
    let share = largest(&left) / if greatest > 0.0 { greatest } else { 1.0 };
    (left, share)
}
