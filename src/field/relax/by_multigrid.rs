//! Linear equations with a drift by multigrid: what a relaxation converges to, in a few steps.

use super::stencil::weights;
use super::sweeps::{begun, places_around, unknowns};
use super::{Boundary, Convergence, Domain, Equation, Measure, RelaxError, Relaxed, Stopping};
use crate::field::multigrid::{Ends, Multigrid, Workspace};
use crate::interrupt::checkpoint;

/// Steps until directions are forgotten: so many vectors are kept.
const RESTART: usize = 16;

/// The error to which a step solves for the equation without its drift. It only leads the way: a digit is enough.
const ADVICE: f64 = 0.1;

/// Solves a linear equation from `start`, such as the field for obstacles that have moved a little since. Flexible GMRES (Saad 1993),
/// preconditioned by the multigrid solution of the same problem without the drift, to a digit. A step costs as much as that; how many
/// there are depends on the drift times the width of what it holds in, not on the number of cells: 2 to 14 from nothing in the
/// fields of `examples/robot_football`, where Gauss and Seidel's relaxation takes 400 to 1400 sweeps to the same rule.
///
/// [`Convergence::sweeps`] counts steps; [`Convergence::change`] is the sum of squared changes that a sweep of Jacobi's would make.
/// Where the start fulfils the rule nothing is done.
///
/// ```
/// use cplan::field::*;
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
/// [`RelaxError::Refused`] for preferences, whose drift depends on a field, for another measure than [`Measure::SumOfSquares`], and
/// where sizes differ; [`RelaxError::Diverged`] where values are numbers no more. One that comes to no end within
/// `stopping.max_sweeps` steps says so in its [`Convergence`].
pub fn by_multigrid(
    domain: &Domain,
    equation: &Equation,
    stopping: &Stopping,
    start: Vec<f64>,
) -> Result<Relaxed, RelaxError> {
    let refused = |why: &str| RelaxError::Refused(why.into());
    if let Some(refusal) = equation.refusal(domain) {
        return Err(RelaxError::Refused(refusal));
    }
    if stopping.measure != Measure::SumOfSquares {
        return Err(refused("multigrid measures the sum of squared changes: stop by that"));
    }
    let (drift, difference) =
        equation.drift().ok_or_else(|| refused("multigrid solves linear equations: relax preferences"))?;
    let system = System::new(domain, |cell| weights(domain, cell, drift(cell), difference));
    let mut values = begun(domain, start)?;
    let mut stage = Convergence { sweeps: 0, change: f64::INFINITY, converged: false };
    let mut preconditioner = None;
    loop {
        let residual = system.residual(&values);
        let before = std::mem::replace(&mut stage.change, square(&residual));
        stage.converged = stage.change < stopping.below || stage.change == 0.0;
        if !stage.change.is_finite() {
            let lost = |&&cell: &&u32| !values[cell as usize].is_finite();
            let cell = system.unknowns.iter().find(lost).map_or(0, |&cell| cell as usize);
            let hint = "the values to start from, or the drift, are too great".into();
            let place = [cell / domain.cells()[1], cell % domain.cells()[1]];
            return Err(RelaxError::Diverged { sweeps: stage.sweeps, cell: place, value: values[cell], hint });
        }
        // Rounding ends the progress.
        if stage.converged || stage.sweeps >= stopping.max_sweeps || stage.change >= before {
            values.pop();
            return Ok(Relaxed { values, stages: vec![stage] });
        }
        let advice = preconditioner.get_or_insert_with(|| Preconditioner::new(domain, &system));
        let most = RESTART.min(stopping.max_sweeps - stage.sweeps);
        stage.sweeps += system.round(advice, residual, stopping.below, most, &mut values);
    }
}

/// What the neighbours ask of each unknown.
struct System {
    /// Cells, rising.
    unknowns: Vec<u32>,
    /// Places of the neighbours' values.
    around: Vec<[u32; 4]>,
    weights: Vec<[f64; 4]>,
    /// Their sums.
    sums: Vec<f64>,
}

impl System {
    fn new(domain: &Domain, weights: impl Fn(usize) -> [f64; 4]) -> Self {
        let unknowns = unknowns(domain);
        let around = places_around(domain, &unknowns);
        let weights: Vec<[f64; 4]> = unknowns.iter().map(|&cell| weights(cell as usize)).collect();
        let sums = weights.iter().map(|weights| weights.iter().sum()).collect();
        Self { unknowns, around, weights, sums }
    }

    /// How far each unknown is from what its neighbours ask for; `values` are one a cell, and last that beyond limits.
    fn residual(&self, values: &[f64]) -> Vec<f64> {
        let asked = |k: usize| {
            let (weights, around) = (self.weights[k], self.around[k].map(|n| values[n as usize]));
            let sum: f64 = weights.iter().zip(around).map(|(weight, value)| weight * value).sum();
            sum / self.sums[k] - values[self.unknowns[k] as usize]
        };
        (0..self.unknowns.len()).map(asked).collect()
    }

    /// Takes steps until they are expected to be enough, and adds them to the values; how many there were.
    fn round(
        &self,
        advice: &mut Preconditioner,
        residual: Vec<f64>,
        below: f64,
        most: usize,
        values: &mut [f64],
    ) -> usize {
        let mut left = vec![square(&residual).sqrt()];
        let (mut basis, mut ways) = (vec![scaled(residual, 1.0 / left[0])], Vec::new());
        // Columns of a triangle, and the turns that made it one.
        let (mut columns, mut turns): (Vec<Vec<f64>>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
        while ways.len() < most {
            checkpoint();
            let way = advice.way(self, &basis[basis.len() - 1]);
            // The residual falls by this where the values go the way.
            let mut image = scaled(self.residual(&way), -1.0);
            ways.push(way);
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
                // The way changes nothing that others have not.
                ways.pop();
                break;
            }
            let turn = [column[k] / length, beyond / length];
            turns.push(turn);
            column[k] = length;
            columns.push(column);
            let last = left[k];
            left[k] = turn[0] * last;
            left.push(-turn[1] * last);
            // Half of what is asked for, since the residual is what counts, and rounding adds to it.
            if beyond == 0.0 || left[k + 1] * left[k + 1] < 0.5 * below {
                break;
            }
            basis.push(scaled(image, 1.0 / beyond));
        }
        let mut shares = left;
        for k in (0..ways.len()).rev() {
            let later: f64 = (k + 1..ways.len()).map(|j| columns[j][k] * shares[j]).sum();
            shares[k] = (shares[k] - later) / columns[k][k];
        }
        for (way, share) in ways.iter().zip(&shares) {
            values.iter_mut().zip(way).for_each(|(value, way)| *value += share * way);
        }
        ways.len().max(1)
    }
}

/// The same problem without the drift.
struct Preconditioner {
    multigrid: Multigrid,
    workspace: Workspace,
    right: Vec<f64>,
}

impl Preconditioner {
    fn new(domain: &Domain, system: &System) -> Self {
        let mut free = vec![false; domain.kinds().len()];
        system.unknowns.iter().for_each(|&cell| free[cell as usize] = true);
        let ends = domain.boundaries().map(|boundary| match boundary {
            Boundary::Periodic => Ends::Joined,
            Boundary::High => Ends::High,
            Boundary::Reflecting => Ends::Reflecting,
        });
        let multigrid = Multigrid::new(domain.cells(), ends, &free, 0.0);
        Self { workspace: multigrid.workspace(), multigrid, right: vec![0.0; free.len()] }
    }

    /// Where the values are to go for their residual to fall by this: one a cell, and last 0 for what is beyond limits.
    fn way(&mut self, system: &System, residual: &[f64]) -> Vec<f64> {
        for (k, &cell) in system.unknowns.iter().enumerate() {
            self.right[cell as usize] = system.sums[k] * residual[k];
        }
        let mut way = vec![0.0; self.right.len()];
        self.multigrid.solve(&self.right, &mut way, ADVICE, &mut self.workspace);
        way.push(0.0);
        way
    }
}

fn square(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum()
}

fn scaled(mut vector: Vec<f64>, by: f64) -> Vec<f64> {
    vector.iter_mut().for_each(|x| *x *= by);
    vector
}
