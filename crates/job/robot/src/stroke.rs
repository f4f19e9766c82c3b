//! The table `stroke` of `[robot]` in the world file.

use super::quantity::{Length, Number};
#[cfg(feature = "schema")]
use super::schema::*;
use super::toml_values::{FromToml, TomlError, TomlValue};
use crate::Spanned;
use crate::toml_table;
use toml::de::DeValue;

toml_table! {
    /// Motion of the tool down and up at picks and places.
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "stroke"))]
    pub struct StrokeTable {
        /// The joint that lowers the tool: a prismatic joint along the plane's normal, which the two joints of the arm
        /// carry. While the arm moves, it stays at its `fixed` value, except during strokes that `arch` allows.
        pub joint: Spanned<String>,
        /// Distance by which it lowers the tool, m; by default the object's lift.
        pub travel: Option<Length>,
        /// Top speed, m/s; by default the joint's.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub velocity: Option<Number>,
        /// Greatest acceleration, m/s2; by default that of its joint, or else top speed is reached in 0.25 s.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub acceleration: Option<Number>,
        /// Greatest jerk, m/s3; by default the jerk limit of its joint, or else none.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub jerk: Option<Number>,
    }
}

/// Heights of the tool above which the arm may move during a stroke; by default any height. With false, the arm rests
/// during strokes and turns of the wrist.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(inline, untagged))]
pub enum ArchValue {
    /// False if the arm is at rest during strokes and turns of the wrist; true for the default heights.
    Switch(bool),
    /// Least heights.
    Heights(ArchTable),
}

impl FromToml for ArchValue {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref() {
            DeValue::Boolean(is_on) => Ok(Self::Switch(*is_on)),
            DeValue::Table(_) => ArchTable::read(value).map(Self::Heights),
            _ => Err(TomlError::wrong_type(value, "heights { rise = 0.02, fall = 0.02 } in metres, or false")),
        }
    }
}

toml_table! {
    /// Heights of the tool above which the arm may move during a stroke.
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "arch"))]
    pub struct ArchTable {
        /// Height by which the tool rises before the arm moves, m; by default 0.
        pub rise: Option<Length>,
        /// Height above the tool's lowest position, m; by default 0. Below this height, the tool is lowered only while
        /// the arm is at rest.
        pub fall: Option<Length>,
    }
}
