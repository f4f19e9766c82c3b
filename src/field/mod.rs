//! Potential fields on a grid, and the way down (or up) them.
//!
//! - [`StepLabels`] and [`search`]: steps to the goal by waves, and the classical searches for comparison;
//! - [`harmonic()`]: the harmonic potential by direct and multigrid solution, precise at any distance, and its
//!   [`Interpolated`] streamlines;
//! - [`relax()`]: the family of field equations and relaxations as values that combine;
//! - [`Khatib`]: attraction and repulsion, with their local minima;
//! - [`multigrid`]: the solver for five-point problems among walls.

mod harmonic;
mod khatib;
mod lattice;
pub mod multigrid;
mod relax;
mod waves;

pub use harmonic::{
    Component, Field, Interpolated, LatticePoint, Place, Potential, Room, Streamline, harmonic, residual,
    rough_harmonic,
};
pub use khatib::{Attraction, ForceField, Khatib, Repulsion, Trap, nearest_obstacles};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use relax::{
    Boundary, Cell, Convergence, Difference, Direction, Domain, Equation, Factor, Influence, Levels, Limits, Lines,
    Measure, Neighbor, Order, Precision, RelaxError, Relaxation, Relaxed, Scan, Scheme, Stopping, Stuck, around,
    descend, relax, relax_from,
};
pub use waves::{FreeCells, Move, Neighborhood, StepLabels, search};
