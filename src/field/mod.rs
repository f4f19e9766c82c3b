//! Potential fields on a grid: search waves, harmonic potentials, and the way down (or up) them.
//!
//! A field is made of parts that combine: the free cells that matter and their adjacency ([`Component`]), numbers of
//! unbounded range to store a potential in ([`Potential`]), how it is relaxed ([`Relaxation`]) and the equation that
//! says towards what ([`harmonic`]).

mod component;
mod harmonic;
mod lattice;
mod potential;
mod relaxation;

pub use component::{Component, Room};
pub use harmonic::{Field, harmonic, rough_harmonic};
pub use lattice::{Lattice, UNREACHED, Wave};
pub use potential::Potential;
pub use relaxation::{Progress, Relaxation};
