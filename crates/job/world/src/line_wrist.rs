//! The angle of the tool along a line: the keys `wrist` and `wrist_tolerance`.

use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_handling::{DEFAULT_WRIST_TOLERANCE, MAX_WRIST_TOLERANCE, MIN_WRIST_TOLERANCE, ToolAngle, WristGuide};
use cplan_robot::{Diagnostic, FromToml, Quantity, Spanned, TomlError, TomlValue, Written, number, toml_table};
use toml::de::DeValue;

/// Angle of the tool along the line: an angle from the x axis, rad; "tangent" for the direction of the line; or a table
/// with an angle from that direction. By default any angle. This key needs a `joint` in `[robot] wrist`.
#[cfg_attr(test, derive(JsonSchema), schemars(inline, untagged))]
pub(super) enum WristValue {
    /// Angle of the tool from the x axis, rad.
    Fixed(#[cfg_attr(test, schemars(with = "Quantity"))] f64),
    /// The tool points along the line.
    Tangent(TangentWord),
    /// The tool's angle from the direction of the line.
    Offset(TangentTable),
}

/// The word for the direction of the line.
#[cfg_attr(test, derive(JsonSchema), schemars(inline, rename_all = "snake_case"))]
pub(super) enum TangentWord {
    Tangent,
}

toml_table! {
    /// The angle of the tool from the direction of the line.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "tangent"))]
    pub(super) struct TangentTable {
        /// Angle from the direction of the line to the tool, rad, counter-clockwise.
        tangent: Written,
    }
}

impl FromToml for WristValue {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref() {
            DeValue::String(word) if word == "tangent" => Ok(Self::Tangent(TangentWord::Tangent)),
            DeValue::String(text) => {
                let wrong = || format!("expected an angle such as \"30deg\", or \"tangent\", found \"{text}\"");
                let angle = Quantity::degrees(text).ok_or_else(|| TomlError::new(value, wrong()))?;
                Ok(Self::Fixed(angle.value))
            }
            DeValue::Table(_) => TangentTable::read(value).map(Self::Offset),
            _ => number(value, "an angle, \"tangent\", or { tangent = 0.5 }").map(Self::Fixed),
        }
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
