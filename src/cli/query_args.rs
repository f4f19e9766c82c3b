//! Options for start, goal and clearance, which replace the world's.

use super::headings::QUERY;
use super::values::clearance;
use crate::input::{CalibrationTable, JointValues, Overrides, TipPoint};
use crate::model::Elbow;
use crate::options::word;
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
    /// Side of the elbow at --goal-tip, seen from joint 1 towards the tip. By default, both sides are allowed.
    #[arg(long, value_name = "SIDE", requires = "goal_tip", conflicts_with = "goal", value_parser = word(Elbow::ALL.map(|own| (own, own.name(), ""))))]
    pub elbow: Option<Elbow>,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Errors within which the answer holds, instead of the world's, such as
    /// "base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm".
    #[arg(long, value_name = "KEY=VALUE,..")]
    pub calibration: Option<CalibrationTable>,
}

impl QueryArgs {
    /// Returns the stated options as words of a command line.
    pub fn words(&self) -> Vec<String> {
        let Self { start, goal, goal_tip, elbow, clearance, calibration } = self;
        let words = [
            start.map(|start| format!("--start={start}")),
            goal.map(|goal| format!("--goal={goal}")),
            goal_tip.map(|TipPoint(tip)| format!("--goal-tip={},{}", tip.x, tip.y)),
            elbow.map(|elbow| format!("--elbow={}", elbow.name())),
            clearance.map(|clearance| format!("--clearance={clearance}")),
            calibration.map(|errors| format!("--calibration={errors}")),
        ];
        words.into_iter().flatten().collect()
    }

    /// Converts the options to overrides of the world file.
    pub fn overrides(&self) -> Overrides {
        let Self { start, goal, goal_tip, elbow, clearance, calibration } = *self;
        Overrides { start, goal, goal_tip, elbow, clearance, calibration }
    }
}
