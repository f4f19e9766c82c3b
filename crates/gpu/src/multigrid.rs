//! Multigrid: cycles on the GPU, residuals in double precision on the CPU.

use super::buffers::watched;
use super::cycle::Cycle;
use super::levels::Level;
use super::{Gpu, GpuError, GridEquations, Stencil};
use cplan_interrupt::checkpoint;

/// How far multigrid goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Multigrid {
    /// Until no value differs by more than this part of the greatest one from what its neighbours ask for.
    pub below: f64,
    /// It ends after so many cycles anyway.
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
    /// One a cell, row by row.
    pub values: Vec<f64>,
    /// Cycles that it took.
    pub cycles: u32,
    /// The greatest difference between a value and what its neighbours ask for, as a part of the greatest value.
    pub residual: f64,
    /// Whether that is as small as was asked for. If not, cycles made it no smaller any more, or were used up.
    pub converged: bool,
}

/// Cycles between residuals in double precision.
const ROUND: u32 = 2;

/// A round that leaves more than this part of the residual has not helped.
const HELPED: f64 = 0.5;

/// So many rounds in a row that did not help are the end.
const PATIENCE: u32 = 4;

impl Gpu {
    /// Solves a linear problem by multigrid: corrections by F-cycles in single precision on the GPU, each for a residual that was reckoned
    /// in double precision. `O(cells)` a cycle, about 38 bytes a cell on the GPU. On walls at random and mild drifts a cycle leaves about a
    /// third of the error.
    ///
    /// How far values are from the solution follows from the residual: by Laplace's equation, at most `n^2 / 2` times as much in a
    /// corridor of `n` cells' length.
    ///
    /// # Errors
    /// [`GpuError::Refused`] for [`Stencil::Altered`], which is not linear; [`GpuError::TooLarge`], [`GpuError::Failed`]. That it does
    /// not converge (drifts by central differences of 2 and more a cell, unknowns that no given value reaches) is no error:
    /// [`Solution::converged`] says so.
    pub fn solve(&self, problem: &GridEquations, settings: &Multigrid) -> Result<Solution, GpuError> {
        let weights = |cell: usize| match &problem.stencil {
            Stencil::Weights(weights) => weights[cell],
            Stencil::Mean | Stencil::Altered(_) => [0.25; 4],
        };
        if let Stencil::Altered(_) = problem.stencil {
            return Err(GpuError::Refused("multigrid is for linear equations; relax this one".into()));
        }
        let levels = Level::hierarchy(Level::finest(problem, weights));
        let residual = |values: &[f64]| residual(problem, &levels[0], &weights, values);
        let mut values = problem.values.clone();
        let mut left = residual(&values);
        let mut best = (values.clone(), left.1);
        let mut solved =
            Solution { values: Vec::new(), cycles: 0, residual: left.1, converged: left.1 <= settings.below };
        if !solved.converged {
            watched(&self.device, || {
                let cycle = Cycle::new(self, &levels)?;
                let mut idle = 0;
                while !solved.converged && solved.cycles < settings.max_cycles && idle < PATIENCE {
                    checkpoint();
                    let cycles = ROUND.min(settings.max_cycles - solved.cycles);
                    let next = self.corrected(&cycle, cycles, &values, &left.0)?;
                    solved.cycles += cycles;
                    let after = residual(&next);
                    // What is no number has not helped, either.
                    idle = if after.1 <= HELPED * solved.residual { 0 } else { idle + 1 };
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
        // Rounds that did not help may have made it worse.
        let (values, residual) = best;
        Ok(Solution { values, residual, ..solved })
    }

    /// The values after so many cycles for what is left to do.
    fn corrected(&self, cycle: &Cycle, cycles: u32, values: &[f64], left: &[f64]) -> Result<Vec<f64>, GpuError> {
        // Scaled, so that no correction is lost below the least number of single precision.
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

/// What is left to do in each cell, and the greatest of it as a part of the greatest value. `O(cells)`.
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
                    None if problem.edges[side / 2] == super::Edge::Mirror => own,
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
