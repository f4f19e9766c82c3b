//! The harmonic potential of a goal, in relative precision at any distance, and the way up its gradient.
//!
//! ```text
//! Component -> windows in order of falling values (peeling) -> elimination (network) or multigrid (wide) -> Potential
//!           -> its slope at the cells' centres (streamline), which field::follow goes along
//! ```
//!
//! A potential that is 1 at the goal falls by a factor of 3.7 a cell in a narrow corridor, far below all doubles. So it
//! is solved in *windows* in order of falling values (`peeling`; one of all cells, where the wave winds through no maze),
//! each scaled to its own greatest value: together with the values goes the probability of leaving the window where it
//! was cut off, which bounds what is missing, and only values to which that adds nothing are accepted. Narrow windows are
//! eliminated without subtractions (`network`), wide ones go to `multigrid` and are refined until each value agrees with
//! its neighbours to 64 roundings of itself (`wide`; cells are corrected from a quarter of that on, so that rounding
//! moves none across the bound). Walks die at 3e-14 a step, more than all rounding: so every cell has a strictly greater
//! neighbour, and the planner has no fallback.

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
