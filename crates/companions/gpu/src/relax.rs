//! Relaxation on the GPU, sweep by sweep.

use super::buffers::{blocks, with_driver_errors};
use super::half::Half;
use super::rule::{self, Rule, State};
use super::{Ending, Gpu, GpuError, GridEquations, grid_equations};
use cplan_fields::{CellEquations, Order, Relaxation, Scheme, Stopping};
use cplan_interrupt::checkpoint;

/// A relaxed field.
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxedField {
    /// One value per cell, row by row. Given values are rounded to single precision.
    pub values: Vec<f64>,
    /// Number of sweeps.
    pub sweeps: usize,
    /// The measure of change in the last sweep. Infinite without a sweep.
    pub change: f64,
    /// Reason why the relaxation ended.
    pub ending: Ending,
}

/// Largest number of sweeps that are submitted at once. It is even, so that Jacobi's two buffers then have their original roles.
const MAX_SWEEPS_PER_SUBMISSION: usize = 64;

/// Largest number of cell updates that are submitted at once. They take a fraction of a second on any GPU, so drivers
/// do not assume that it hangs.
const MAX_UPDATES_PER_SUBMISSION: usize = 1 << 28;

/// Multiple of the greatest initial value above which a relaxation counts as diverged.
const DIVERGENCE_FACTOR: f32 = 1e30;

/// Least number of sweeps without progress after which a relaxation ends with [`Ending::Floor`].
const MIN_IDLE_SWEEPS: usize = 64;

/// The cells that a dispatch updates, in the order of `Turn` in `kernels/sweep.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Turn {
    pub colour: u32,
    /// The region of the updated cells: 0 for most cells. On circles of odd length, 1 is the last row, 2 the last
    /// column, and 3 the cell in both.
    pub region: u32,
    /// Index of the first partial sum of this turn.
    pub slot: u32,
    pub unused: u32,
}

/// Returns the turns of a sweep, in the order of a sequential red-black relaxation.
pub(super) fn turns(odd: u32, blocks: u32) -> Vec<Turn> {
    let regions = [0, 2, 1, 3].into_iter().filter(|region| region & !odd == 0);
    let turns = (0..2).flat_map(|colour| regions.clone().map(move |region| (colour, region)));
    turns.zip(0..).map(|((colour, region), k)| Turn { colour, region, slot: k * blocks, unused: 0 }).collect()
}

impl Gpu {
    /// Relaxes the problem from its initial values until the stopping rule is satisfied. The order of updates must be
    /// red-black or all at once. Takes `O(cells)` per sweep, and 12 to 28 bytes per cell on the GPU.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the relaxation is invalid, or not supported. [`GpuError::Diverged`] if values grow without bound.
    /// [`GpuError::TooLarge`] and [`GpuError::Failed`] if the GPU cannot solve the problem. A lack of convergence is
    /// not an error; the [`Ending`] reports it.
    pub fn relax(
        &self,
        problem: &GridEquations,
        relaxation: &Relaxation,
        stopping: &Stopping,
    ) -> Result<RelaxedField, GpuError> {
        if let Some(refusal) = relaxation.refusal(problem.cells) {
            return Err(GpuError::Refused(refusal));
        }
        if let Scheme::Successive { order, .. } = relaxation.scheme
            && order != Order::RedBlack
        {
            let reason = format!(
                "the GPU cannot relax cells in the order {order}, only red-black or all at once; use the CPU for this order"
            );
            return Err(GpuError::Refused(reason));
        }
        let is_done = !problem.unknown.contains(&true);
        if is_done || stopping.max_sweeps == 0 {
            let ending = if is_done { Ending::Converged } else { Ending::Unconverged };
            return Ok(RelaxedField { values: problem.values.clone(), sweeps: 0, change: f64::INFINITY, ending });
        }
        with_driver_errors(&self.device, || self.relax_all(problem, relaxation, stopping))
    }

    fn relax_all(
        &self,
        problem: &GridEquations,
        relaxation: &Relaxation,
        stopping: &Stopping,
    ) -> Result<RelaxedField, GpuError> {
        let is_jacobi = matches!(relaxation.scheme, Scheme::Simultaneous { .. });
        let half = Half::new(problem.cells);
        let [across, down] = blocks(half.half, half.rows);
        let odd = GridEquations::odd_circles(problem.cells, problem.boundaries);
        let turns = turns(odd, across * down);
        let rule = rule(problem, (relaxation, stopping), half, odd, turns.len() as u32 * across * down);
        let start = half.spread(|cell| problem.values[cell] as f32);
        let pair = [self.storage(&start)?, if is_jacobi { self.storage(&start)? } else { self.storage::<f32>(&[])? }];
        let coefficients = self.storage(&coefficients(&problem.equations, half))?;
        let unknown = self.storage(&half.mask(&problem.unknown))?;
        let partials = self.storage(&vec![[0.0_f32; 2]; rule.blocks as usize])?;
        let state = State {
            done: 0,
            sweeps: 0,
            lost: 0,
            since: 0,
            change: f32::MAX,
            before: 0.0,
            least: f32::MAX,
            unused: 0.0,
        };
        let state = self.storage(&[state])?;
        let rule = self.uniform(&rule);
        let turns: Vec<wgpu::Buffer> = turns.iter().map(|turn| self.uniform(turn)).collect();

        let sweep = if is_jacobi { &self.pipelines.simultaneous } else { &self.pipelines.successive };
        // Buffers for an odd or an even sweep.
        let groups = [0, 1].map(|parity: usize| {
            let of = |turn| {
                let target = &pair[if is_jacobi { 1 - parity } else { 0 }];
                let mut buffers = vec![(0, &rule), (1, turn), (2, target), (4, &coefficients), (5, &unknown)];
                buffers.extend([(6, &partials), (7, &state)]);
                buffers.extend(is_jacobi.then_some((3, &pair[parity])));
                self.group(sweep, &buffers)
            };
            turns.iter().map(of).collect::<Vec<_>>()
        });
        let finish = self.group(&self.pipelines.finish, &[(0, &rule), (6, &partials), (7, &state)]);

        let at_once = (MAX_UPDATES_PER_SUBMISSION / problem.values.len()).clamp(2, MAX_SWEEPS_PER_SUBMISSION) / 2 * 2;
        let ended = loop {
            checkpoint();
            self.submit(|pass| {
                for k in 0..at_once {
                    pass.set_pipeline(sweep);
                    for group in &groups[k % 2] {
                        pass.set_bind_group(0, group, &[]);
                        pass.dispatch_workgroups(across, down, 1);
                    }
                    pass.set_pipeline(&self.pipelines.finish);
                    pass.set_bind_group(0, &finish, &[]);
                    pass.dispatch_workgroups(1, 1, 1);
                }
            });
            let state: State = self.read(&state, size_of::<State>() as u64)?[0];
            if state.done != 0 {
                break state;
            }
        };
        let newest = &pair[if is_jacobi { ended.sweeps as usize % 2 } else { 0 }];
        let values = half.gathered(&self.read(newest, (half.places() * size_of::<f32>()) as u64)?);
        let ending = match ended.done {
            1 => Ending::Converged,
            2 => Ending::Floor,
            3 => Ending::Unconverged,
            _ => return Err(diverged(&values, problem, ended.sweeps)),
        };
        Ok(RelaxedField { values, sweeps: ended.sweeps as usize, change: f64::from(ended.change), ending })
    }
}

/// Returns the greatest relative change that may be only rounding: eight units in the last place, or more with
/// over-relaxation. Over-relaxation by `2 - d` accumulates rounding over about `1 / d` sweeps, and measurements show
/// about the same amplification again. A change of a thousandth is never only rounding.
fn rounding(factor: f64) -> f32 {
    let kept = (2.0 - factor).clamp(1e-2, 1.0).powi(-2);
    ((8.0 * kept) as f32 * f32::EPSILON).min(1e-3)
}

fn greatest(values: &[f64]) -> f32 {
    values.iter().fold(0.0, |greatest: f64, value| greatest.max(value.abs())) as f32
}

/// Returns the limit for the absolute value of a cell above which a relaxation counts as diverged.
fn divergence_bound(problem: &GridEquations) -> f32 {
    let greatest = greatest(&problem.values).max(problem.outside.abs() as f32);
    if greatest > 0.0 { (DIVERGENCE_FACTOR * greatest).min(f32::MAX / 2.0) } else { DIVERGENCE_FACTOR }
}

fn diverged(values: &[f64], problem: &GridEquations, sweeps: u32) -> GpuError {
    let bound = f64::from(divergence_bound(problem));
    // NaN also counts as diverged. The first such value may have been overwritten. Then report the greatest value.
    let lost = values.iter().position(|value| value.is_nan() || value.abs() > bound);
    let largest = || (0..values.len()).max_by(|&a, &b| values[a].abs().total_cmp(&values[b].abs()));
    let at = lost.or_else(largest).unwrap_or(0);
    GpuError::Diverged { sweeps, cell: [at / problem.cells[1], at % problem.cells[1]], value: values[at] }
}

fn rule(
    problem: &GridEquations,
    (relaxation, stopping): (&Relaxation, &Stopping),
    half: Half,
    odd: u32,
    blocks: u32,
) -> Rule {
    let factor = relaxation.factor(problem.cells);
    let [low, high] = relaxation.clamp.map_or([-f32::MAX, f32::MAX], |range| range.map(|bound| bound as f32));
    Rule {
        rows: half.rows as u32,
        columns: half.columns as u32,
        half: half.half as u32,
        edge_rows: grid_equations::code(problem.boundaries[0]),
        edge_columns: grid_equations::code(problem.boundaries[1]),
        odd,
        stencil: match problem.equations {
            CellEquations::Mean => 0,
            CellEquations::Weights(_) => 1,
            CellEquations::Altered(_) => 2,
        },
        measure: rule::code(stopping.measure),
        max_sweeps: u32::try_from(stopping.max_sweeps).unwrap_or(u32::MAX),
        blocks,
        outside: problem.outside as f32,
        factor: factor as f32,
        low,
        high,
        below: stopping.below as f32,
        beyond: divergence_bound(problem),
        rounding: rounding(factor),
        patience: half.rows.max(half.columns).max(MIN_IDLE_SWEEPS) as u32,
        unused: [0; 2],
    }
}

/// Returns the coefficients of a stencil in the order of places. Each place has zero, one or four of them, depending on
/// the stencil.
fn coefficients(equations: &CellEquations, half: Half) -> Vec<f32> {
    match equations {
        CellEquations::Mean => Vec::new(),
        CellEquations::Altered(strength) => half.spread(|cell| strength[cell] as f32),
        CellEquations::Weights(weights) => {
            (0..4).flat_map(|side| half.spread(|cell| weights[cell][side] as f32)).collect()
        }
    }
}
