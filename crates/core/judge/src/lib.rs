//! The judge: continuous collision checks of planned motions, and of proofs that there is no path.
//!
//! The judge uses only the scene's exact outlines, and neither planners nor C-obstacles. So it detects faults of
//! planners and of the search for proofs.
//!
//! - [`certify`] judges a path by bisection. [`Deviation`] bounds how much closer two shapes can come along a segment.
//!   Only `certify` makes a [`CertifiedPath`] from a path. `then`, `part` and `within` derive others from it.
//! - [`CurveSearch`] does the same for any curve, given bounds on its parts. The crate `motion` judges rounded
//!   corners with it.
//! - [`Posture::is_apart_with_errors`] proves that two shapes are apart if the arm differs from its model.
//! - [`permanent_contacts`] finds shapes of the robot itself that provably meet in every configuration. Their contact
//!   is ignored.
//! - [`Disconnection::checked`] judges a proof that there is no path. It joins gaps between the collision boxes by
//!   petgraph's union-find.
//!
//! ```
//! use cplan_judge::{Rejection, certify};
//! use cplan_model::{Arm, Obstacle, Scene, Workspace};
//! use cplan_model::space::{Configuration, Path};
//!
//! let workspace = Workspace::new([Obstacle::circle("post", [1.5, 0.0], 0.1)?]);
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, workspace)?;
//! let path = |q2: f64| Path::new(vec![Configuration::new(-0.6, q2), Configuration::new(0.6, q2)]);
//! // Folded, the arm passes below the post on the whole continuous motion. Stretched, it hits the post.
//! assert!(certify(&scene, path(2.5)).is_ok_and(|certified| certified.clearance() > 0.3));
//! assert!(matches!(certify(&scene, path(0.0)), Err(Rejection::TooClose(_))));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arm_errors;
mod cell;
mod deviation;
mod drift;
mod motion;
mod permanent;
mod proof;
mod vicinity;

pub use arm_errors::ArmErrors;
pub use cell::Cell;
pub use deviation::{COLLISION_ROUNDING, Deviation, Posture, SeparationBound, SpanPair};
pub use drift::Drift;
pub use motion::{CertifiedPath, CurveSearch, Nearest, Rejection, StraightMotions, certify, certify_at};
pub use permanent::permanent_contacts;
pub use proof::{
    CheckedProof, CollisionBox, Disconnection, ProofBox, ProofError, ProofFormatError, farthest_displacement,
    read_proof,
};
pub use vicinity::Vicinity;
