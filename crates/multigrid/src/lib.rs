//! Five-point problems among walls, solved fast and to what one asks for: conjugate gradients, preconditioned by multigrid.
//!
//! # The problem
//!
//! A grid of cells, some of them free, the others walls. For every free cell,
//! `(degree + shift) u - sum of the free neighbours' u = b`. The degree is 4, walls and high limits count as 0; beyond each
//! end of the grid lies what [`Ends`] says, and a reflecting limit takes 1 off the degree. That is Poisson's equation (with a
//! shift, Helmholtz's with the good sign); with `b = 0` but at a goal it is Laplace's. A goal `g` among walls is one solve,
//! `A^-1 e_g` divided by its value at `g` ([`Multigrid::goal`]), so that the hierarchy of levels, which depends on the walls
//! alone, serves all goals. Cells whose value is known are walls to it, and come in through the right-hand side: add the value
//! to `b` of each free neighbour.
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
//! # What it costs, and what holds
//!
//! Building the solver and each of its steps are linear in the number of cells; 4 to 8 steps come to an error of `1e-6` of the
//! greatest value, whatever the size and the walls: some 60 ns a cell from walls to field on one core. Memory is a few numbers
//! a cell, kept in the solver and in a [`Workspace`] that is used again from solve to solve. A field of slightly different walls
//! is a good start for the next.
//!
//! The error that a [`Convergence`] names is an estimate, from how the last steps shrank, and what the tolerance is held to;
//! it is of the greatest value, so that small values far away have fewer digits (the crate `cplan-harmonic` gives all
//! of them the same). `converged` says whether the tolerance was met. The same input gives the same bits on
//! every machine, with vector instructions (AVX2, told at run time) and without. Nothing runs on other threads. Long
//! solves can be stopped from outside: they come by a [`checkpoint`](cplan_interrupt::checkpoint).
//!
//! # How
//!
//! Cells are coloured like a chessboard (`red_black`); those of one colour are eliminated, which leaves half of the unknowns.
//! Conjugate gradients for these run in rounds: vectors are in single precision, the residual at the start of each round,
//! the values, and the products with the operator in double precision. The preconditioner, one V-cycle in single precision,
//! need not be precise: it costs steps, not digits.
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
