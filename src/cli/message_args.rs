//! Command-line options for the content of tables and ROS 2 messages.

use super::headings::OUTPUT;
use crate::engine::NamedJoints;
use crate::options::{JOINTS, word};
use clap::Args;

/// Content of tables and messages.
#[derive(Debug, PartialEq, Args)]
#[command(next_help_heading = OUTPUT)]
pub struct MessageArgs {
    /// Joints in ROS 2 files (.yaml, .mcap).
    #[arg(long, value_parser = word(JOINTS), value_name = "WHICH", default_value = "all")]
    pub joints: NamedJoints,
    /// Also write accelerations into .csv, .yaml and .mcap; controllers then join points by quintics instead of cubics.
    /// This is refused if the acceleration jumps; limits on the jerk of both joints (--jerk) prevent jumps.
    #[arg(long)]
    pub accelerations: bool,
}
