//! Potential fields on a grid, and the way down (or up) them.
//!
//! - [`StepLabels`] and [`search`]: steps to the goal by waves, and the classical searches for comparison;
//! - [`harmonic()`]: the harmonic potential by direct and multigrid solution, precise at any distance;
//! - [`relax()`]: the family of field equations and relaxations as values that combine; [`trace()`]: how one converges, sweep by
//!   sweep; [`relax_on`]: the same on a GPU; [`eliminated`]: the solution that it converges to;
//!   [`by_multigrid`]: the same solution in a few steps;
//! - [`MovingField`]: a field among obstacles that move, which robots share, from frame to frame;
//! - [`Khatib`]: attraction and repulsion, with their local minima;
//! - [`follow()`]: the curve along the gradient of any of them, between the cells;
//! - [`multigrid`]: the solver for five-point problems among walls.
//!
//! The harmonic potential and the curve are the crate [`cplan_harmonic`], the solver is [`cplan_multigrid`]: both can be had
//! without the rest.

mod khatib;
mod lattice;
mod moving;
mod relax;
mod waves;

pub use cplan_harmonic::{
    Component, Field, Guide, Lattice, LatticePoint, LocalMaximum, Place, Potential, Room, STEP, Streamline, UNREACHED,
    Uphill, Wave, advance, direction, follow, harmonic, harmonic_way, residual, rough_harmonic,
};
pub use cplan_multigrid as multigrid;
pub use khatib::{Attraction, Downforce, Escape, Escaped, ForceField, Khatib, Repulsion, Trap, nearest_obstacles};
pub use moving::{Disc, Moment, MovingField, Solver};
pub use relax::{
    Boundary, Cell, Convergence, Device, Difference, Direction, Domain, Ending, Equation, Factor, Influence, Leap,
    Levels, Limits, Lines, Measure, Neighbor, Order, Precision, RelaxError, Relaxation, Relaxed, Sample, Scan, Scheme,
    Slope, Stencil, Stopping, Stuck, Trace, Watched, around, by_multigrid, descend, eliminated, relax, relax_from,
    relax_on, relax_watched, trace,
};
pub use waves::{FreeCells, Move, Neighborhood, StepLabels, search};
