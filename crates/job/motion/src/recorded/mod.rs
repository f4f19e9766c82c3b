//! Judges recorded motions of any origin, also between their samples.
//!
//! - [`check_collision`] checks a recorded motion for collisions, also among moving obstacles ([`certify_in_time`]).
//!   [`limit_violations`] checks the limits of joints, and [`endpoint_errors`] the start and the goal.
//! - [`replay()`] repeats a recorded task: it matches the recorded steps with the task's (`order`), tracks the objects
//!   and the load from the recorded configurations (`state`), and judges each motion in the scene of its moment.
//! - [`false_claims`] judges the claims of a result. The samples are the motion, and all other members are claims about
//!   it.
//! - [`farthest_from_plan`] compares a recorded motion with the planned one.
//! - [`wrist_turn`] judges turns of a wrist by the contact angles of the payload about the tip.

mod arch;
mod claims;
mod ends;
mod limits;
mod collision;
mod cover;
mod plan_distance;
mod replay;
mod tool;
mod torque;
mod turning;
mod wrist;

pub use arch::{StrokeDuringMotion, seconds_to_rise};
pub use claims::{FalseClaim, false_claims, false_step_claims, false_task_claims};
pub use collision::first_moving_contact;
pub use collision::{CollisionCheck, Encounter, Moment, Touch, certify_in_time, check_collision, check_collision_with};
pub use ends::{END_TOLERANCE, EndpointError, endpoint_errors};
pub use limits::{Limit, LimitViolation, limit_violations, torque_violations};
pub use plan_distance::{FarthestPlace, farthest_from_plan};
pub use replay::{
    Fault, GripperEvent, MisplacedJoint, OrderDeviation, Replay, ReplayedStep, ReplayedTurn, StepTool,
    misplaced_joints, replay,
};
pub use torque::torque_samples;
pub use turning::{TurnCover, TurnDuringMotion, turn_angle, turn_profile};
pub use wrist::{TurnContact, WristTurn, judge_given_turn, wrist_turn};
