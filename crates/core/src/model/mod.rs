//! The arm, the workspace, and the two together.
//!
//! ```
//! use cplan_core::model::{Arm, Obstacle, Scene, Workspace};
//! use cplan_core::space::Configuration;
//!
//! let arm = Arm::rr([1.0, 0.8], 0.06)?;
//! let workspace = Workspace::new([Obstacle::circle("post", [1.0, 0.5], 0.1)?]);
//! let scene = Scene::new(arm, workspace)?;
//! let stretched = scene.closest(Configuration::new(0.0, 0.0)).expect("there is something to hit");
//! // From the bar's upper edge to the post.
//! assert!((stretched.separation.distance - 0.37).abs() < 1e-12);
//! assert_eq!(scene.workspace().obstacles[stretched.pair.obstacle].name, "post");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arm;
mod assumed;
mod carried;
mod contacts;
mod dynamics;
mod held;
mod inverse;
mod joint;
mod link;
mod mover;
mod obstruction;
mod outcome;
mod payload;
mod payload_parts;
mod preference;
mod problem;
mod record;
mod robot_joints;
mod scene;
mod scene_error;
mod scene_names;
mod scene_record;
mod self_obstacle;
mod sensor;
mod stroke;
mod stuck_along;
mod task;
mod task_error;
mod tip_area;
mod workspace;

pub use arm::{Arm, Plane};
pub use assumed::AssumedLimits;
pub use assumed::{SLIDING_SPEED, TURNING_SPEED, assumed_acceleration, assumed_acceleration_note};
pub use carried::Carried;
pub use carried::on_axis;
use carried::swept;
pub use contacts::Contacts;
pub use dynamics::{Body, Curvature, Dynamics, DynamicsAt, Rates};
pub use held::{HeldEffect, HeldJoint, HeldMotion};
pub use inverse::{Freedom, Inverse, inverse, within};
pub use joint::{Joint, JointType};
pub use link::{Link, OutlineSource, Part};
pub use mover::{Course, CourseError, Drift, LATEST, Leg, Mover, Stop};
pub use obstruction::Obstruction;
pub use outcome::{Outcome, Status};
pub use payload::{Grip, Payload};
pub use preference::{Preference, Region};
pub use problem::{Goal, MotionProblem, MotionProblemError};
pub use record::{BlendsClaim, Claims, EventClaim, OptimumClaim, RecordedStep, RecordedTurn, StepClaims, TaskClaims};
pub use robot_joints::{Driver, Drives, RobotJoint, RobotJoints};
pub use scene::{Contact, Pair, Scene};
pub use scene_error::LONGEST_TURN;
pub use scene_error::SceneError;
pub use self_obstacle::{Carrier, SelfObstacle};
pub use sensor::{Mount, Sensor};
pub use stroke::{Stroke, ToolJoint};
pub use stuck_along::BlockedStretch;
pub use task::{Action, Holding, Item, Object, Step, Task, Wrist};
pub use task_error::TaskError;
pub use tip_area::area_goals;
pub use workspace::{Heights, Obstacle, RESTING_TOLERANCE, Shape, Workspace};
