//! Descriptions of tasks, and records of their execution.
//!
//! - [`Task`]: objects, and the steps in which an arm picks, carries and places them. A [`Payload`] is an object while the arm
//!   carries it.
//! - Obstacles that move: a [`TimedWorkspace`] has [`MovingObstacle`]s, a [`TimedScene`] their trajectories.
//! - The tool: a [`Stroke`] that lowers it, a [`Wrist`] that turns it, and all other joints of the robot ([`RobotJoints`],
//!   [`HeldJoint`]).
//! - Records of motions: a [`Recording`] has samples, which polynomial [`Piece`]s join, and [`Claims`] are the other statements
//!   of a file.
//!
//! A task creates the scenes on which the core works. Other crates, built on this one, plan, time and judge.

mod bernstein;
mod claims;
mod followed_line;
mod held;
mod interpolation;
mod moving_obstacle;
mod payload;
mod piece;
mod recording;
mod robot_joints;
mod stroke;
mod task;
mod task_error;
mod timed;
mod wrist_guide;

pub use claims::{
    BlendsClaim, Claims, EventClaim, OptimumClaim, PoseClaim, RecordedOverlap, RecordedStep, RecordedTurn,
    RecordedWrist, StepClaims, TaskClaims,
};
pub use followed_line::{DEFAULT_TOLERANCE, FollowedLine, MIN_TOLERANCE};
pub use held::{HeldEffect, HeldJoint, HeldMotion};
pub use interpolation::{INTERPOLATION, Interpolation, SMOOTH_INTERPOLATION};
pub use moving_obstacle::{
    MAX_STOP_TIME, MovingObstacle, ObstacleTrajectory, ObstacleTrajectoryError, Stop, TrajectoryLeg,
};
pub use payload::{ArchScene, Payload};
pub use piece::{Derivative, Piece, State};
pub use recording::{RecordedJoints, Recording, RecordingError};
pub use robot_joints::{Driver, Drives, RobotJoint, RobotJoints};
pub use stroke::{Arch, Stroke, ToolJoint, ToolLimits, ToolValues, rest_to_rest};
pub use task::{Action, Holding, Item, Object, Placement, Presence, Step, Task, Wrist};
pub use task_error::TaskError;
pub use timed::{TimedScene, TimedWorkspace};
pub use wrist_guide::{
    DEFAULT_WRIST_TOLERANCE, MAX_WRIST_TOLERANCE, MIN_WRIST_TOLERANCE, ToolAngle, WristGuide, WristJoint,
};
