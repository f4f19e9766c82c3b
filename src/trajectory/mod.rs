//! From a certified path to a motion in time, and to files.
//!
//! [`time`] puts a path under a clock within the joints' limits, [`Report`] collects what a run found, [`Format`] writes
//! either as JSON, CSV or ROS 2 YAML, and [`write_whole`] puts the text into a file, whole or not at all.

mod csv;
mod field;
mod format;
mod profile;
mod result;
mod ros;
mod sample;
mod whole_file;

#[cfg(test)]
mod tests;

pub use csv::csv;
pub use field::FieldReport;
pub use format::{Format, UnknownFormat};
pub use result::{INTERPOLATION, Optimum, Report, SearchUsed, Status};
pub use ros::ros_yaml;
pub use sample::{LONGEST_MOTION, MOST_SAMPLES, SHORTEST_INTERVAL, TimingError, Trajectory, time};
pub use whole_file::{WriteError, check_writable, write_whole};
