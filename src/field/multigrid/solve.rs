//! Conjugate gradients.

use super::cycle::{Hierarchy, Stack};
use super::frame::{Ends, Frame, LANES};
use super::stencil::FivePoint;

/// The solver for one arrangement of walls.
#[derive(Debug, Clone)]
pub struct Multigrid {
    operator: FivePoint,
    hierarchy: Hierarchy,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Steps of conjugate gradients, each with one V-cycle.
    pub iterations: usize,
    /// Estimate of the greatest error of a value, relative to the greatest value.
    pub error: f64,
    /// Whether `error` came below the tolerance. If not, rounding ended the progress.
    pub converged: bool,
}

/// Vectors that a solve works with, kept from one solve to the next. About 40 bytes a cell.
#[derive(Debug, Clone)]
pub struct Workspace {
    stack: Stack,
    values: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
}

/// More steps than this are never needed: each gains a digit or nearly so.
const MOST_ITERATIONS: usize = 100;

/// Residuals less than this part of the greatest are 0 to the preconditioner: in single precision they would only become
/// subnormal numbers, which are slow, along its way.
const NEGLIGIBLE: f32 = 1e-25;

/// The error after a step is estimated from the last two changes as a geometric series, whose ratio is taken to be at
/// least this: steps that happen to change little prove little.
const LEAST_RATIO: f64 = 0.1;

impl Multigrid {
    /// For `cells` rows and columns, row by row in `free`. Linear in the number of cells.
    ///
    /// If nothing touches a wall or high limit and `shift` is 0 the problem has no unique solution, but up to a constant
    /// if the sum of `b` is 0; then a shift of `1e-6` a cell is taken instead.
    ///
    /// # Panics
    /// If `free` has another length than the product of `cells`, or `shift` is negative or not finite.
    #[must_use]
    pub fn new(cells: [usize; 2], ends: [Ends; 2], free: &[bool], shift: f64) -> Self {
        assert_eq!(free.len(), cells[0] * cells[1], "one flag a cell");
        assert!(shift >= 0.0 && shift.is_finite(), "a shift is not negative");
        let frame = Frame::new(cells, ends);
        let mut operator = FivePoint { frame, degree: 4.0 + shift, free: vec![0.0; frame.len()] };
        for (i, free) in free.chunks_exact(cells[1].max(1)).enumerate() {
            let row = &mut operator.free[frame.row(i)];
            row.iter_mut().zip(free).for_each(|(to, &free)| *to = f32::from(u8::from(free)));
        }
        frame.of_coefficients().finish(&mut operator.free);
        if operator.is_singular() {
            operator.degree += SHIFT;
        }
        let hierarchy = Hierarchy::new(&operator);
        Self { operator, hierarchy }
    }

    /// A workspace for solves.
    #[must_use]
    pub fn workspace(&self) -> Workspace {
        let zeros = || vec![0.0; self.operator.frame.len()];
        let stack = self.hierarchy.stack(self.operator.frame);
        Workspace { stack, values: zeros(), residual: zeros(), direction: zeros() }
    }

    /// Solves for the right-hand side `right`, from the start that is in `values`, which must be finite; walls are
    /// neither read nor (but as 0) written. Ends when no value is likely to be wrong by more than `tolerance` times the
    /// greatest.
    ///
    /// Takes 4 to 8 iterations for a tolerance of `1e-6`, whatever the size and the walls.
    ///
    /// # Panics
    /// If a length is not the number of cells, or the workspace is of another grid.
    pub fn solve(&self, right: &[f64], values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        let frame = self.operator.frame;
        let cells = frame.rows * frame.columns;
        assert!(right.len() == cells && values.len() == cells, "one number a cell");
        if cells == 0 {
            return Convergence { iterations: 0, error: 0.0, converged: true };
        }
        let mut state = State::new(&self.operator, right, values, workspace);
        let mut convergence = Convergence { iterations: 0, error: f64::INFINITY, converged: false };
        let (mut before, mut product) = (f64::INFINITY, 0.0);
        while convergence.iterations < MOST_ITERATIONS {
            if state.largest == 0.0 {
                convergence.error = 0.0;
            }
            if convergence.error <= tolerance {
                convergence.converged = true;
                break;
            }
            self.hierarchy.cycle(&self.operator, &mut state.work.stack);
            let next = state.preconditioned_product();
            let energy = state.turn(if product > 0.0 { next / product } else { 0.0 });
            let (true, true) = (next > 0.0, energy > 0.0) else { break };
            product = next;
            let (change, greatest) = state.step(product / energy);
            convergence.iterations += 1;
            let ratio = (change / before).max(LEAST_RATIO);
            before = change;
            if ratio < 1.0 {
                convergence.error = change / greatest * ratio / (1.0 - ratio);
            }
        }
        for (i, values) in values.chunks_exact_mut(frame.columns).enumerate() {
            values.copy_from_slice(&workspace.values[frame.row(i)][..frame.columns]);
        }
        convergence
    }

    /// The field of a single goal: 1 there, harmonic elsewhere, 0 where it is cut off. `values` is start and result; a
    /// field of the same goal among slightly different walls is a good start.
    ///
    /// # Panics
    /// If a length is not the number of cells, or the workspace is of another grid.
    pub fn goal(&self, goal: usize, values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        let mut right = vec![0.0; values.len()];
        right[goal] = 1.0;
        let convergence = self.solve(&right, values, tolerance, workspace);
        let scale = values[goal];
        if scale > 0.0 {
            values.iter_mut().for_each(|value| *value /= scale);
        }
        convergence
    }
}

/// What is put on the diagonal where nothing else keeps the problem from being singular.
const SHIFT: f64 = 1e-6;

/// The vectors of conjugate gradients in the course of a solve.
struct State<'a> {
    operator: &'a FivePoint,
    work: &'a mut Workspace,
    /// Greatest residual.
    largest: f64,
    /// The residual is given to the preconditioner times this, which makes the greatest of the start 1.
    scale: f64,
}

impl<'a> State<'a> {
    fn new(operator: &'a FivePoint, right: &[f64], values: &[f64], work: &'a mut Workspace) -> Self {
        let frame = operator.frame;
        for (i, (right, values)) in
            right.chunks_exact(frame.columns).zip(values.chunks_exact(frame.columns)).enumerate()
        {
            let row = frame.row(i);
            let free = &operator.free[row.clone()];
            for ((to, &from), &free) in work.values[row.clone()].iter_mut().zip(values).zip(free) {
                *to = if free > 0.0 { from } else { 0.0 };
            }
            for ((to, &from), &free) in work.residual[row.clone()].iter_mut().zip(right).zip(free) {
                *to = if free > 0.0 { from } else { 0.0 };
            }
            work.direction[row].fill(0.0);
        }
        frame.finish(&mut work.values);
        let mut largest = 0.0_f64;
        for i in 0..frame.rows {
            let [above, middle, below] = frame.three(&work.values, i);
            let row = frame.row(i);
            let free = &operator.free[row.clone()];
            for (j, (residual, &free)) in work.residual[row].iter_mut().zip(free).enumerate().take(frame.columns) {
                let around = (middle[j] + middle[j + 2]) + (above[j + 1] + below[j + 1]);
                if free > 0.0 {
                    *residual -= operator.degree * middle[j + 1] - around;
                }
                largest = largest.max(residual.abs());
            }
        }
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let state = Self { operator, work, largest, scale };
        for i in 0..frame.rows {
            let row = frame.row(i);
            let right = &mut state.work.stack.levels[0].right[row.clone()];
            for (right, &residual) in right.iter_mut().zip(&state.work.residual[row]) {
                *right = single(residual * scale);
            }
        }
        frame.finish(&mut state.work.stack.levels[0].right);
        state
    }

    /// Residual times what the preconditioner made of it.
    fn preconditioned_product(&self) -> f64 {
        let frame = self.operator.frame;
        let finest = &self.work.stack.levels[0];
        let mut sums = [0.0; LANES];
        for i in 0..frame.rows {
            let range = frame.row(i).start..frame.row(i).start + frame.columns;
            let (a, a_rest) = finest.right[range.clone()].as_chunks::<LANES>();
            let (b, b_rest) = finest.solution[range].as_chunks::<LANES>();
            for (a, b) in a.iter().zip(b) {
                for k in 0..LANES {
                    sums[k] += f64::from(a[k]) * f64::from(b[k]);
                }
            }
            for ((sum, a), b) in sums.iter_mut().zip(a_rest).zip(b_rest) {
                *sum += f64::from(*a) * f64::from(*b);
            }
        }
        sums.iter().sum::<f64>() / (self.scale * self.scale)
    }

    /// Takes the next direction; its energy, `p . A p`.
    fn turn(&mut self, beta: f64) -> f64 {
        let frame = self.operator.frame;
        let inverse = 1.0 / self.scale;
        let finest = &self.work.stack.levels[0].solution;
        let direction = &mut self.work.direction;
        for i in 0..frame.rows {
            let row = frame.row(i);
            for (p, &z) in direction[row.clone()].iter_mut().zip(&finest[row]) {
                *p = f64::from(z) * inverse + beta * *p;
            }
            frame.finish_row(direction, i);
        }
        let mut sums = [0.0; LANES];
        for i in 0..frame.rows {
            let [above, middle, below] = frame.three(direction, i);
            let n = frame.columns;
            let (west, east) = (&middle[..n], &middle[2..2 + n]);
            let (above, middle, below) = (&above[1..=n], &middle[1..=n], &below[1..=n]);
            let energy = |j: usize| {
                let around = (west[j] + east[j]) + (above[j] + below[j]);
                middle[j] * (self.operator.degree * middle[j] - around)
            };
            let whole = n - n % LANES;
            for j in (0..whole).step_by(LANES) {
                for (k, sum) in sums.iter_mut().enumerate() {
                    *sum += energy(j + k);
                }
            }
            for j in whole..n {
                sums[j - whole] += energy(j);
            }
        }
        sums.iter().sum()
    }

    /// Goes `alpha` along the direction; the greatest change and the greatest value.
    fn step(&mut self, alpha: f64) -> (f64, f64) {
        let frame = self.operator.frame;
        let degree = self.operator.degree;
        let scale = self.scale;
        let Workspace { stack, values, residual, direction } = &mut *self.work;
        let right = &mut stack.levels[0].right;
        let (mut change, mut greatest, mut largest) = ([0.0_f64; LANES], [0.0_f64; LANES], [0.0_f32; LANES]);
        for i in 0..frame.rows {
            let [above, middle, below] = frame.three(direction, i);
            let n = frame.columns;
            let start = frame.row(i).start;
            let (west, east) = (&middle[..n], &middle[2..2 + n]);
            let (above, middle, below) = (&above[1..=n], &middle[1..=n], &below[1..=n]);
            let (values, residual) = (&mut values[start..start + n], &mut residual[start..start + n]);
            let (right_row, free) = (&mut right[start..start + n], &self.operator.free[start..start + n]);
            let mut at = |j: usize, k: usize| {
                let moved = alpha * middle[j];
                values[j] += moved;
                change[k] = change[k].max(moved.abs());
                greatest[k] = greatest[k].max(values[j].abs());
                let around = (west[j] + east[j]) + (above[j] + below[j]);
                residual[j] -= alpha * (degree * middle[j] - around);
                right_row[j] = single(residual[j] * scale) * free[j];
                largest[k] = largest[k].max(right_row[j].abs());
            };
            let whole = n - n % LANES;
            for j in (0..whole).step_by(LANES) {
                for k in 0..LANES {
                    at(j + k, k);
                }
            }
            for j in whole..n {
                at(j, j - whole);
            }
            frame.finish_row(right, i);
        }
        self.largest = f64::from(largest.into_iter().fold(0.0, f32::max)) / scale;
        (change.into_iter().fold(0.0, f64::max), greatest.into_iter().fold(0.0, f64::max))
    }
}

/// In single precision.
fn single(x: f64) -> f32 {
    let x = x as f32;
    if x.abs() < NEGLIGIBLE { 0.0 } else { x }
}
