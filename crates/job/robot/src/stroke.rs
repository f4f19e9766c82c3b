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
        /// The joint that lowers the tool: it slides along the plane's normal, beyond the two that move. While the arm moves it stays at
        /// its `fixed` value, except in the overlaps that `arch` allows.
        pub joint: Spanned<String>,
        /// Distance by which it lowers the tool, m; by default the object's lift.
        pub travel: Option<Length>,
        /// Top speed, m/s; by default the joint's.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub velocity: Option<Number>,
        /// Greatest acceleration, m/s2; by default the joint's, or else top speed is reached in 0.25 s.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub acceleration: Option<Number>,
        /// Greatest jerk, m/s3; by default the joint's, or else without limit.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub jerk: Option<Number>,
    }
}

/// Least heights that the tool rises before the arm moves, and below which the tool moves only while the arm is at rest; by
/// default both 0. With false, the arm is at rest during strokes and turns of the wrist.
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
    /// Least heights for the overlap of strokes with motions of the arm.
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "arch"))]
    pub struct ArchTable {
        /// Height that the tool rises before the arm moves, m; by default 0.
        pub rise: Option<Length>,
        /// Height above the lowest position below which the tool moves only while the arm is at rest, m; by default 0.
        pub fall: Option<Length>,
    }
}
