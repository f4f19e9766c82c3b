//! From a certified path to a motion in time, and to files.
//!
//! [`time`] puts a path with its blends under a clock within the joints' limits, [`Report`] collects what a run found,
//! [`Format`] writes either as JSON, CSV, ROS 2 YAML or MCAP, and [`write_whole`] puts that into a file, whole or not at all.
//!
//! What each format promises to those who read it, by the way in which they join samples:
//!
//! | format | who reads it | how it joins samples |
//! |---|---|---|
//! | JSON `trajectory` | programs that know cplan | by [`INTERPOLATION`], which the file states |
//! | CSV | tables, plots, other planners | cubics through positions and velocities |
//! | YAML, MCAP `/joint_trajectory` | `joint_trajectory_controller` | cubics through positions and velocities |
//! | the same with accelerations | `joint_trajectory_controller` | quintics |
//! | MCAP `/joint_states` | `robot_state_publisher`, Foxglove | each state for itself; displays hold it or draw lines to the next |
//!
//! The cubics are the certified motion: on straight pieces exactly, on blends within [`crate::space::HAIR`], which the
//! certificate covers, and they keep the limits; while the arm stands the samples are equal and at rest. Quintics are that
//! motion only where the acceleration does not jump, so accelerations are left out unless they are asked for, and refused
//! where they do. States lie on the motion; lines between them leave it by no more than `a h^2 / 8` for accelerations up to
//! `a` and states `h` seconds apart.

mod clock;
mod corner;
mod csv;
mod drive;
mod field;
mod format;
mod jerk;
mod json;
mod limits;
#[cfg(feature = "mcap")]
mod mcap;
mod message;
mod profile;
mod result;
mod ros;
mod sample;
mod schedule;
mod single;
mod tip;
mod whole_file;

#[cfg(test)]
mod tests;

#[cfg(feature = "mcap")]
pub use self::mcap::mcap;
pub use crate::space::{INTERPOLATION, SMOOTH_INTERPOLATION};
pub use clock::whole_nanoseconds;
pub(crate) use clock::{nanoseconds, seconds};
pub use csv::{csv, csv_with_steps};
pub use drive::Drive;
pub use field::FieldReport;
pub use format::{Format, FormatError};
pub(crate) use json::{as_map, line_a_field};
pub use limits::Limits;
pub use message::{AccelerationJump, JointMotion};
pub(crate) use result::interpolation;
pub use result::{Blends, Optimum, Report, SearchUsed};
pub use ros::ros_yaml;
pub use sample::{LONGEST_MOTION, MOST_SAMPLES, SHORTEST_INTERVAL, Timed, TimingError, Trajectory, time};
pub use single::single;
pub use tip::TipSpeed;
pub use whole_file::{WriteError, check_writable, write_whole, write_whole_set};
