//! What a task is made of, and what somebody reports of doing it.
//!
//! - [`Task`]: objects, and the steps in which an arm picks, carries and places them.
//! - The tool: a [`Stroke`] that lowers it, a [`Wrist`] that turns it, and the robot's joints beside the two of the arm ([`RobotJoints`],
//!   [`HeldJoint`]).
//! - Records of motions: [`Recording`] has samples, which [`Piece`]s of polynomials join, [`Claims`] what a file says besides.
//!
//! A task builds scenes for the core; planning, timing and judging are for the crates above.

mod bernstein;
mod claims;
mod held;
mod interpolation;
mod piece;
mod recording;
mod robot_joints;
mod stroke;
mod task;
mod task_error;

pub use claims::{BlendsClaim, Claims, EventClaim, OptimumClaim, RecordedStep, RecordedTurn, StepClaims, TaskClaims};
pub use held::{HeldEffect, HeldJoint, HeldMotion};
pub use interpolation::{INTERPOLATION, Interpolation, SMOOTH_INTERPOLATION};
pub use piece::{Derivative, Piece, State};
pub use recording::{Recording, RecordingError};
pub use robot_joints::{Driver, Drives, RobotJoint, RobotJoints};
pub use stroke::{Stroke, ToolJoint};
pub use task::{Action, Holding, Item, Object, Step, Task, Wrist};
pub use task_error::TaskError;
