//! Potential fields on a grid: search waves, harmonic potentials, and the way down (or up) them.
//!
//! A field is made of parts that combine: the free cells that matter and their adjacency ([`Component`]), numbers of
//! unbounded range to store a potential in ([`Potential`]), the solution of Laplace's equation in them ([`harmonic`]), and the
//! way up between the cells ([`Interpolated`]).
//!
//! Beside this solver of one equation there is the whole family, in plain doubles, to choose from and to compare: [`relax`]
//! takes a [`Domain`], an [`Equation`], a [`Relaxation`] and a [`Stopping`] rule, any with any; [`descend`] follows what
//! comes of it. [`Khatib`]'s attraction and repulsion need no relaxation: [`ForceField`].

mod component;
mod descent;
mod distance;
mod domain;
mod equation;
mod free_cells;
mod harmonic;
mod khatib;
mod lattice;
pub mod multigrid;
mod network;
mod peeling;
mod potential;
mod queue_wave;
mod relax;
mod relaxation;
mod run_wave;
pub mod search;
mod stencil;
mod step_labels;
mod stopping;
mod streamline;
mod wide;

pub use component::{Component, Room};
pub use descent::{Stuck, descend};
pub use distance::nearest_obstacles;
pub use domain::{Boundary, Cell, Domain, Levels, Limits, Neighbor};
pub use equation::{Difference, Direction, Equation, Influence, around};
pub use free_cells::{FreeCells, Move, Neighborhood};
pub use harmonic::{Field, harmonic, residual, rough_harmonic};
pub use khatib::{Attraction, ForceField, Khatib, Repulsion, Trap};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use potential::Potential;
pub use relax::{RelaxError, Relaxed, relax, relax_from};
pub use relaxation::{Factor, Lines, Order, Precision, Relaxation, Scan, Scheme};
pub use step_labels::StepLabels;
pub use stopping::{Convergence, Measure, Stopping};
pub use streamline::{Interpolated, LatticePoint, Place, Streamline};
