//! Command-line options for the content of tables and ROS 2 messages.

use crate::engine::NamedJoints;
use crate::grammar::word;
use clap::Args;

/// What tables and messages hold.
#[derive(Debug, Args)]
pub struct MessageArgs {
    /// Joints that ROS 2 files (.yaml, .mcap) name: "all" for every movable joint of the robot, "planned" for the two alone.
    #[arg(long, value_parser = word::<NamedJoints>(), value_name = "WHICH", default_value = "all")]
    pub joints: NamedJoints,
    /// Write accelerations into .csv, .yaml and .mcap, too: controllers then join points by quintics instead of cubics.
    /// Refused where the acceleration jumps; limits on the jerk of both joints (--jerk) keep it from that.
    #[arg(long)]
    pub accelerations: bool,
}
