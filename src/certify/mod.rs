//! The judge: continuous collision checks of motions, proofs that there is none, and bounds on how short one can be.
//!
//! Imports neither [`crate::cspace`] nor [`crate::plan`]: it works on the scene's exact outlines alone, so that an
//! error there cannot hide here.

mod bands;
mod blends;
mod boxes;
mod chain;
mod channel;
mod claims;
mod connectivity;
mod deviation;
mod disconnection;
mod motion;
mod optimum;
mod proof_json;
mod ends;
mod limits;
mod passage;
mod recheck;
mod replay;
mod slab;
mod slabs;
mod slim;
mod vicinity;
mod wrist;

pub use blends::{CertifiedCurve, blend};
pub use boxes::Cell;
pub use channel::Channel;
pub use claims::{FalseClaim, claims_kept, step_claims_kept, task_claims_kept};
pub use connectivity::{Connectivity, Exploration, Occupancy, connectivity, explore};
pub use deviation::{Bounded, Deviation, Posture};
pub use disconnection::{Disconnection, StuckBox};
pub use ends::{ENDS_WITHIN, Miss, ends_kept};
pub use limits::{Excess, Limit, limits_kept};
pub use motion::{CertifiedPath, Nearest, Rejection, certify};
pub use optimum::{Motions, ShortMotion, least_length, short_motion};
pub use passage::{Encounter, Moment, Passage, passage};
pub use proof_json::{ProofBox, ProofFormatError, read_proof};
pub use recheck::{ProofDefect, recheck};
pub use replay::{Departure, Fault, Happening, Replay, ReplayedStep, ReplayedTurn, replay};
pub use slabs::slab_connectivity;
pub use wrist::{TurnContact, WristTurn, given_turn, wrist_turn};
