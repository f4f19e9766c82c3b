//! A fast solver for five-point problems among walls: conjugate gradients, preconditioned by multigrid.
//!
//! # The problem
//!
//! A grid has free cells and walls. For every free cell, `(degree + shift) u - sum of the free neighbours' u = b`. The degree is
//! 4. Walls and high limits have value 0. Beyond each end of the grid, [`Ends`] applies, and a reflecting limit lowers the degree
//! by 1.
//!
//! This is Poisson's equation, or Helmholtz's if the shift is positive. If `b = 0` except at a goal, it is Laplace's. A goal `g`
//! among walls takes one solve: `A^-1 e_g`, divided by its value at `g` ([`Multigrid::goal`]). So the hierarchy of levels, which
//! depends only on the walls, serves all goals. Cells with known values count as walls; add the values to `b` of their free
//! neighbours.
//!
//! ```
//! use cplan_multigrid::{Ends, Multigrid};
//!
//! // Two rooms of 40 x 40 cells, joined by a door, on a ring: its last column lies beside the first.
//! let cells = [40, 81];
//! let free: Vec<bool> = (0..cells[0] * cells[1]).map(|at| at % 81 != 40 || at / 81 == 12).collect();
//! let solver = Multigrid::new(cells, [Ends::High, Ends::Joined], &free, 0.0);
//!
//! // The chance that a random walk comes to the goal before it comes to a wall.
//! let goal = 20 * 81 + 60;
//! let mut values = vec![0.0; free.len()];
//! let mut workspace = solver.workspace();
//! let done = solver.goal(goal, &mut values, 1e-9, &mut workspace);
//! assert!(done.converged && done.iterations < 12);
//!
//! let at = |i: usize, j: usize| values[i * 81 + j];
//! let mean = (at(5, 9) + at(7, 9) + at(6, 8) + at(6, 10)) / 4.0;
//! assert!((at(6, 9) - mean).abs() < 1e-9 && at(6, 9) > 0.0);
//! ```
//!
//! # Cost and guarantees
//!
//! The construction of the solver and each step take time linear in the number of cells. 4 to 8 steps give an error of `1e-6` of
//! the greatest value, whatever the size and the walls: about 60 ns per cell from walls to field on one core. The solver and a
//! [`Workspace`], which can be reused, need memory for a few numbers per cell. The field among slightly different walls is a good
//! initial guess.
//!
//! The error in [`Convergence`] is an estimate from the decrease of the last steps, and `converged` states whether it reached the
//! tolerance. It is relative to the greatest value, so small values far away have fewer correct digits. (With the crate
//! `cplan-harmonic`, all values have the same number of them.)
//!
//! The same input gives the same bits on every machine, with vector instructions (AVX2, detected at run time) and without. There
//! are no other threads. Long solves can be interrupted: they pass a [`checkpoint`](cplan_interrupt::checkpoint).
//!
//! # Method
//!
//! Cells are coloured like a chessboard (`red_black`). The cells of one colour are eliminated, which leaves half of the unknowns.
//! Conjugate gradients for these run in rounds: vectors are in single precision; the residual at the start of each round, the
//! values, and the products with the operator are in double precision. The preconditioner is one V-cycle in single precision,
//! whose rounding errors cost steps, but no accuracy.
#![forbid(unsafe_code)]

mod band;
mod red_black;
mod cycle;
mod envelope;
mod frame;
mod galerkin;
mod machine;
#[cfg(target_arch = "x86_64")]
mod avx;
mod seam;
mod smooth;
mod around;
mod conjugate;
mod solve;
mod stencil;
mod transfer;

pub use conjugate::Workspace;
pub use frame::Ends;
pub use solve::{Convergence, Multigrid};
