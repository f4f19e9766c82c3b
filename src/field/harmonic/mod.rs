//! The harmonic potential of a goal, in relative precision at any distance, and the way up its gradient.
//!
//! ```text
//! Component -> windows in order of falling values (peeling) -> elimination (network) or multigrid (wide) -> Potential
//!           -> its slope at the cells' centres (streamline), which field::follow goes along
//! ```

mod component;
mod extent;
mod laplace;
mod network;
mod peeling;
mod potential;
mod streamline;
mod wide;

pub use component::{Component, Room};
pub use laplace::{Field, harmonic, residual, rough_harmonic};
pub use potential::Potential;
pub use streamline::{LocalMaximum, Uphill};

use super::{Lattice, Wave};
