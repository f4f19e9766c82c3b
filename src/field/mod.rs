//! Potential fields on a grid: search waves, harmonic potentials, and the way down (or up) them.
//!
//! A field is made of parts that combine: the free cells that matter and their adjacency ([`Component`]), numbers of
//! unbounded range to store a potential in ([`Potential`]), how it is relaxed ([`OverRelaxation`]) and the equation that
//! says towards what ([`harmonic`]).

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
mod over_relaxation;
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
mod wide;

pub use component::{Component, Room};
pub use descent::{Stuck, descend};
pub use distance::nearest_obstacles;
pub use domain::{Boundary, Cell, Domain, Levels, Limits, Neighbor};
pub use equation::{Difference, Direction, Equation, Influence, around};
pub use free_cells::{FreeCells, Move, Neighborhood};
pub use harmonic::{Field, harmonic, residual};
pub use khatib::{Attraction, ForceField, Khatib, Repulsion, Trap};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use over_relaxation::{OverRelaxation, Progress};
pub use potential::Potential;
pub use relax::{RelaxError, Relaxed, relax, relax_from};
pub use relaxation::{Factor, Lines, Order, Precision, Relaxation, Scan, Scheme};
pub use step_labels::StepLabels;
pub use stopping::{Convergence, Measure, Stopping};
