//! Potential fields on a grid, and the way down (or up) them.
//!
//! - [`StepLabels`] and [`search`]: steps to the goal by waves, and the classical searches for comparison;
//! - [`harmonic()`]: the harmonic potential by direct and multigrid solution, precise at any distance;
//! - [`relax()`]: the family of field equations and relaxations as values that combine;
//! - [`Khatib`]: attraction and repulsion, with their local minima;
//! - [`follow()`]: the curve along the gradient of any of them, between the cells;
//! - [`multigrid`]: the solver for five-point problems among walls.

mod follow;
mod harmonic;
mod khatib;
mod lattice;
pub mod multigrid;
mod relax;
mod waves;

pub use follow::{Guide, LatticePoint, Place, STEP, Streamline, follow};
pub use harmonic::{Component, Field, LocalMaximum, Potential, Room, Uphill, harmonic, residual, rough_harmonic};
pub use khatib::{Attraction, Downforce, ForceField, Khatib, Repulsion, Trap, nearest_obstacles};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use relax::{
    Boundary, Cell, Convergence, Difference, Direction, Domain, Equation, Factor, Influence, Levels, Limits, Lines,
    Measure, Neighbor, Order, Precision, RelaxError, Relaxation, Relaxed, Scan, Scheme, Slope, Stopping, Stuck, around,
    descend, relax, relax_from,
};
pub use waves::{FreeCells, Move, Neighborhood, StepLabels, search};
