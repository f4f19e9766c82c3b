//! Conjugate gradients.

use super::conjugate::{Step, Workspace};
use super::cycle::{Hierarchy, Stack};
use super::frame::{Ends, Frame};
use super::machine::{Machine, Portable};
use super::red_black::RedBlack;
use super::stencil::FivePoint;
use cplan_interrupt::checkpoint;

/// Evaluates an expression with the fastest machine that the processor supports.
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

/// The solver for a grid with certain walls.
#[derive(Debug, Clone)]
pub struct Multigrid {
    red_black: RedBlack,
    /// The hierarchy of levels; `None` if there are no cells.
    hierarchy: Option<Hierarchy>,
}

/// Result of a solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Number of steps of conjugate gradients, each with one V-cycle.
    pub iterations: usize,
    /// Estimate of the greatest error of a value, relative to the greatest value.
    pub error: f64,
    /// True if `error` is below the tolerance. If false, rounding ended the progress.
    pub converged: bool,
}

/// Largest number of iterations. Each gains about a decimal digit, so more are never useful.
const MAX_ITERATIONS: usize = 100;

/// Rounding error of sums in single precision, relative to the greatest value.
const SINGLE_ROUNDING: f64 = 1e-7;

/// If more than this fraction of the residual remains after a round, only rounding errors remain.
const MIN_PROGRESS: f64 = 0.5;

/// Least assumed ratio of two consecutive changes. The error is estimated from the last two changes, as the rest of a geometric
/// series. By chance, a single step may change values only little, and the ratio would be too small.
const MIN_RATIO: f64 = 0.1;

impl Multigrid {
    /// Builds the solver for `cells` rows and columns, with `free` row by row. Linear in the number of cells.
    ///
    /// Without walls, high limits and shift, solutions exist only if `b` sums to 0, and are unique only up to a constant. Then a
    /// shift of `1e-6` per cell is used.
    ///
    /// # Panics
    /// If the length of `free` is not the product of `cells`, or `shift` is negative or not finite.
    pub fn new(cells: [usize; 2], ends: [Ends; 2], free: &[bool], shift: f64) -> Self {
        assert_eq!(free.len(), cells[0] * cells[1], "one flag a cell");
        assert!(shift >= 0.0 && shift.is_finite(), "a shift is not negative");
        let operator = operator(cells, ends, free, shift);
        let hierarchy = (!free.is_empty()).then(|| on_this_machine!(m => Hierarchy::new(m, &operator)));
        Self { red_black: RedBlack::new(cells, ends, free, operator.degree), hierarchy }
    }

    /// Allocates a workspace for solves.
    pub fn workspace(&self) -> Workspace {
        Workspace::new(&self.red_black, self.hierarchy.as_ref().map_or_else(Stack::default, Hierarchy::stack))
    }

    /// Solves for the right-hand side `right`, starting from `values`, which must be finite. Walls are not read, and get the
    /// value 0. Stops when the estimated error is at most `tolerance` times the greatest value.
    ///
    /// Starting from zero, a tolerance of `1e-6` takes 4 to 8 iterations, whatever the size and the walls.
    ///
    /// # Panics
    /// If a length is not the number of cells, or the workspace is for another grid.
    pub fn solve(&self, right: &[f64], values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        let cells = self.red_black.shape.rows * self.red_black.shape.columns;
        assert!(right.len() == cells && values.len() == cells, "one number a cell");
        assert!(workspace.is_for(&self.red_black), "a workspace of this grid");
        match &self.hierarchy {
            Some(hierarchy) => {
                on_this_machine!(m => self.rounds(m, hierarchy, right, values, tolerance, workspace))
            }
            None => Convergence { iterations: 0, error: 0.0, converged: true },
        }
    }

    /// Runs rounds of conjugate gradients. Each begins by computing the residual.
    fn rounds<M: Machine>(
        &self,
        m: M,
        hierarchy: &Hierarchy,
        right: &[f64],
        values: &mut [f64],
        tolerance: f64,
        workspace: &mut Workspace,
    ) -> Convergence {
        let red_black = &self.red_black;
        let mut convergence = Convergence { iterations: 0, error: f64::INFINITY, converged: false };
        // A power of two brings the residual into the range of single precision.
        let mut scale = power_of_two(right.iter().chain(&*values).map(|x| x.abs()).fold(0.0, f64::max));
        workspace.clear_steps();
        let mut start = workspace.correct(m, red_black, right, values, 0.0, Some(scale));
        let mut residual = start.change / scale;
        loop {
            let by = power_of_two(start.change);
            if by != 1.0 {
                workspace.residual.data.iter_mut().for_each(|x| *x *= by as f32);
                scale *= by;
            }
            let error =
                self.round(m, hierarchy, start.value * scale, tolerance, workspace, &mut convergence.iterations);
            let greatest = workspace.correct(m, red_black, right, values, 1.0 / scale, None).value;
            convergence.error = if greatest > 0.0 { error / scale / greatest } else { 0.0 };
            convergence.converged = convergence.error <= tolerance;
            if convergence.converged || convergence.iterations >= MAX_ITERATIONS {
                return convergence;
            }
            workspace.clear_steps();
            start = workspace.correct(m, red_black, right, values, 0.0, Some(scale));
            if start.change / scale > MIN_PROGRESS * residual {
                return convergence;
            }
            residual = start.change / scale;
        }
    }

    /// Takes steps until the tolerance is reached, or until single precision prevents further progress. Returns the
    /// estimated error. `greatest` is the greatest value before the round.
    fn round<M: Machine>(
        &self,
        m: M,
        hierarchy: &Hierarchy,
        greatest: f64,
        tolerance: f64,
        workspace: &mut Workspace,
        iterations: &mut usize,
    ) -> f64 {
        let (mut before, mut product, mut energy) = (f64::INFINITY, 0.0, 0.0);
        let (mut error, mut step) = (f64::INFINITY, None);
        loop {
            checkpoint();
            let moved = workspace.descend(m, &self.red_black, &hierarchy.corners, step);
            if step.is_some() {
                *iterations += 1;
                let ratio = (moved.change / before).max(MIN_RATIO);
                before = moved.change;
                let rounding = SINGLE_ROUNDING * moved.value;
                error = if ratio < 1.0 { moved.change * ratio / (1.0 - ratio) + rounding } else { f64::INFINITY };
                let enough = error <= tolerance * greatest.max(moved.value) || error <= 2.0 * rounding;
                if enough || *iterations >= MAX_ITERATIONS {
                    return error;
                }
            }
            hierarchy.cycle(m, &mut workspace.stack);
            let [next, image] = workspace.ascend(m, &self.red_black, &hierarchy.corners);
            if next == 0.0 {
                return if step.is_some() { error } else { 0.0 };
            }
            let beta = if product > 0.0 { next / product } else { 0.0 };
            // Directions are conjugate, so the energy of the advice is the sum of those of its part along the last direction and
            // of the rest.
            energy = image - beta * beta * energy;
            let (true, true) = (next > 0.0, energy > 0.0) else { return error };
            product = next;
            step = Some(Step { alpha: product / energy, beta });
        }
    }

    /// Solves for the field of a single goal: 1 there, harmonic elsewhere, 0 where it is cut off. `values` is the
    /// initial guess and receives the result. The field of the same goal among slightly different walls is a good
    /// initial guess.
    ///
    /// # Panics
    /// If a length is not the number of cells, the goal is not a cell, or the workspace is for another grid.
    pub fn goal(&self, goal: usize, values: &mut [f64], tolerance: f64, workspace: &mut Workspace) -> Convergence {
        let mut right = vec![0.0; values.len()];
        right[goal] = 1.0;
        // The best initial guess is proportional to the solution: with `A u = e`, `(A u)` at the goal is 1.
        let free = |cell: &usize| self.red_black.is_free(*cell);
        let around: f64 = self.red_black.neighbors(goal).filter(free).map(|other| values[other]).sum();
        let source = self.red_black.degree * values[goal] - around;
        if free(&goal) && source > 0.0 {
            values.iter_mut().for_each(|value| *value /= source);
        }
        let convergence = self.solve(&right, values, tolerance, workspace);
        let scale = values[goal];
        if scale > 0.0 {
            values.iter_mut().for_each(|value| *value /= scale);
        }
        convergence
    }
}

/// Shift added to the diagonal if the problem would otherwise be singular.
const DIAGONAL_SHIFT: f64 = 1e-6;

/// Builds the operator.
fn operator(cells: [usize; 2], ends: [Ends; 2], free: &[bool], shift: f64) -> FivePoint {
    let frame = Frame::new(cells, ends);
    let mut operator = FivePoint { frame, degree: 4.0 + shift, free: vec![0.0; frame.len()] };
    for (i, free) in free.chunks_exact(cells[1].max(1)).enumerate() {
        let row = &mut operator.free[frame.row(i)];
        row.iter_mut().zip(free).for_each(|(to, &free)| *to = f32::from(u8::from(free)));
    }
    frame.of_coefficients().finish(&mut operator.free);
    if operator.is_singular() {
        operator.degree += DIAGONAL_SHIFT;
    }
    operator
}

/// Returns the power of 2 that scales a number to about 1. Returns 1 for 0.
fn power_of_two(x: f64) -> f64 {
    if x > 0.0 && x.is_finite() { (-x.log2().floor()).exp2() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::band::Band;
    use crate::machine::LANES;

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn vector_instructions_change_no_bit() {
        let Some(fast) = pulp::x86::V3::try_new() else {
            return;
        };
        let cells = [61, 83];
        let free: Vec<bool> = (0..cells[0] * cells[1]).map(|at| at * 7 % 11 != 0 && at % 29 > 2).collect();
        for ends in [[Ends::High; 2], [Ends::Joined; 2], [Ends::Reflecting, Ends::Joined]] {
            let solver = Multigrid::new(cells, ends, &free, 0.0);
            let operator = operator(cells, ends, &free, 0.0);
            let [mut plain, mut vectors] = [0; 2].map(|_| vec![0.0; free.len()]);
            let mut right = vec![0.0; free.len()];
            right[2000] = 1.0;
            let hierarchy = Hierarchy::new(Portable, &operator);
            let one = solver.rounds(Portable, &hierarchy, &right, &mut plain, 1e-9, &mut solver.workspace());
            let hierarchy = Hierarchy::new(fast, &operator);
            let other = solver.rounds(fast, &hierarchy, &right, &mut vectors, 1e-9, &mut solver.workspace());
            assert_eq!(one, other);
            assert_eq!(plain, vectors);
        }
    }

    /// Tests that the preconditioner is symmetric and positive definite, up to rounding in single precision.
    #[test]
    fn a_cycle_is_symmetric_and_positive_definite() {
        let cells = [45, 37];
        let free: Vec<bool> = (0..cells[0] * cells[1]).map(|at| at * 5 % 17 != 0 && at % 31 > 1).collect();
        for ends in [[Ends::High; 2], [Ends::Joined; 2], [Ends::Joined, Ends::Reflecting]] {
            let solver = Multigrid::new(cells, ends, &free, 0.0);
            let red_black = &solver.red_black;
            let count = red_black.count();
            let hierarchy = solver.hierarchy.as_ref().expect("cells");
            let vector = |seed: usize| {
                let mut vector = red_black.band();
                for i in 0..cells[0] {
                    for (j, (to, free)) in
                        vector.row_mut(i, count).iter_mut().zip(red_black.even.row(i, count)).enumerate()
                    {
                        for k in 0..LANES {
                            to[k] = (((i * 37 + j * LANES + k + seed) as f32 * 0.618_034).fract() - 0.5) * free[k];
                        }
                    }
                    red_black.frame_even(&mut vector, i);
                }
                vector
            };
            let dot = |a: &Band<f32>, b: &Band<f32>| -> f64 {
                let row = |i: usize| a.row(i, count).as_flattened().iter().zip(b.row(i, count).as_flattened());
                (0..cells[0]).flat_map(row).map(|(&a, &b)| f64::from(a) * f64::from(b)).sum()
            };
            let cycle = |residual: &Band<f32>| {
                let mut workspace = solver.workspace();
                workspace.residual = residual.clone();
                workspace.descend(Portable, red_black, &hierarchy.corners, None);
                hierarchy.cycle(Portable, &mut workspace.stack);
                let [product, _] = workspace.ascend(Portable, red_black, &hierarchy.corners);
                assert!((product - dot(residual, &workspace.advice)).abs() < 1e-12 * product);
                workspace.advice
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
