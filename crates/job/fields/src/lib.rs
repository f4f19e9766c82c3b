//! Potential fields on a grid, and the paths that descend or ascend them.
//!
//! - [`relax()`] solves field equations by relaxation. Any [`Equation`] combines with any [`Relaxation`].
//!   - [`relax_on`] does the same on a GPU.
//!   - [`trace()`] measures convergence sweep by sweep.
//!   - [`eliminated`] computes the solution by elimination, and [`by_multigrid`] in a few steps of multigrid.
//! - [`Khatib`]: attraction and repulsion, which have local minima.
//! - [`MovingField`]: a field among moving obstacles, which several robots share, and which is updated at each moment.
//! - [`FieldPlanner`]: the planner that follows any of these fields.
//!
//! Other crates have the harmonic potential (`cplan-harmonic`), the curve along a gradient ([`cplan_harmonic::follow`]), and the
//! solver of linear equations ([`cplan_multigrid`]).

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
    Accelerator, Boundary, Cell, CellEquations, Convergence, DeadEnd, Device, Difference, Direction, Domain, Ending,
    Equation, Factor, Influence, Initial, Leap, Levels, Limits, Lines, Measure, Neighbor, OpenGpu, Order, Precision,
    RelaxError, Relaxation, RelaxedField, Sample, Scan, Scheme, Stencil, Stopping, SweepSnapshot, Trace, ValueGuide,
    by_multigrid, descend, drift_around_robots, eliminated, relax, relax_from, relax_on, relax_watched, trace,
};
