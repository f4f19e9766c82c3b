//! The judge: continuous collision checks of motions, and of proofs that there is none.
//!
//! Imports geometry, space and model alone: it works on the scene's exact outlines, so that an error of a planner or of the
//! search for proofs ([`crate::search`]) cannot hide here.
//!
//! - [`certify`] judges a path, by bisection ([`Deviation`] says how far shapes can come together), and alone makes a
//!   [`CertifiedPath`]; [`blend`] cuts its corners by parabolas, each as large as is certified within the clearance: a
//!   [`CertifiedCurve`] is the straight path, its blends, and the least distance along all of both.
//! - [`Disconnection::checked`] judges a proof that there is no path: it joins what the stuck boxes leave by petgraph's union-find.
//! - [`check_collision`] judges anyone's recorded motion between its samples, also among what moves ([`certify_in_time`]), [`limits_kept`] its limits, [`ends_kept`] whether
//!   it leads from start to goal.
//! - [`replay()`] does a recorded task again: it puts the recorded steps beside the task's (`order`), follows where the
//!   objects are and what is carried from the recorded configurations (`state`), and judges each motion in the scene of
//!   its moment.
//! - [`claims_kept`]: what a result says besides its samples. The samples are the motion, everything else is a claim
//!   about it.
//! - [`wrist_turn`] judges turns of a wrist by the contact angles of the payload about the tip.
//!
//! ```
//! use cplan::check::{Rejection, certify};
//! use cplan::model::{Arm, Obstacle, Scene, Workspace};
//! use cplan::space::{Configuration, Path};
//!
//! let workspace = Workspace::new([Obstacle::circle("post", [1.5, 0.0], 0.1)?]);
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, workspace)?;
//! let way = |q2: f64| Path::new(vec![Configuration::new(-0.6, q2), Configuration::new(0.6, q2)]);
//! // Folded, the arm passes below the post: all of the continuous motion does. Stretched, it does not.
//! assert!(certify(&scene, way(2.5), 0.0).is_ok_and(|certified| certified.clearance() > 0.3));
//! assert!(matches!(certify(&scene, way(0.0), 0.0), Err(Rejection::TooClose(_))));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bound;
mod claims;
mod ends;
mod limits;
mod collision;
mod replay;
mod tool;
mod torque;
mod wrist;

pub use bound::{Barrier, CheckedBound, ClosedSegment, LengthClaim, Slice, Wall};
pub use claims::{FalseClaim, claims_kept, step_claims_kept, task_claims_kept};
pub(crate) use collision::met_in_time;
pub use collision::{CollisionCheck, Encounter, Moment, certify_in_time, check_collision, check_collision_with};
pub use cplan_core::check::*;
pub use ends::{ENDS_WITHIN, Miss, ends_kept};
pub use limits::{Excess, Limit, limits_kept, torques_kept};
pub use replay::{Departure, Fault, Happening, Replay, ReplayedStep, ReplayedTurn, replay};
pub(crate) use torque::torque_looks;
pub use wrist::{TurnContact, WristTurn, given_turn, wrist_turn};
