//! Where proofs and bounds are found: slabs and boxes that tell whether there is a path, and lower bounds on how short one can
//! be. What it finds passes [`crate::check`], which shares no code with it but the kernels of geometry and
//! [`crate::check::Deviation`].

mod bands;
mod boxes;
mod cell;
mod chain;
mod channel;
mod connectivity;
mod optimum;
mod separating;
mod slab;
mod slabs;
mod slim;

pub use channel::Channel;
pub use connectivity::{Connectivity, Exploration, Occupancy, connectivity, explore};
pub use optimum::{Motions, ShortMotion, least_length, short_motion};
pub use slabs::slab_connectivity;
