//! The table `stroke` of `[robot]` in the world file.

use super::quantity::Number;
use super::schema::Positive;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

/// Motion of the tool down and up at picks and places.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "stroke")]
pub struct StrokeTable {
    /// The joint that lowers the tool: it slides along the plane's normal, beyond the two that move. While the arm moves it stays at
    /// its `fixed` value, except in the overlaps that `arch` allows.
    #[schemars(with = "String")]
    pub joint: Spanned<String>,
    /// Distance by which it lowers the tool, m; by default the object's lift.
    #[schemars(with = "Option<f64>")]
    pub travel: Option<Number>,
    /// Top speed, m/s; by default the joint's.
    #[schemars(with = "Option<Positive>")]
    pub velocity: Option<Number>,
    /// Greatest acceleration, m/s2; by default the joint's, or else top speed is reached in 0.25 s.
    #[schemars(with = "Option<Positive>")]
    pub acceleration: Option<Number>,
}

/// Overlap of strokes with motions of the arm: least heights, or false if the arm is at rest during strokes.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected heights { rise = 0.02, fall = 0.02 } in metres, or false")]
#[schemars(inline)]
pub enum ArchValue {
    /// False if the arm is at rest during strokes; true for the default heights.
    Switch(bool),
    /// Least heights.
    Heights(ArchTable),
}

/// Least heights for the overlap of strokes with motions of the arm.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "arch")]
pub struct ArchTable {
    /// Height that the tool rises before the arm moves, m; by default 0.
    #[schemars(with = "Option<f64>")]
    pub rise: Option<Number>,
    /// Height above the lowest position below which the tool moves only while the arm is at rest, m; by default 0.
    #[schemars(with = "Option<f64>")]
    pub fall: Option<Number>,
}
