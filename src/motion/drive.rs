//! From a certified path to a motion: corners and time.

use super::{Limits, Timed, TimingError, TipSpeed, time};
use crate::check::{CertifiedCurve, CertifiedPath, blend};
use crate::model::Scene;
use serde::{Deserialize, Serialize};

/// How to drive along a path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Time between two samples, seconds.
    pub period: f64,
    /// Greatest distance from a corner at which the motion may leave the path to round it, in joint space; 0 to stop at
    /// every corner, infinite to let the clearance and the path decide. Where a joint's jerk has a limit every corner is
    /// stopped at.
    #[serde(with = "crate::text::number")]
    pub blend: f64,
    /// Greatest speed of the tip, metres a second; none if only the joints have limits.
    pub tip_speed: Option<f64>,
}

impl Default for Drive {
    /// A sample every hundredth of a second, corners blended as the clearance allows, no limit of the tip.
    fn default() -> Self {
        Self { period: 0.01, blend: f64::INFINITY, tip_speed: None }
    }
}

impl Drive {
    /// The fastest motion along a path at this share of the joints' top speeds (more than 0, at most 1), as [`time`] has
    /// it, within the scene's clearance.
    ///
    /// # Errors
    /// A motion that lasts too long, or has too many samples.
    pub fn along(&self, scene: &Scene, path: &CertifiedPath, speed: f64) -> Result<Timed, TimingError> {
        let tip = self.tip_speed.map(|speed| TipSpeed { arm: scene.arm(), speed });
        let limits = Limits { tip, ..Limits::from(&scene.arm().joints) }.scaled(speed);
        let curve = if self.blend > 0.0 && !limits.stops_at_corners() {
            blend(scene, path, self.blend, scene.workspace().clearance)
        } else {
            CertifiedCurve::from(path.clone())
        };
        time(curve, &limits, self.period)
    }
}
