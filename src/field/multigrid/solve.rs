//! Conjugate gradients.

use super::conjugate::{Right, State};
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

/// Vectors that a solve works with, kept from one solve to the next, also of other walls on a grid of the same shape. About 32 bytes a cell.
#[derive(Debug, Clone)]
pub struct Workspace {
    pub(super) stack: Stack,
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
        Workspace { stack, residual: zeros(), direction: zeros() }
    }

    /// Solves for the right-hand side `right`, from the start that is in `values`, which must be finite; walls are
    /// neither read nor (but as 0) written. Ends when no value is likely to be wrong by more than `tolerance` times the
    /// greatest.
    ///
    /// Takes 4 to 8 iterations from zero for a tolerance of `1e-6`, whatever the size and the walls.
    ///
    /// # Panics
    /// If a length is not the number of cells, or the workspace is of another grid.
    pub fn solve(&self, right: &[f64], values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        assert!(right.len() == self.cells(), "one number a cell");
        self.solve_for(Right::Given(right), values, tolerance, workspace)
    }

    fn cells(&self) -> usize {
        self.operator.frame.rows * self.operator.frame.columns
    }

    fn solve_for(&self, right: Right, values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        assert!(values.len() == self.cells(), "one number a cell");
        assert!(workspace.residual.len() == self.operator.frame.len(), "a workspace of this grid");
        if values.is_empty() {
            return Convergence { iterations: 0, error: 0.0, converged: true };
        }
        on_this_machine!(m => self.iterate(m, right, values, tolerance, workspace))
    }

    /// The iteration, on a machine.
    fn iterate<M: Machine>(
        &self,
        m: M,
        right: Right,
        values: &mut [f64],
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
            let scaled = self.hierarchy.cycle(m, &self.operator, &mut state.work.stack);
            let next = state.unscaled(scaled);
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
    /// If a length is not the number of cells, the goal no cell, or the workspace of another grid.
    pub fn goal(&self, goal: usize, values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        let convergence = self.solve_for(Right::Unit(goal), values, tolerance, workspace);
        let scale = values[goal];
        if scale > 0.0 {
            values.iter_mut().for_each(|value| *value /= scale);
        }
        convergence
    }
}

/// What is put on the diagonal where nothing else keeps the problem from being singular.
const SHIFT: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn vector_instructions_change_no_bit() {
        let Some(fast) = pulp::x86::V3::try_new() else {
            return;
        };
        let cells = [61, 83];
        let free: Vec<bool> = (0..cells[0] * cells[1]).map(|at| at * 7 % 11 != 0 && at % 29 > 2).collect();
        for ends in [[Ends::High; 2], [Ends::Joined; 2], [Ends::Reflecting, Ends::Joined]] {
            let mut solver = Multigrid::new(cells, ends, &free, 0.0);
            let [mut plain, mut vectors] = [0; 2].map(|_| vec![0.0; free.len()]);
            let goal = Right::Unit(2000);
            solver.hierarchy = Hierarchy::new(Portable, &solver.operator);
            let one = solver.iterate(Portable, goal, &mut plain, 1e-9, &mut solver.workspace());
            solver.hierarchy = Hierarchy::new(fast, &solver.operator);
            let other = solver.iterate(fast, goal, &mut vectors, 1e-9, &mut solver.workspace());
            assert_eq!(one, other);
            assert_eq!(plain, vectors);
        }
    }

    /// What conjugate gradients ask of a preconditioner, up to rounding in single precision.
    #[test]
    fn a_cycle_is_symmetric_and_positive_definite() {
        let cells = [45, 37];
        let free: Vec<bool> = (0..cells[0] * cells[1]).map(|at| at * 5 % 17 != 0 && at % 31 > 1).collect();
        for ends in [[Ends::High; 2], [Ends::Joined; 2], [Ends::Joined, Ends::Reflecting]] {
            let solver = Multigrid::new(cells, ends, &free, 0.0);
            let frame = solver.operator.frame;
            let vector = |seed: usize| {
                let mut vector = vec![0.0_f32; frame.len()];
                for i in 0..cells[0] {
                    for j in 0..cells[1] {
                        let random = ((i * 37 + j + seed) as f32 * 0.618_034).fract() - 0.5;
                        vector[frame.row(i).start + j] = random * solver.operator.free[frame.row(i).start + j];
                    }
                }
                frame.finish(&mut vector);
                vector
            };
            let cycle = |right: &[f32]| {
                let mut stack = solver.hierarchy.stack(frame);
                stack.levels[0].right.copy_from_slice(right);
                solver.hierarchy.cycle(Portable, &solver.operator, &mut stack);
                stack.levels.swap_remove(0).solution
            };
            let dot = |a: &[f32], b: &[f32]| -> f64 {
                let row = |i: usize| frame.row(i).start..frame.row(i).start + cells[1];
                let cells = (0..cells[0]).flat_map(row);
                cells.map(|at| f64::from(a[at]) * f64::from(b[at])).sum()
            };
            for seed in 0..8 {
                let (x, y) = (vector(seed), vector(seed * 101 + 50));
                let (zx, zy) = (cycle(&x), cycle(&y));
                assert!(dot(&x, &zx) > 0.0 && dot(&y, &zy) > 0.0);
                let size = (dot(&x, &zx) * dot(&y, &zy)).sqrt();
                assert!((dot(&x, &zy) - dot(&y, &zx)).abs() < 1e-5 * size, "{} {}", dot(&x, &zy), dot(&y, &zx));
            }
        }
    }
}
