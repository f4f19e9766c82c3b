//! The judge: continuous collision checks of motions, and proofs that there is none.
//!
//! Imports neither [`crate::cspace`] nor [`crate::plan`]: it works on the scene's exact outlines alone, so that an
//! error there cannot hide here.

mod boxes;
mod connectivity;
mod deviation;
mod limits;
mod motion;
mod passage;
mod recheck;

pub use boxes::Cell;
pub use connectivity::{Connectivity, Disconnection, StuckBox, connectivity};
pub use deviation::{Bounded, Deviation, Posture};
pub use limits::{Excess, Limit, limits_kept};
pub use motion::{CertifiedPath, Nearest, Rejection, certify};
pub use passage::{Encounter, Moment, Passage, passage};
pub use recheck::{ProofDefect, recheck};
