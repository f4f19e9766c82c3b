//! The family of field equations and their relaxations, as values that combine: a [`Domain`], an [`Equation`], a
//! [`Relaxation`] and a [`Stopping`] rule; [`relax`] takes one of each.

mod descent;
mod domain;
mod equation;
mod relaxation;
mod stencil;
mod stopping;
mod sweeps;

pub use descent::{Slope, Stuck, descend};
pub use domain::{Boundary, Cell, Domain, Levels, Limits, Neighbor};
pub use equation::{Difference, Direction, Equation, Influence, around};
pub use relaxation::{Factor, Lines, Order, Precision, Relaxation, Scan, Scheme};
pub use stopping::{Convergence, Measure, Stopping};
pub use sweeps::{RelaxError, Relaxed, relax, relax_from};
