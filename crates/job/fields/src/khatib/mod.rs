//! Attraction and repulsion: fields with local minima.

mod charges;
mod descent;
mod distance;
mod escape;
mod forces;

pub use descent::{EscapedMinima, ForceGuide};
pub use distance::nearest_obstacles;
pub use escape::Escape;
pub use forces::{Attraction, ForceField, Khatib, Repulsion, Trap};

use super::Limits;
