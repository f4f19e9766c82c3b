//! Limits that a motion keeps although nobody gives them.

use serde::Serialize;
use std::collections::BTreeMap;

/// Defaults that were taken for want of limits, by joint: rad/s or m/s, rad/s2 or m/s2. Only timing depends on them; path,
/// certificate and proof do not.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct AssumedLimits {
    /// Top speeds.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub velocity: BTreeMap<String, f64>,
    /// Greatest accelerations.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub acceleration: BTreeMap<String, f64>,
}

impl AssumedLimits {
    /// Whether all limits are given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.velocity.is_empty() && self.acceleration.is_empty()
    }
}
