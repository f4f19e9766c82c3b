//! Attraction and repulsion: the fields that have local minima.

mod charges;
mod descent;
mod distance;
mod forces;

pub use descent::Downforce;
pub use distance::nearest_obstacles;
pub use forces::{Attraction, ForceField, Khatib, Repulsion, Trap};

use super::Limits;
