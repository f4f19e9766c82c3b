//! The wrist in the world file's `[robot]`.

use super::error::Diagnostic;
use super::schema::Positive;
use super::world::{Number, Reader};
use cplan_core::model::Wrist;
use cplan_core::model::{assumed_acceleration, assumed_acceleration_note};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

/// The wrist's limits.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "wrist")]
pub(super) struct WristTable {
    /// The joint that it is, so that ROS 2 files have its values; without it they hold it still.
    #[schemars(with = "Option<String>")]
    pub joint: Option<Spanned<String>>,
    /// Top speed, rad/s.
    #[schemars(with = "Positive")]
    velocity: Number,
    /// Greatest acceleration, rad/s2; by default top speed is reached in 0.25 s.
    #[schemars(with = "Option<Positive>")]
    acceleration: Option<Number>,
}

impl WristTable {
    /// The wrist's limits.
    ///
    /// # Errors
    /// When one is not positive or not finite.
    pub fn read(&self, reader: &Reader) -> Result<Wrist, Diagnostic> {
        let velocity = positive(reader, &self.velocity, "velocity")?;
        let acceleration = self.acceleration.as_ref().map(|a| positive(reader, a, "acceleration")).transpose()?;
        Ok(Wrist { velocity, acceleration: acceleration.unwrap_or(assumed_acceleration(velocity)) })
    }

    /// What is to be said of a limit that was not given.
    pub fn note(&self, wrist: &Wrist) -> Option<String> {
        self.acceleration.is_none().then(|| assumed_acceleration_note("wrist", wrist.acceleration, "rad"))
    }
}

fn positive(reader: &Reader, number: &Number, what: &str) -> Result<f64, Diagnostic> {
    let value = reader.finite(number, &format!("[robot] wrist, {what}"))?;
    if value > 0.0 {
        return Ok(value);
    }
    let message = format!("[robot] wrist: {what} must be positive, is {value}");
    Err(reader.source.diagnostic_at(number.span(), message).help("wrist = { velocity = 6.0 }, in rad/s"))
}
