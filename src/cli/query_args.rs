//! Options for start, goal and clearance, which replace the world's.

use super::headings::QUERY;
use super::values::clearance;
use crate::input::{JointValues, Overrides, TipPoint};
use clap::Args;

/// Values that replace those of the world file.
#[derive(Debug, PartialEq, Args)]
#[command(next_help_heading = QUERY)]
pub struct QueryArgs {
    /// Start configuration instead of the world's, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true)]
    pub start: Option<JointValues>,
    /// Goal configuration instead of the world's.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with = "goal_tip")]
    pub goal: Option<JointValues>,
    /// Goal position of the tip instead of the world's goal, metres or as in 350mm,0.5. Any IK solution counts.
    #[arg(long, value_name = "x,y", allow_hyphen_values = true)]
    pub goal_tip: Option<TipPoint>,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
}

impl QueryArgs {
    /// Returns the stated options as words of a command line.
    pub fn words(&self) -> Vec<String> {
        let Self { start, goal, goal_tip, clearance } = self;
        let words = [
            start.map(|start| format!("--start={start}")),
            goal.map(|goal| format!("--goal={goal}")),
            goal_tip.map(|TipPoint(tip)| format!("--goal-tip={},{}", tip.x, tip.y)),
            clearance.map(|clearance| format!("--clearance={clearance}")),
        ];
        words.into_iter().flatten().collect()
    }

    /// Converts the options to overrides of the world file.
    pub fn overrides(&self) -> Overrides {
        Overrides { start: self.start, goal: self.goal, goal_tip: self.goal_tip, clearance: self.clearance }
    }
}
