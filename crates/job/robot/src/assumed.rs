//! Limits that are assumed because no file states them, and their description.

use cplan_model::DEFAULT_TIME_TO_TOP_SPEED;
use cplan_text::short;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Limits that are assumed because no file states them, by joint. Only the timing depends on them, not the path, its certificate
/// or a proof.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AssumedLimits {
    /// Assumed top speeds by joint, in rad/s or m/s.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub velocity: BTreeMap<String, f64>,
    /// Assumed limits of acceleration by joint, in rad/s2 or m/s2.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub acceleration: BTreeMap<String, f64>,
}

impl AssumedLimits {
    /// Returns true if no limit is assumed.
    pub fn is_empty(&self) -> bool {
        self.velocity.is_empty() && self.acceleration.is_empty()
    }

    /// Describes all assumed limits. `joints` has name and unit of each joint.
    pub fn notes(&self, joints: [(&str, &str); 2]) -> Vec<String> {
        let of_joint = |(name, unit): (&str, &str)| {
            let whose = format!("joint \"{name}\"");
            let speed = self.velocity.get(name).map(|value| assumed_speed_note(&whose, *value, unit));
            let acceleration = self.acceleration.get(name).map(|value| assumed_acceleration_note(&whose, *value, unit));
            speed.into_iter().chain(acceleration)
        };
        joints.into_iter().flat_map(of_joint).collect()
    }
}

fn assumed_speed_note(whose: &str, value: f64, unit: &str) -> String {
    format!("{whose}: no top speed given; {} {unit}/s assumed, only for timing", short(value))
}

/// Describes the assumed acceleration limit of a joint.
pub fn assumed_acceleration_note(whose: &str, value: f64, unit: &str) -> String {
    let value = short(value);
    format!(
        "{whose}: no acceleration limit given; {value} {unit}/s2 assumed (top speed in {DEFAULT_TIME_TO_TOP_SPEED} s), only for timing"
    )
}
