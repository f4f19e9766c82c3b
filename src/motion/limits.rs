//! What a motion has to keep.

use super::tip::TipSpeed;
use crate::model::Joint;
use crate::space::Configuration;

/// Limits of a motion, base to tip; positive, radians or metres and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits<'a> {
    /// Greatest speed of each joint.
    pub velocity: [f64; 2],
    /// Greatest acceleration of each joint.
    pub acceleration: [f64; 2],
    /// Greatest jerk of each joint, if it has one.
    pub jerk: [Option<f64>; 2],
    /// Greatest speed of the tip, if it has one.
    pub tip: Option<TipSpeed<'a>>,
}

impl From<&[Joint; 2]> for Limits<'_> {
    /// The joints' own limits, and none of the tip.
    fn from(joints: &[Joint; 2]) -> Self {
        Self {
            velocity: joints.each_ref().map(|joint| joint.velocity),
            acceleration: joints.each_ref().map(|joint| joint.acceleration),
            jerk: joints.each_ref().map(|joint| joint.jerk),
            tip: None,
        }
    }
}

impl Limits<'_> {
    /// The limits of a motion that is to take a share of the speed: the same motion, slower, keeps them.
    #[must_use]
    pub fn scaled(self, share: f64) -> Self {
        Self {
            velocity: self.velocity.map(|v| v * share),
            acceleration: self.acceleration.map(|a| a * share * share),
            jerk: self.jerk.map(|jerk| jerk.map(|j| j * share * share * share)),
            tip: self.tip.map(|tip| TipSpeed { speed: tip.speed * share, ..tip }),
        }
    }

    /// Greatest speed along a direction of unit length: a joint that stands still does not limit it.
    pub(super) fn speed_along(&self, direction: Configuration) -> f64 {
        along(self.velocity, direction)
    }

    /// Greatest acceleration along a direction of unit length.
    pub(super) fn acceleration_along(&self, direction: Configuration) -> f64 {
        along(self.acceleration, direction)
    }

    /// Greatest jerk along a direction of unit length; infinite if no joint that moves has a limit.
    pub(super) fn jerk_along(&self, direction: Configuration) -> f64 {
        let limits = self.jerk.map(|jerk| jerk.unwrap_or(f64::INFINITY));
        along(limits, direction)
    }

    /// Whether a motion stops at every corner: it does if any joint's jerk has a limit, because the acceleration would
    /// jump where a blend begins.
    #[must_use]
    pub fn stops_at_corners(&self) -> bool {
        self.jerk.iter().any(Option::is_some)
    }
}

fn along(limits: [f64; 2], direction: Configuration) -> f64 {
    (0..2).map(|k| limits[k] / direction[k].abs()).fold(f64::INFINITY, f64::min)
}
