//! The angle of the tool along a line: the keys `wrist` and `wrist_tolerance`.

use super::reader::Reader;
use cplan_handling::{DEFAULT_WRIST_TOLERANCE, MAX_WRIST_TOLERANCE, MIN_WRIST_TOLERANCE, ToolAngle, WristGuide};
use cplan_robot::{AngleOrLength, Diagnostic, Written};
use schemars::JsonSchema;
use serde::de::value::{F64Deserializer, MapAccessDeserializer, StrDeserializer};
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt::{self, Formatter};
use toml::Spanned;

/// Angle of the tool, which the wrist keeps along the line: rad from the x axis; "tangent" for the direction of the line; or
/// an angle from that direction. By default any. It needs [robot] wrist with a joint.
#[derive(JsonSchema)]
#[schemars(inline, untagged)]
pub(super) enum WristValue {
    /// Angle of the tool from the x axis, rad.
    Fixed(#[schemars(with = "AngleOrLength")] f64),
    /// The tool points along the line.
    Tangent(TangentWord),
    /// The tool's angle from the direction of the line.
    Offset(TangentTable),
}

/// The word for the direction of the line.
#[derive(JsonSchema)]
#[schemars(inline)]
#[serde(rename_all = "snake_case")]
pub(super) enum TangentWord {
    Tangent,
}

/// The angle of the tool from the direction of the line.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "tangent")]
pub(super) struct TangentTable {
    /// Angle from the direction of the line to the tool, rad, counter-clockwise.
    #[schemars(with = "AngleOrLength")]
    tangent: Written,
}

impl<'de> Deserialize<'de> for WristValue {
    /// Reads the value without a buffer, so that its numbers keep their places in the file.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ValueVisitor;
        impl<'de> Visitor<'de> for ValueVisitor {
            type Value = WristValue;

            fn expecting(&self, formatter: &mut Formatter) -> fmt::Result {
                formatter.write_str("an angle, \"tangent\", or { tangent = 0.5 }")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<WristValue, E> {
                f64::deserialize(F64Deserializer::new(value)).map(WristValue::Fixed)
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<WristValue, E> {
                self.visit_f64(value as f64)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<WristValue, E> {
                if text == "tangent" {
                    return Ok(WristValue::Tangent(TangentWord::Tangent));
                }
                let wrong =
                    || E::custom(format!("expected an angle such as \"30deg\", or \"tangent\", found \"{text}\""));
                let angle = cplan_robot::Quantity::deserialize(StrDeserializer::<E>::new(text)).map_err(|_| wrong())?;
                Ok(WristValue::Fixed(angle.value))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<WristValue, A::Error> {
                TangentTable::deserialize(MapAccessDeserializer::new(map)).map(WristValue::Offset)
            }
        }
        deserializer.deserialize_any(ValueVisitor)
    }
}

/// Returns the requirement on the angle of the tool that a line states; `None` without one.
///
/// # Errors
/// An angle that is not finite, a tolerance out of range, and a tolerance without an angle.
pub(super) fn read(
    reader: &Reader,
    wrist: Option<&Spanned<WristValue>>,
    tolerance: Option<&Written>,
) -> Result<Option<WristGuide>, Diagnostic> {
    let Some(wrist) = wrist else {
        let refused = |at: &Written| {
            let message = "only a line with a `wrist` has a `wrist_tolerance`";
            Err(reader.source.diagnostic_at(at.span(), message).help("remove the key, or add wrist = \"tangent\""))
        };
        return tolerance.map_or(Ok(None), refused);
    };
    let angle = match wrist.get_ref() {
        WristValue::Fixed(angle) => {
            ToolAngle::Fixed(reader.source.finite(&Spanned::new(wrist.span(), *angle), "wrist")?)
        }
        WristValue::Tangent(TangentWord::Tangent) => ToolAngle::Tangent(0.0),
        WristValue::Offset(TangentTable { tangent }) => ToolAngle::Tangent(reader.quantity(tangent, "wrist, tangent")?),
    };
    let guide = WristGuide { angle, tolerance: DEFAULT_WRIST_TOLERANCE };
    let Some(written) = tolerance else { return Ok(Some(guide)) };
    let guide = WristGuide { tolerance: reader.quantity(written, "wrist_tolerance")?, ..guide };
    if guide.is_valid() {
        return Ok(Some(guide));
    }
    let message = format!(
        "wrist_tolerance must be from {MIN_WRIST_TOLERANCE} to {MAX_WRIST_TOLERANCE} rad, is {}",
        guide.tolerance
    );
    Err(reader.source.diagnostic_at(written.span(), message).help("wrist_tolerance = 0.01, in radians"))
}
