//! The arm, its workspace, and the scene that combines the two. [`space`] has configurations, axes that are intervals or
//! circles, and paths.
//!
//! ```
//! use cplan_model::{Arm, Obstacle, Scene, Workspace};
//! use cplan_model::space::Configuration;
//!
//! let arm = Arm::rr([1.0, 0.8], 0.06)?;
//! let workspace = Workspace::new([Obstacle::circle("post", [1.0, 0.5], 0.1)?]);
//! let scene = Scene::new(arm, workspace)?;
//! let stretched = scene.closest(Configuration::new(0.0, 0.0)).expect("there is something to hit");
//! // The distance is from the bar's upper edge to the post.
//! assert!((stretched.separation.distance - 0.37).abs() < 1e-12);
//! assert_eq!(scene.workspace().obstacles[stretched.pair.obstacle].name, "post");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod space;

mod additions;
mod arm;
mod attachment;
mod calibration;
mod carried;
mod contacts;
mod elbow;
mod motors;
mod inverse;
mod joint;
mod link;
mod masses;
mod obstruction;
mod outcome;
mod pairing;
mod preference;
mod problem;
mod scene;
mod scene_error;
mod scene_names;
mod scene_record;
mod self_obstacle;
mod blocked_along;
mod tip_area;
mod workspace;

pub use additions::{Additions, LooseObstacle};
pub use arm::{Arm, Plane};
pub use attachment::{AttachedPart, Attachment, Grip};
pub use blocked_along::BlockedStretch;
pub use calibration::Calibration;
use carried::swept;
pub use carried::{CarriedPart, on_axis};
pub use contacts::Contacts;
/// Loops over configurations or pairs of shapes that may take long call this, so that they can be stopped.
pub use cplan_interrupt::checkpoint;
pub use elbow::Elbow;
pub use inverse::{Freedom, Inverse, equivalent_values, inverse};
pub use joint::{
    DEFAULT_SLIDING_SPEED, DEFAULT_TIME_TO_TOP_SPEED, DEFAULT_TURNING_SPEED, Joint, JointType, assumed_acceleration,
};
pub use link::{Link, OutlineSource, Part};
pub use masses::{Body, Dynamics};
pub use motors::Motors;
pub use obstruction::Obstruction;
pub use outcome::{Outcome, Status};
pub use preference::{Preference, Region};
pub use problem::{Goal, MotionProblem, MotionProblemError};
pub use scene::{Contact, Pair, Scene};
pub use scene_error::{
    MAX_COORDINATE, MAX_TURN_RANGE, SceneError, are_small, check_clearance, check_range, is_pose, is_small,
};
pub use self_obstacle::{Carrier, SelfObstacle};
pub use tip_area::area_goals;
pub use workspace::{Growth, Heights, Obstacle, RESTING_TOLERANCE, Shape, Workspace};
