//! The harmonic potential of a goal on a grid, in relative precision at any distance, and the curve up its gradient.
//!
//! # The problem
//!
//! A grid of free cells and walls, whose axes are intervals or circles. The potential of a cell is the probability that a
//! random walk from it comes to a goal before it comes to a wall or over a limit: 1 at the goals, 0 at walls, elsewhere the
//! mean of the four neighbours. It has no local maximum but the goals, so that going up it leads there from everywhere
//! (Connolly, Grupen 1993). But it falls by a factor of 3.7 a cell in a narrow corridor, far below all doubles: usual solvers
//! find 0 there, and no way. Here each value has an exponent of its own and the precision of a double, be it `1e-50000`.
//!
//! ```
//! use cplan_harmonic::{Component, Lattice, Uphill, follow, harmonic};
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
//! let curve = follow(&mut Uphill::new(&component, &field.potential, at), [1.0, 1.0], [2.0, 0.0]).unwrap();
//! assert_eq!(curve.place, [0, 0]);
//! ```
//!
//! # What it costs, and what holds
//!
//! - Linear in the cells, whatever the values: some 300 ns a cell in mazes and corridors; wide rooms cost a few solves by
//!   [`Multigrid`](cplan_multigrid::Multigrid).
//! - Each value agrees with what its neighbours ask for to 64 roundings of itself ([`residual`]).
//! - Every cell that is no goal has a strictly greater neighbour, compared exactly ([`Potential::navigates`]), also where
//!   symmetry makes the harmonic function level: walks die at `3e-14` a step, more than all rounding, which takes less than a millionth off a
//!   value ten million steps away.
//! - [`follow`] stays in free cells and ends at a goal, since it goes on from cell to cell where the gradient does not lead on.
//!   It goes along any other field, too: what it needs is a [`Guide`].
//! - The same input gives the same bits. Long solves can be stopped from outside: they come by a
//!   [`checkpoint`](cplan_interrupt::checkpoint).
//!
//! # How
//!
//! ```text
//! Lattice -> wave -> Component -> windows in order of falling values (peeling) -> elimination (network) or multigrid (wide)
//!         -> Potential -> its slope at the cells' centres (streamline), which follow goes along
//! ```
//!
//! The potential is solved in *windows* in order of falling values (`peeling`; one of all cells, where the wave winds through
//! no maze), each scaled to its own greatest value: together with the values goes the probability of leaving the window where
//! it was cut off, which bounds what is missing, and only values to which that adds nothing are accepted. Narrow windows are
//! eliminated without subtractions (`network`), wide ones go to multigrid and are refined until each value agrees with its
//! neighbours to 64 roundings of itself (`wide`; cells are corrected from a quarter of that on, so that rounding moves none
//! across the bound).
#![forbid(unsafe_code)]

mod component;
mod extent;
mod follow;
mod front;
mod lattice;
mod laplace;
mod network;
mod peeling;
mod potential;
mod streamline;
mod wide;

pub use component::{Component, Room};
pub use follow::{Guide, LatticePoint, Place, STEP, Streamline, advance, direction, follow};
pub use laplace::{Field, harmonic, harmonic_way, residual, rough_harmonic};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use potential::Potential;
pub use streamline::{LocalMaximum, Uphill};
