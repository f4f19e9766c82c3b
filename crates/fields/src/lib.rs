//! Potential fields on a grid, and the path down (or up) them.
//!
//! - [`relax()`]: the family of field equations and relaxations as values that combine; [`trace()`]: how one converges, sweep by
//!   sweep; [`relax_on`]: the same on a GPU; [`eliminated`]: the solution that it converges to; [`by_multigrid`]: the same
//!   solution in a few steps.
//! - [`Khatib`]: attraction and repulsion, with their local minima.
//! - [`MovingField`]: a field among moving obstacles, which robots share, from frame to frame.
//! - [`FieldPlanner`]: the planner that follows any of them.
//!
//! The harmonic potential and the curve along a gradient are the crate [`cplan_harmonic`], the solver is [`cplan_multigrid`].

mod field_choice;
mod field_planner;
mod khatib;
mod moving;
mod relax;

pub use field_choice::{EquationChoice, FieldChoice, FieldPlanner};
pub use field_planner::{RELATIVE_TOLERANCE, field_domain};
pub use khatib::{
    Attraction, Escape, EscapedMinima, ForceField, ForceGuide, Khatib, Repulsion, Trap, nearest_obstacles,
};
pub use moving::{Disc, Moment, MovingField, Solver};
pub use relax::{
    Boundary, Cell, Convergence, DeadEnd, Device, Difference, Direction, Domain, Ending, Equation, Factor, Influence,
    Leap, Levels, Limits, Lines, Measure, Neighbor, Order, Precision, RelaxError, Relaxation, RelaxedField, Sample,
    Scan, Scheme, Stencil, Stopping, SweepSnapshot, Trace, ValueGuide, around, by_multigrid, descend, eliminated,
    relax, relax_from, relax_on, relax_watched, trace,
};
