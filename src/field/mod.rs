//! Potential fields on a grid: search waves, harmonic potentials, and the way down (or up) them.
//!
//! A field is made of parts that combine: the free cells that matter and their adjacency ([`Component`]), numbers of
//! unbounded range to store a potential in ([`Potential`]), how it is relaxed ([`OverRelaxation`]) and the equation that
//! says towards what ([`harmonic`]).

mod component;
mod free_cells;
mod harmonic;
mod lattice;
mod over_relaxation;
mod potential;
mod queue_wave;
mod run_wave;
mod search;
mod step_labels;

pub use component::{Component, Room};
pub use free_cells::{FreeCells, Move, Neighborhood};
pub use harmonic::{Field, harmonic, rough_harmonic};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use over_relaxation::{OverRelaxation, Progress};
pub use potential::Potential;
pub use search::{Cost, Order, Search, Ties};
pub use step_labels::StepLabels;
