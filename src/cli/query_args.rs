//! Options for start, goal and clearance, which replace the world's.

use super::values::clearance;
use crate::input::{JointValues, Overrides, TipPoint};
use clap::Args;

/// What can be said instead of the world file.
#[derive(Debug, Args)]
pub struct QueryArgs {
    /// Start configuration instead of the world's, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true)]
    pub start: Option<JointValues>,
    /// Goal configuration instead of the world's.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with = "goal_tip")]
    pub goal: Option<JointValues>,
    /// Goal position of the tip instead of the world's goal, metres: any IK solution that reaches it.
    #[arg(long, value_name = "x,y", allow_hyphen_values = true)]
    pub goal_tip: Option<TipPoint>,
    /// Least distance to keep from every obstacle, metres, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
}

impl QueryArgs {
    /// Returns the options in the form of the input layer.
    #[must_use]
    pub fn overrides(&self) -> Overrides {
        Overrides { start: self.start, goal: self.goal, goal_tip: self.goal_tip, clearance: self.clearance }
    }
}
