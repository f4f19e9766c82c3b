//! Judges recorded motions of any origin, also between their samples.
//!
//! - [`check_collision`] judges a recorded motion, also among moving obstacles ([`certify_in_time`]); [`limits_kept`]
//!   judges its limits; [`ends_kept`] its start and goal.
//! - [`replay()`] repeats a recorded task: it matches the recorded steps with the task's (`order`), tracks the objects
//!   and the load from the recorded configurations (`state`), and judges each motion in the scene of its moment.
//! - [`claims_kept`] judges the claims of a result. The samples are the motion, and all other members are claims about
//!   it.
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
