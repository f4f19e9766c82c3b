//! Fast exact solution of the five-point problem among walls: conjugate gradients, preconditioned by multigrid.
//!
//! For every free cell, `(degree + shift) u - sum of the free neighbours' u = b`. The degree is 4, walls and high limits
//! count as 0; a reflecting limit takes 1 off it. With `b = 0` but at a goal that is Laplace's equation; a goal `g` among
//! walls is one solve, `A^-1 e_g` divided by its value at `g` ([`Multigrid::goal`]), so that the hierarchy of levels,
//! which depends on the walls alone, serves all goals. Cells whose value is known are walls to it, and come in through the
//! right-hand side: add the value to `b` of each free neighbour.
//!
//! Cells are coloured like a chessboard (`red_black`); those of one colour are eliminated, which leaves half of the unknowns.
//! Conjugate gradients for these run in rounds: vectors are in single precision, the residual at the start of each round,
//! the values, and the products with the operator in double precision. The preconditioner, one V-cycle in single precision,
//! need not be precise: it costs steps, not digits.

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
