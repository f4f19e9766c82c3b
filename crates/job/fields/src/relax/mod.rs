//! The field equations and their relaxations. [`relax`] takes a [`Domain`], an [`Equation`], a [`Relaxation`] and a [`Stopping`]
//! rule, which combine freely. [`relax_on`] also takes a device.
//!
//! An equation becomes a `Stencil` (the value that neighbours imply for a cell), an order a list of passes, and a measure a
//! `Tally`. The sweeps are compiled for each pair of stencil and tally. To add a linear equation, state its drift in each cell;
//! any other equation needs a new stencil. Attraction and repulsion ([`super::Khatib`]) need no equation, because their potential
//! has a closed form.

mod accelerated;
mod by_multigrid;
mod descent;
mod device;
mod direct;
mod domain;
mod equation;
mod relaxation;
mod stages;
mod stencil;
mod stopping;
mod sweeps;
mod trace;

pub use accelerated::{Accelerator, CellEquations};
pub use by_multigrid::by_multigrid;
pub(super) use by_multigrid::{Memory, by_multigrid_in};
pub use descent::{DeadEnd, ValueGuide, descend};
pub use device::{Device, OpenGpu, relax_on};
pub use direct::eliminated;
pub use domain::{Boundary, Cell, Domain, Initial, Levels, Limits, Neighbor, Stencil};
pub use equation::{Difference, Direction, Equation, Influence, drift_around_robots};
pub use relaxation::{Factor, Lines, Order, Precision, Relaxation, Scan, Scheme};
pub use stopping::{Convergence, Measure, Stopping};
pub use sweeps::{RelaxError, RelaxedField, SweepSnapshot, relax, relax_from, relax_watched};
pub use trace::{Ending, Leap, Sample, Trace, trace};
