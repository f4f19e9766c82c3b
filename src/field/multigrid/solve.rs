//! Conjugate gradients.

use super::conjugate::State;
use super::cycle::{Hierarchy, Stack};
use super::frame::{Ends, Frame};
use super::machine::{Machine, Portable};
use super::stencil::FivePoint;

/// Evaluates an expression with the best machine that there is.
macro_rules! on_this_machine {
    ($machine:ident => $run:expr) => {{
        #[cfg(target_arch = "x86_64")]
        if let Some($machine) = pulp::x86::V3::try_new() {
            $run
        } else {
            let $machine = Portable;
            $run
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let $machine = Portable;
            $run
        }
    }};
}

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
    pub(super) stack: Stack,
    pub(super) values: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) direction: Vec<f64>,
}

/// More steps than this are never needed: each gains a digit or nearly so.
const MOST_ITERATIONS: usize = 100;

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
        let hierarchy = on_this_machine!(m => Hierarchy::new(m, &operator));
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
        let convergence = on_this_machine!(m => self.iterate(m, right, values, tolerance, workspace));
        for (i, values) in values.chunks_exact_mut(frame.columns).enumerate() {
            values.copy_from_slice(&workspace.values[frame.row(i)][..frame.columns]);
        }
        convergence
    }

    /// The iteration, on a machine.
    fn iterate<M: Machine>(
        &self,
        m: M,
        right: &[f64],
        values: &[f64],
        tolerance: f64,
        workspace: &mut Workspace,
    ) -> Convergence {
        let mut state = State::new(m, &self.operator, right, values, workspace);
        let mut convergence = Convergence { iterations: 0, error: f64::INFINITY, converged: false };
        let (mut before, mut product) = (f64::INFINITY, 0.0);
        while convergence.iterations < MOST_ITERATIONS {
            if convergence.error <= tolerance {
                convergence.converged = true;
                break;
            }
            self.hierarchy.cycle(m, &self.operator, &mut state.work.stack);
            let next = state.preconditioned_product();
            if next == 0.0 {
                convergence = Convergence { error: 0.0, converged: true, ..convergence };
                break;
            }
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
