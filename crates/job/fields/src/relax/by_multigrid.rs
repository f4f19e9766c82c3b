//! Solves linear equations with a drift by multigrid, in a few steps. The result is the limit of a relaxation.

use super::stencil::sides;
use super::sweeps::initial_values;
use super::{Boundary, Convergence, Domain, Equation, Measure, RelaxError, RelaxedField, Stopping};
use cplan_interrupt::checkpoint;
use cplan_multigrid::{Ends, Multigrid, Workspace};

/// GMRES restarts after this number of steps, and keeps as many vectors.
const RESTART_STEPS: usize = 16;

/// Relative error to which a step solves the equation without its drift. This solution is only a direction, so one digit
/// suffices.
const PRECONDITIONER_ERROR: f64 = 0.1;

/// Least relative error to which a step solves an equation without a drift. Single precision allows little more.
const MIN_STEP_ERROR: f64 = 1e-6;

/// Steps end when the estimated residual is below this fraction of the requested change. It is less than 1, because the residual
/// itself is checked afterwards, and rounding makes it greater than the estimate.
const STEP_STOP_FRACTION: f64 = 0.5;

/// Solves a linear equation from `start`, such as the field before obstacles moved slightly. The method is flexible GMRES (Saad
/// 1993). Its preconditioner is a multigrid solution, to one digit, of the same problem without the drift.
///
/// A step costs as much as that solution. The number of steps depends on the product of the drift and the width of its region,
/// not on the number of cells. In the fields of `examples/robot_football`, it takes 2 to 14 steps from zero, where Gauss-Seidel
/// relaxation takes 400 to 1400 sweeps by the same rule. Without a drift, a step is the multigrid solution itself, as exact as
/// requested, so one step usually suffices.
///
/// [`Convergence::sweeps`] counts steps. [`Convergence::change`] is the sum of squared changes that a Jacobi sweep would make. If
/// the start already satisfies the stopping rule, there is no step.
///
/// ```
/// use cplan_fields::*;
///
/// // A row of cells: p'' + b p' = 0 between 0 and 1, by upwind differences, which have a closed form.
/// let mut kinds = vec![Cell::Free; 40];
/// (kinds[0], kinds[39]) = (Cell::Goal, Cell::Obstacle);
/// let row = Domain::new([1, 40], kinds, [Boundary::Reflecting; 2], Levels::PUBLISHED);
/// let drift = Equation::LocallyOriented { drift: vec![[0.0, 0.5]; 40], difference: Difference::Upwind };
/// let stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-24, max_sweeps: 200 };
/// let field = by_multigrid(&row, &drift, &stopping, row.start())?;
/// let exact = |k: i32| (1.0 - 1.5_f64.powi(-k)) / (1.0 - 1.5_f64.powi(-39));
/// assert!((0..40).all(|k| (field.values[k as usize] - exact(k)).abs() < 1e-9));
/// # Ok::<(), RelaxError>(())
/// ```
///
/// # Errors
/// [`RelaxError::Refused`] for preferences (whose drift depends on a field), for measures other than [`Measure::SumOfSquares`],
/// and if sizes differ; [`RelaxError::Diverged`] if values become NaN. A solve that does not end within `stopping.max_sweeps`
/// steps reports that in its [`Convergence`].
pub fn by_multigrid(
    domain: &Domain,
    equation: &Equation,
    stopping: &Stopping,
    start: Vec<f64>,
) -> Result<RelaxedField, RelaxError> {
    by_multigrid_in(domain, equation, stopping, start, &mut Memory::default())
}

/// Workspace of a solve. It has no information about the field, and can be reused on domains with the same shape and boundaries.
#[derive(Debug, Clone, Default)]
pub struct Memory(Option<Workspace>);

impl PartialEq for Memory {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Does the same as [`by_multigrid`], with memory of an earlier solve.
pub fn by_multigrid_in(
    domain: &Domain,
    equation: &Equation,
    stopping: &Stopping,
    start: Vec<f64>,
    memory: &mut Memory,
) -> Result<RelaxedField, RelaxError> {
    let refused = |why: &str| RelaxError::Refused(why.into());
    if let Some(refusal) = equation.refusal(domain) {
        return Err(RelaxError::Refused(refusal));
    }
    if stopping.measure != Measure::SumOfSquares {
        return Err(refused("multigrid ends by the sum of squared changes; use --measure squares"));
    }
    let (drift, difference) = equation
        .drift()
        .ok_or_else(|| refused("multigrid solves only linear equations: use a relaxation for preferences"))?;
    if domain.kinds().is_empty() {
        let stage = Convergence { sweeps: 0, change: 0.0, converged: true };
        return Ok(RelaxedField { values: Vec::new(), stages: vec![stage] });
    }
    // True if the equation differs from that of the preconditioner.
    let has_drift = *equation != Equation::Harmonic || domain.beta() != 1.0;
    let system = System::new(domain, has_drift.then_some(|cell| sides(domain.beta(), drift(cell), difference)));
    let mut values = initial_values(domain, start)?;
    let mut stage = Convergence { sweeps: 0, change: f64::INFINITY, converged: false };
    let mut preconditioner = None;
    loop {
        let residual = system.residual(&values);
        let before = std::mem::replace(&mut stage.change, square(&residual));
        stage.converged = stage.change < stopping.below || stage.change == 0.0;
        if !stage.change.is_finite() {
            let cell = values.iter().position(|value| !value.is_finite()).unwrap_or(0);
            let hint = "the initial values or the drift are too great".into();
            let place = [cell / domain.cells()[1], cell % domain.cells()[1]];
            return Err(RelaxError::Diverged { sweeps: stage.sweeps, cell: place, value: values[cell], hint });
        }
        // Also ends if the last round made no progress, because of rounding.
        if stage.converged || stage.sweeps >= stopping.max_sweeps || stage.change >= before {
            values.pop();
            memory.0 = preconditioner.map(|Preconditioner { workspace, .. }| workspace).or(memory.0.take());
            return Ok(RelaxedField { values, stages: vec![stage] });
        }
        let advice = preconditioner.get_or_insert_with(|| Preconditioner::new(&system, memory));
        if !has_drift {
            // Without a drift, the preconditioner gives the solution itself, as precisely as requested.
            let error =
                (STEP_STOP_FRACTION * stopping.below / stage.change).sqrt().clamp(MIN_STEP_ERROR, PRECONDITIONER_ERROR);
            let correction = advice.correction(&system, &residual, error);
            values.iter_mut().zip(&correction).for_each(|(value, correction)| *value += correction);
            stage.sweeps += 1;
            continue;
        }
        let most = RESTART_STEPS.min(stopping.max_sweeps - stage.sweeps);
        stage.sweeps += system.round(advice, residual, stopping.below, most, &mut values);
    }
}

/// The equations of all cells. A vector has one entry per cell, row by row, so that neighbours are at constant offsets; entries
/// of cells that are not unknowns are 0.
struct System {
    cells: [usize; 2],
    boundaries: [Boundary; 2],
    is_unknown: Vec<bool>,
    /// Weights of the neighbours `-q1, +q1, -q2, +q2` of each cell. `None` if all are 1.
    weights: Option<Vec<[f64; 4]>>,
    /// Sum of the weights of each cell, over neighbours that are not the cell itself.
    sums: Vec<f64>,
    /// Reciprocals of the sums; 0 for cells that are not unknowns.
    shares: Vec<f64>,
}

impl System {
    /// Creates a system with these weights, or with weights 1.
    fn new(domain: &Domain, weights: Option<impl Fn(usize) -> [f64; 4]>) -> Self {
        let (cells, boundaries, count) = (domain.cells(), domain.boundaries(), domain.kinds().len());
        let is_unknown: Vec<bool> = (0..count).map(|cell| domain.is_unknown(cell)).collect();
        let weights: Option<Vec<[f64; 4]>> = weights.map(|weights| (0..count).map(weights).collect());
        let mut sums = match &weights {
            Some(weights) => weights.iter().map(|weights| weights.iter().sum()).collect(),
            None => vec![4.0; count],
        };
        let mut drop_own =
            |cell: usize, side: usize| sums[cell] -= weights.as_ref().map_or(1.0, |weights| weights[cell][side]);
        let [rows, columns] = cells;
        let is_own = [0, 1].map(|axis| match boundaries[axis] {
            Boundary::High => false,
            Boundary::Reflecting => true,
            Boundary::Periodic => cells[axis] == 1,
        });
        if is_own[0] {
            for j in 0..columns {
                drop_own(j, 0);
                drop_own((rows - 1) * columns + j, 1);
            }
        }
        if is_own[1] {
            for i in 0..rows {
                drop_own(i * columns, 2);
                drop_own((i + 1) * columns - 1, 3);
            }
        }
        let share = |(&is_unknown, sum): (&bool, &f64)| if is_unknown { 1.0 / sum } else { 0.0 };
        let shares = is_unknown.iter().zip(&sums).map(share).collect();
        Self { cells, boundaries, is_unknown, weights, sums, shares }
    }

    /// Returns values with a frame of one cell, which has the boundary values. `values` has one entry per cell, and finally the
    /// value beyond high limits.
    fn framed(&self, values: &[f64]) -> Vec<f64> {
        let ([rows, columns], beyond) = (self.cells, values[values.len() - 1]);
        let stride = columns + 2;
        let mut framed = vec![beyond; (rows + 2) * stride];
        for i in 0..rows {
            let (from, to) = (&values[i * columns..(i + 1) * columns], &mut framed[(i + 1) * stride..(i + 2) * stride]);
            to[1..=columns].copy_from_slice(from);
            (to[0], to[columns + 1]) = match self.boundaries[1] {
                Boundary::High => (beyond, beyond),
                Boundary::Periodic => (from[columns - 1], from[0]),
                Boundary::Reflecting => (from[0], from[columns - 1]),
            };
        }
        let [first, last] = [stride, rows * stride];
        let (above, below) = match self.boundaries[0] {
            Boundary::High => return framed,
            Boundary::Periodic => (last, first),
            Boundary::Reflecting => (first, last),
        };
        framed.copy_within(above..above + stride, 0);
        framed.copy_within(below..below + stride, (rows + 1) * stride);
        framed
    }

    /// Returns the difference of each cell from the value that its neighbours imply. `values` has one entry per cell, and finally
    /// the boundary value.
    fn residual(&self, values: &[f64]) -> Vec<f64> {
        match &self.weights {
            Some(weights) => self.residual_by(values, |cell| weights[cell]),
            None => self.residual_by(values, |_| [1.0; 4]),
        }
    }

    #[inline(always)]
    fn residual_by(&self, values: &[f64], weights: impl Fn(usize) -> [f64; 4]) -> Vec<f64> {
        let [rows, columns] = self.cells;
        let (framed, stride) = (self.framed(values), columns + 2);
        let mut residual = vec![0.0; rows * columns];
        for i in 0..rows {
            let line = |row: usize, column: usize| &framed[row * stride + column..][..columns];
            let [above, below, before, here, after] =
                [(i, 1), (i + 2, 1), (i + 1, 0), (i + 1, 1), (i + 1, 2)].map(|(row, column)| line(row, column));
            let first = i * columns;
            let shares = &self.shares[first..][..columns];
            for (j, to) in residual[first..][..columns].iter_mut().enumerate() {
                // A neighbour that is the cell itself makes no difference.
                let ([a, b, c, d], here) = (weights(first + j), here[j]);
                let rows = a * (above[j] - here) + b * (below[j] - here);
                *to = (rows + (c * (before[j] - here) + d * (after[j] - here))) * shares[j];
            }
        }
        residual
    }

    /// Takes up to `most` steps, until the estimated residual is below `below`, and adds the corrections to the values. Returns
    /// the number of steps.
    fn round(
        &self,
        advice: &mut Preconditioner,
        residual: Vec<f64>,
        below: f64,
        most: usize,
        values: &mut [f64],
    ) -> usize {
        let mut left = vec![square(&residual).sqrt()];
        let (mut basis, mut corrections) = (vec![scaled(residual, 1.0 / left[0])], Vec::new());
        // The columns of GMRES's triangular matrix, and the Givens rotations that made it triangular.
        let (mut columns, mut turns): (Vec<Vec<f64>>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
        while corrections.len() < most {
            checkpoint();
            let correction = advice.correction(self, &basis[basis.len() - 1], PRECONDITIONER_ERROR);
            // Adding the correction to the values reduces the residual by this.
            let mut image = scaled(self.residual(&correction), -1.0);
            corrections.push(correction);
            let mut column: Vec<f64> = Vec::with_capacity(basis.len() + 1);
            for direction in &basis {
                let part: f64 = direction.iter().zip(&image).map(|(a, b)| a * b).sum();
                image.iter_mut().zip(direction).for_each(|(image, direction)| *image -= part * direction);
                column.push(part);
            }
            let beyond = square(&image).sqrt();
            for (k, [cosine, sine]) in turns.iter().enumerate() {
                let [a, b] = [column[k], column[k + 1]];
                [column[k], column[k + 1]] = [cosine * a + sine * b, cosine * b - sine * a];
            }
            let k = turns.len();
            let length = column[k].hypot(beyond);
            if !(length > 0.0 && length.is_finite()) {
                // This correction changes the residual in no new direction.
                corrections.pop();
                break;
            }
            let turn = [column[k] / length, beyond / length];
            turns.push(turn);
            column[k] = length;
            columns.push(column);
            let last = left[k];
            left[k] = turn[0] * last;
            left.push(-turn[1] * last);
            if beyond == 0.0 || left[k + 1] * left[k + 1] < STEP_STOP_FRACTION * below {
                break;
            }
            basis.push(scaled(image, 1.0 / beyond));
        }
        let mut shares = left;
        for k in (0..corrections.len()).rev() {
            let later: f64 = (k + 1..corrections.len()).map(|j| columns[j][k] * shares[j]).sum();
            shares[k] = (shares[k] - later) / columns[k][k];
        }
        for (correction, share) in corrections.iter().zip(&shares) {
            values.iter_mut().zip(correction).for_each(|(value, correction)| *value += share * correction);
        }
        corrections.len().max(1)
    }
}

/// Multigrid for the same problem without the drift.
struct Preconditioner {
    multigrid: Multigrid,
    workspace: Workspace,
    right: Vec<f64>,
}

impl Preconditioner {
    fn new(system: &System, memory: &mut Memory) -> Self {
        let ends = system.boundaries.map(|boundary| match boundary {
            Boundary::Periodic => Ends::Joined,
            Boundary::High => Ends::High,
            Boundary::Reflecting => Ends::Reflecting,
        });
        let multigrid = Multigrid::new(system.cells, ends, &system.is_unknown, 0.0);
        let workspace = memory.0.take().unwrap_or_else(|| multigrid.workspace());
        Self { workspace, multigrid, right: vec![0.0; system.is_unknown.len()] }
    }

    /// Returns the correction of the values that would remove `residual`, with the relative error `error`. It has one entry per
    /// cell, and finally 0 for the boundary.
    fn correction(&mut self, system: &System, residual: &[f64], error: f64) -> Vec<f64> {
        let asked = residual.iter().zip(&system.sums).map(|(residual, sum)| sum * residual);
        self.right.iter_mut().zip(asked).for_each(|(to, asked)| *to = asked);
        let mut correction = vec![0.0; self.right.len()];
        self.multigrid.solve(&self.right, &mut correction, error, &mut self.workspace);
        correction.push(0.0);
        correction
    }
}

fn square(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum()
}

fn scaled(mut vector: Vec<f64>, by: f64) -> Vec<f64> {
    vector.iter_mut().for_each(|x| *x *= by);
    vector
}
