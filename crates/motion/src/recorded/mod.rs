//! Judges recorded motions, whoever made them, between their samples.
//!
//! - [`check_collision`] judges a recorded motion, also among moving obstacles ([`certify_in_time`]); [`limits_kept`] its limits;
//!   [`ends_kept`] whether it leads from start to goal.
//! - [`replay()`] repeats a recorded task: it puts the recorded steps beside the task's (`order`), follows the objects and what is
//!   carried from the recorded configurations (`state`), and judges each motion in the scene of its moment.
//! - [`claims_kept`] judges what a result says besides its samples. The samples are the motion, everything else is a claim about it.
//! - [`wrist_turn`] judges turns of a wrist by the contact angles of the payload about the tip.

mod claims;
mod ends;
mod limits;
mod collision;
mod replay;
mod tool;
mod torque;
mod wrist;

pub use claims::{FalseClaim, claims_kept, step_claims_kept, task_claims_kept};
pub use collision::met_in_time;
pub use collision::{CollisionCheck, Encounter, Moment, certify_in_time, check_collision, check_collision_with};
pub use ends::{ENDS_WITHIN, Miss, ends_kept};
pub use limits::{Excess, Limit, limits_kept, torques_kept};
pub use replay::{Departure, Fault, Happening, Replay, ReplayedStep, ReplayedTurn, replay};
pub use torque::torque_looks;
pub use wrist::{TurnContact, WristTurn, given_turn, wrist_turn};
