//! From a certified path to a motion in time, and to files.
//!
//! [`time`] puts a path with its blends under a clock within the joints' limits, [`Report`] collects what a run found,
//! [`Format`] writes either as JSON, CSV, ROS 2 YAML or MCAP, and [`write_whole`] puts that into a file, whole or not at all.

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
mod profile;
mod result;
mod ros;
mod sample;
mod schedule;
mod tip;
mod whole_file;

#[cfg(test)]
mod tests;

#[cfg(feature = "mcap")]
pub use self::mcap::mcap;
pub use crate::space::{INTERPOLATION, SMOOTH_INTERPOLATION};
pub use csv::{csv, csv_with_steps};
pub use drive::Drive;
pub use field::FieldReport;
pub use format::{Format, FormatError};
pub(crate) use json::{as_map, line_a_field};
pub use limits::Limits;
pub(crate) use result::interpolation;
pub use result::{Blends, Optimum, Report, SearchUsed, Status};
pub use ros::ros_yaml;
pub use sample::{LONGEST_MOTION, MOST_SAMPLES, SHORTEST_INTERVAL, Timed, TimingError, Trajectory, time};
pub use tip::TipSpeed;
pub use whole_file::{WriteError, check_writable, write_whole, write_whole_set};
