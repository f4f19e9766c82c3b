//! The harmonic potential of a goal, in relative precision at any distance, and the way up its gradient.
//!
//! ```text
//! Component -> windows in order of falling values (peeling) -> elimination (network) or multigrid (wide) -> Potential
//!           -> triangles between the cells' centres (streamline)
//! ```

mod component;
mod laplace;
mod network;
mod peeling;
mod potential;
mod streamline;
mod wide;

pub use component::{Component, Room};
pub use laplace::{Field, harmonic, residual, rough_harmonic};
pub use potential::Potential;
pub use streamline::{Interpolated, LatticePoint, Place, Streamline};

use super::{Lattice, Wave};
