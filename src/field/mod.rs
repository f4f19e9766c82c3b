//! Potential fields on a grid: search waves, harmonic potentials, and the way down (or up) them.
//!
//! A field is made of parts that combine: the free cells that matter and their adjacency ([`Component`]), numbers of
//! unbounded range to store a potential in ([`Potential`]), how it is relaxed ([`OverRelaxation`]) and the equation that
//! says towards what ([`harmonic`]).

mod component;
mod harmonic;
mod lattice;
pub mod multigrid;
mod network;
mod over_relaxation;
mod peeling;
mod potential;
mod streamline;
mod wide;

pub use component::{Component, Room};
pub use harmonic::{Field, harmonic, residual, rough_harmonic};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use over_relaxation::{OverRelaxation, Progress};
pub use potential::Potential;
pub use streamline::{Interpolated, LatticePoint, Place, Streamline};
