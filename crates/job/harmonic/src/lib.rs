//! The harmonic potential of goals on a grid, with full relative precision at any distance, and the curve along its gradient.
//!
//! # The problem
//!
//! A grid has free cells and walls, and its axes are intervals or circles. The potential of a cell is the probability that a
//! random walk from it reaches a goal before it reaches a wall or crosses a limit. It is 1 at the goals, 0 at walls, and
//! elsewhere the mean of the four neighbours.
//!
//! The potential has no local maximum except the goals, so steepest ascent leads to a goal from everywhere (Connolly, Grupen
//! 1993). But it falls by a factor of 3.7 per cell in a narrow corridor, soon far below the range of doubles. Usual solvers find
//! 0 there, and no path. Here each value has its own exponent and the precision of a double, even at `1e-50000`.
//!
//! ```
//! use cplan_harmonic::follow::follow;
//! use cplan_harmonic::{Component, Lattice, PotentialGuide, harmonic};
//!
//! // A corridor of 3000 cells with a bend, one cell wide: `true` is wall.
//! let (rows, columns) = (2, 1500);
//! let mut blocked = vec![false; (rows + 1) * columns];
//! blocked[columns..2 * columns - 1].fill(true);
//! let lattice = Lattice::new([rows + 1, columns], [false, false], &blocked);
//!
//! // From the goal, cell 0, a wave finds the cells that are connected with it.
//! let component = Component::new(&lattice, lattice.wave(&[0]));
//! let field = harmonic(&component);
//! let start = component.position_of(2 * columns).unwrap();
//! assert!(field.potential.ln(start) < -3000.0, "far below the least double, e^-745");
//!
//! // Each cell has a strictly greater neighbour: up from cell to cell, ...
//! assert!(field.potential.navigates(&component));
//! let cells = field.potential.ascend(&component, start).unwrap();
//! assert_eq!(cells.len(), 2 * columns + 1);
//!
//! // ... or along the gradient, between the cells.
//! let at = |[i, j]: [i64; 2]| {
//!     let inside = (0..=rows as i64).contains(&i) && (0..columns as i64).contains(&j);
//!     inside.then(|| component.position_of(i as usize * columns + j as usize))?
//! };
//! let curve = follow(&mut PotentialGuide::new(&component, &field.potential, at), [1.0, 1.0], [2.0, 0.0]).unwrap();
//! assert_eq!(curve.place, [0, 0]);
//! ```
//!
//! # Cost and guarantees
//!
//! - Linear in the number of cells, independent of the values: about 300 ns per cell in mazes and corridors. Wide rooms cost a
//!   few solves by [`Multigrid`](cplan_multigrid::Multigrid).
//! - Each value agrees with the one that its neighbours imply to 64 relative roundings ([`residual`]).
//! - Every cell except the goals has a strictly greater neighbour, compared exactly ([`Potential::navigates`]). This holds even
//!   where symmetry makes the harmonic function level, because at each step a walk ends with probability `3e-14`. That exceeds
//!   all rounding errors, and lowers a value ten million steps away by less than a millionth.
//! - [`follow`](follow::follow) stays in free cells and ends at a goal: where the gradient does not lead on, it moves from cell
//!   to cell. It works with any field that implements [`Guide`](follow::Guide).
//! - The same input gives the same bits. Long solves can be interrupted: they pass a [`checkpoint`](cplan_interrupt::checkpoint).
//!
//! # Method
//!
//! ```text
//! Lattice -> wave -> Component -> windows in order of falling values (peeling) -> elimination (network) or multigrid (wide)
//!         -> Potential -> its slope at the cells' centres (streamline), for `follow`
//! ```
//!
//! The potential is solved in *windows* in order of falling values (`peeling`), each scaled to its own greatest value. Except in
//! mazes, a single window has all cells.
//!
//! For each cell of a window, the solver also computes the probability that a walk leaves the window where it was cut off. This
//! bounds the part that is missing in the cell's value. Only values with a negligible missing part are accepted.
//!
//! Narrow windows are eliminated without subtractions (`network`). Wide ones are solved by multigrid and refined until each value
//! agrees with its neighbours to 64 relative roundings (`wide`). All cells above a quarter of this are corrected, so that
//! rounding cannot push a cell across the bound.
#![forbid(unsafe_code)]

mod component;
mod extent;
mod field_path;
pub mod follow;
mod lattice;
mod laplace;
mod network;
mod peeling;
mod planner;
mod potential;
mod simplify;
mod streamline;
mod wide;

pub use component::{Component, Room};
pub use field_path::path_along_field;
pub use laplace::{Field, estimated_harmonic, harmonic, harmonic_path, residual};
pub use lattice::{Lattice, Wave};
pub use planner::Harmonic;
pub use potential::Potential;
pub use streamline::{LocalMaximum, PotentialGuide};
