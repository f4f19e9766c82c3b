//! Attraction and repulsion: the fields that have local minima.

mod distance;
mod forces;

pub use distance::nearest_obstacles;
pub use forces::{Attraction, ForceField, Khatib, Repulsion, Trap};

use super::Limits;
