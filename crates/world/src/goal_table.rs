//! The world file's `[goal]`.

use cplan_robot::{AngleOrLength, Number, NumberPair, Numbers, Written};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

/// Where the arm is to go: joint values, a place for the tip in whatever IK solution is best, or areas for the tip.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "goal", extend("oneOf" = [{ "required": ["joints"] }, { "required": ["tip"] }, { "required": ["areas"] }]))]
pub(super) struct GoalTable {
    /// Values of both joints, base to tip, rad or m.
    #[schemars(with = "Option<[AngleOrLength; 2]>")]
    pub joints: Option<Spanned<Vec<Written>>>,
    /// Coordinates of the tip, m.
    #[schemars(with = "Option<NumberPair>")]
    pub tip: Option<Numbers>,
    /// Rectangles for the tip, any of which will do, each by two opposite corners, m; of an arm that does not slide along both axes each
    /// counts as its middle. Not in steps.
    #[schemars(with = "Option<Vec<[NumberPair; 2]>>")]
    pub areas: Option<Spanned<Vec<Spanned<Vec<Numbers>>>>>,
    /// Value of the joint that lowers the tool, m; by default it is raised. Not in steps.
    #[schemars(with = "Option<f64>")]
    pub stroke: Option<Number>,
    /// Value of the wrist's joint, rad; by default that at the start. Not in steps.
    #[schemars(with = "Option<AngleOrLength>")]
    pub wrist: Option<Written>,
}
