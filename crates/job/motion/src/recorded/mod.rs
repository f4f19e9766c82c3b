//! Judges recorded motions of any origin, also between their samples.
//!
//! - [`check_collision`] checks a recorded motion for collisions, also among moving obstacles ([`certify_in_time`]).
//!   [`limit_violations`] checks the limits of joints.
//! - [`TurnAtRest`] judges turns of a wrist by the contact angles of the payload about the tip.

mod arch;
mod limits;
mod collision;
mod cover;
mod encounter;
mod precision;
mod tool;
mod torque;
mod turning;
mod wrist;

pub use arch::{StrokeDuringMotion, seconds_to_rise};
pub use collision::{certify_in_time, check_collision, check_collision_with, first_moving_contact};
pub use encounter::{CollisionCheck, Encounter, Moment, Touch};
pub use limits::{
    ELBOW_MOTOR, FIRST_MOTOR, Limit, LimitViolation, limit_violations, motor_violations, torque_violations,
};
pub use tool::swept_by_tool;
pub use torque::torque_samples;
pub use turning::{TurnCover, TurnDuringMotion, turn_angle, turn_profile};
pub use wrist::{TurnAtRest, TurnContact, WristTurn, turn_resolution};
