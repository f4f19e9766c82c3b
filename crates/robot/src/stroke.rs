//! The table `stroke` of `[robot]` in the world file.

use super::quantity::Number;
use super::schema::Positive;
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt::{self, Formatter};
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
    /// Greatest jerk, m/s3; by default the joint's, or else without limit.
    #[schemars(with = "Option<Positive>")]
    pub jerk: Option<Number>,
}

/// Least heights that the tool rises before the arm moves, and below which the tool moves only while the arm is at rest; by
/// default both 0. With false, the arm is at rest during strokes and turns of the wrist.
#[derive(Debug, Clone, PartialEq, JsonSchema)]
#[schemars(inline, untagged)]
pub enum ArchValue {
    /// False if the arm is at rest during strokes and turns of the wrist; true for the default heights.
    Switch(bool),
    /// Least heights.
    Heights(ArchTable),
}

impl<'de> Deserialize<'de> for ArchValue {
    /// Reads the value without a buffer, so that its numbers keep their places in the file.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EitherVisitor;
        impl<'de> Visitor<'de> for EitherVisitor {
            type Value = ArchValue;

            fn expecting(&self, formatter: &mut Formatter) -> fmt::Result {
                formatter.write_str("heights { rise = 0.02, fall = 0.02 } in metres, or false")
            }

            fn visit_bool<E>(self, value: bool) -> Result<ArchValue, E> {
                Ok(ArchValue::Switch(value))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ArchValue, A::Error> {
                ArchTable::deserialize(MapAccessDeserializer::new(map)).map(ArchValue::Heights)
            }
        }
        deserializer.deserialize_any(EitherVisitor)
    }
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
