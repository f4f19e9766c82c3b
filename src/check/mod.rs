//! The judge: continuous collision checks of motions, and of proofs that there is none.
//!
//! Imports geometry, space and model alone: it works on the scene's exact outlines, so that an error of a planner or of the
//! search for proofs ([`crate::search`]) cannot hide here.

mod blends;
mod cell;
mod claims;
mod deviation;
mod ends;
mod limits;
mod motion;
mod passage;
mod proof;
mod replay;
mod vicinity;
mod wrist;

pub use blends::{CertifiedCurve, blend};
pub use cell::Cell;
pub use claims::{FalseClaim, claims_kept, step_claims_kept, task_claims_kept};
pub(crate) use deviation::STUCK_ROUNDING;
pub use deviation::{Bounded, Deviation, Posture};
pub use ends::{ENDS_WITHIN, Miss, ends_kept};
pub use limits::{Excess, Limit, limits_kept};
pub use motion::{CertifiedPath, Nearest, Rejection, certify};
pub use passage::{Encounter, Moment, Passage, passage};
pub use proof::{CheckedProof, Disconnection, ProofBox, ProofDefect, ProofFormatError, StuckBox, read_proof};
pub use replay::{Departure, Fault, Happening, Replay, ReplayedStep, ReplayedTurn, replay};
pub(crate) use vicinity::Vicinity;
pub use wrist::{TurnContact, WristTurn, given_turn, wrist_turn};
