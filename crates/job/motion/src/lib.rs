//! From a certified path to a motion in time, and to files.
//!
//! [`time`] computes the fastest motion along a path with blends within the joints' limits. [`csv`], [`ros_yaml`] and (as a
//! feature) `mcap` write motions. [`Format`] determines the format for a file name. [`write_whole`] writes a file completely or
//! not at all.
//!
//! The readers of the formats join samples in different ways:
//!
//! | format | readers | how they join samples |
//! |---|---|---|
//! | JSON `trajectory` | programs that know cplan | by [`INTERPOLATION`], which the file states |
//! | CSV | tables, plots, other planners | cubics through positions and velocities |
//! | YAML, MCAP `/joint_trajectory` | `joint_trajectory_controller` | cubics through positions and velocities |
//! | the same with accelerations | `joint_trajectory_controller` | quintics |
//! | MCAP `/tf`, `/scene`, `/outlines` | RViz, Foxglove, Rerun | nothing: a frame stays where it is until it moves |
//! | MCAP `/joint_states` | `robot_state_publisher`, Foxglove | each state for itself; displays hold it or draw lines to the next |
//!
//! Cubics are within all limits. On straight pieces, they are exactly the certified motion; on blends, they are within
//! [`BLEND_TOLERANCE`] of it, which the certificate covers. While the arm is at rest, samples are equal and have no velocity.
//! Quintics equal the motion only if the acceleration does not jump, so accelerations are written only on request, and refused if
//! they jump. States are on the motion; lines between states `h` seconds apart deviate from it by at most `a h^2 / 8`, where `a`
//! is the greatest acceleration.
//!
//! ```
//! use cplan_judge::certify;
//! use cplan_model::{Arm, Scene, Workspace};
//! use cplan_motion::Drive;
//! use cplan_model::space::{Configuration, Path};
//!
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, Workspace::new([]))?;
//! let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(Configuration::from);
//! let path = certify(&scene, Path::new(corners.to_vec())).expect("nothing is in the way");
//! let timed = Drive::default().along(&scene, &path, 1.0)?;
//! let stopping = Drive { blend: 0.0, ..Drive::default() }.along(&scene, &path, 1.0)?;
//! // The corner is rounded, which is faster than to stop there.
//! assert!(timed.trajectory.duration() < stopping.trajectory.duration());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Timing
//!
//! [`time`] computes the squared speed along the curve by forward-backward integration, from one stop to the next (`schedule`).
//! Straight pieces have a closed form (`profile`). A blend is cut into spans, with bounds that are linear in the squared speeds
//! at the ends of a span (`corner`). Every piece of the motion is a polynomial in time of degree at most four, which the samples
//! define.
//!
//! With limits on jerks, `smooth` converts this motion to a cubic B-spline (`spline`): its mean over a window of time that is
//! long enough for the jerk. A corner at which the result is not proven free is passed more slowly. `retime` then computes the
//! fastest motion along the resulting curve. If the curve is given, as for lines that the tip follows, `joint_curve` finds the
//! fastest motion along it directly.
//!
//! The motion along a single straight piece from rest to rest comes from `jerk`. Ruckig determines the durations of the seven
//! phases, which are adapted to the least interval between samples. The phases are then computed from these durations and the
//! length alone, so the motion ends at the right place and is within the limits, whatever Ruckig's tolerance.
//!
//! All samples are at whole nanoseconds (`clock`). `shape` searches for the path with the fastest motion, and `least` has lower
//! bounds on the duration.
//!
//! # Files
//!
//! `message` has motions of all joints for ROS 2 messages: `model::RobotJoints` lists the source of each value, and in a task the
//! engine adds the tool's strokes and the wrist's turns.
//!
//! A recording (`mcap`, a feature) is a list of motions, each with its start time: a CDR writer (`mcap/cdr`), the two messages
//! with their definitions (`mcap/messages`), and the crate `mcap` for the container.

mod blend;
mod bounds;
mod certified;
mod clock;
mod corner;
mod csv;
mod drive;
mod extent;
mod field;
mod format;
mod jerk;
mod joint_curve;
mod json;
mod least;
mod limits;
mod margins;
#[cfg(feature = "mcap")]
mod mcap;
mod message;
mod place_time;
mod profile;
pub mod recorded;
mod result;
mod retime;
mod ros;
mod rounded;
mod sample;
mod schedule;
mod shape;
mod single;
mod smooth;
mod span;
mod spline;
mod tip;
mod torque;
mod waits;
mod whole_file;

#[cfg(test)]
mod tests;

#[cfg(feature = "mcap")]
pub use self::mcap::{Body, Solid, Stage, mcap};
pub use blend::{BLEND_TOLERANCE, Blend, BlendedPath, CurvedLeg, Stretch};
pub use certified::{CertifiedCurve, Rounding, blend, blend_curved};
pub use clock::{nanoseconds, nearest_within, round_down, round_up, seconds, whole_nanoseconds};
pub use cplan_handling::{INTERPOLATION, SMOOTH_INTERPOLATION};
pub use csv::{csv, csv_of_joints};
pub use drive::{CurveDrive, Drive, Objective, along_curve};
pub use extent::distance_to_leg;
pub use field::FieldReport;
pub use format::{Format, FormatError};
pub use joint_curve::{JointCurve, along_joint_curve};
pub use json::field_per_line;
pub use least::least_duration;
pub use limits::{Limits, SumLimit, WristLimit};
pub use margins::{
    BodyKind, BodyMargin, BodyNames, ErrorKind, Margin, MarginReport, MarginSearch, Margins, MotionStretch, Tolerance,
    ToleranceReport,
};
pub use message::{AccelerationJump, JointMotion};
pub use place_time::{BlockedTimes, MotionPart, PlaceTime, TimedPlace, WaitReason};
pub use result::{BlendReport, DurationOptimality, LengthOptimality, SearchReport, interpolation};
pub use ros::ros_yaml;
pub use sample::{MAX_DURATION, MAX_SAMPLES, MIN_INTERVAL, TimedMotion, TimingError, Trajectory, after_pause, time};
pub use single::{phase_at, single};
pub use span::{Place, Span};
pub use tip::TipSpeed;
pub use torque::TorqueLimit;
pub use waits::{Timing, Wait};
pub use whole_file::{WriteError, check_writable, write_whole, write_whole_set};
