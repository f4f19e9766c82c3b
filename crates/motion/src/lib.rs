//! From a certified path to a motion in time, and to files.
//!
//! [`time`] times a path with its blends within the joints' limits. [`csv`], [`ros_yaml`] and (a feature) `mcap` write
//! motions, [`Format`] returns the format for a file name, and [`write_whole`] writes a file whole or not at all.
//!
//! Each format makes guarantees to its readers, which join samples differently:
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
//! The cubics are the certified motion: on straight pieces exactly, on blends within [`BLEND_TOLERANCE`], which the certificate
//! covers. They keep the limits, and while the arm is at rest the samples are equal and have no velocity. Quintics
//! equal that motion only where the acceleration does not jump. So accelerations are written only on request, and
//! refused where they jump. States lie on the motion; lines between them deviate from it by at most `a h^2 / 8` for
//! accelerations up to `a` and states `h` seconds apart.
//!
//! ```
//! use cplan_core::check::certify;
//! use cplan_core::model::{Arm, Scene, Workspace};
//! use cplan_motion::Drive;
//! use cplan_core::space::{Configuration, Path};
//!
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, Workspace::new([]))?;
//! let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
//! let path = certify(&scene, Path::new(corners.map(Configuration::from).to_vec()), 0.0).expect("nothing is in the way");
//! let timed = Drive::default().along(&scene, &path, 1.0)?;
//! let stopping = Drive { blend: 0.0, ..Drive::default() }.along(&scene, &path, 1.0)?;
//! // The corner is rounded, which is faster than to stop there.
//! assert!(timed.trajectory.duration() < stopping.trajectory.duration());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Timing
//!
//! [`time`] drives along the curve within the limits by forward-backward integration of the squared speed: on straight
//! pieces in closed form (`profile`), on a blend over spans with bounds that are linear in the squared speeds at their
//! ends (`corner`), from one stop to the next (`schedule`). Every piece of the motion is a polynomial in time of degree
//! four at most, as stated by the samples.
//!
//! With a limit on jerks, `smooth` converts that motion to a cubic B-spline (`spline`): the mean over a window that is
//! long enough for the jerk. Corners at which it is not shown to be free are passed more slowly. `retime` then drives
//! along the resulting curve in the least time.
//!
//! Single straight pieces run from rest to rest by `jerk`. It takes Ruckig's times of the seven phases, adapts them to
//! the least interval between samples, and computes the phases from the times and the length alone, so that they end at
//! the right place and keep the limits for any tolerance of the solver.
//!
//! All samples lie at whole nanoseconds (`clock`). `shape` looks for the path with the fastest motion, and `least` has
//! a lower bound on the time.
//!
//! # Files
//!
//! `message` is a motion of all joints in a ROS 2 message: `model::RobotJoints` lists the source of each value, and in
//! a task the engine adds the tool's strokes and the wrist's turns. Writers create files whole or not at all.
//!
//! A recording (`mcap`, a feature) is a list of motions, each with its start time: a CDR writer (`mcap/cdr`), the two
//! messages with their definitions (`mcap/messages`), and the crate `mcap` for the container.

mod blend;
mod certified;
mod clock;
mod corner;
mod csv;
mod drive;
mod field;
mod format;
mod jerk;
mod json;
mod least;
mod limits;
#[cfg(feature = "mcap")]
mod mcap;
mod message;
mod profile;
pub mod recorded;
mod result;
mod retime;
mod ros;
mod sample;
mod schedule;
mod shape;
mod single;
mod smooth;
mod span;
mod spline;
mod tip;
mod torque;
mod whole_file;

#[cfg(test)]
mod tests;

#[cfg(feature = "mcap")]
pub use self::mcap::{Body, Solid, Stage, mcap};
pub use blend::{BLEND_TOLERANCE, Blend, BlendedPath, Stretch};
pub use certified::{CertifiedCurve, Rounding, blend};
pub use clock::whole_nanoseconds;
pub use clock::{nanoseconds, nearest_within, round_down, round_up, seconds};
pub use cplan_handling::{INTERPOLATION, SMOOTH_INTERPOLATION};
pub use csv::csv;
pub use drive::{Drive, Objective};
pub use field::FieldReport;
pub use format::{Format, FormatError};
pub use json::field_per_line;
pub use least::least_duration;
pub use limits::Limits;
pub use message::{AccelerationJump, JointMotion};
pub use result::interpolation;
pub use result::{BlendReport, DurationOptimality, LengthOptimality, SearchReport};
pub use ros::ros_yaml;
pub use sample::after_pause;
pub use sample::{MAX_DURATION, MAX_SAMPLES, MIN_INTERVAL, TimedMotion, TimingError, Trajectory, time};
pub use single::single;
pub use span::{Place, Span};
pub use tip::TipSpeed;
pub use torque::TorqueLimit;
pub use whole_file::{WriteError, check_writable, write_whole, write_whole_set};
