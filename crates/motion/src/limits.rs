//! What a motion has to keep.

use super::tip::TipSpeed;
use super::torque::TorqueLimit;
use cplan_core::model::Joint;
use cplan_core::space::Configuration;

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
    /// Greatest torques of the joints, if they have some.
    pub torque: Option<TorqueLimit<'a>>,
}

impl From<&[Joint; 2]> for Limits<'_> {
    /// The joints' own limits, and none of the tip and of torques.
    fn from(joints: &[Joint; 2]) -> Self {
        Self {
            velocity: joints.each_ref().map(|joint| joint.velocity),
            acceleration: joints.each_ref().map(|joint| joint.acceleration),
            jerk: joints.each_ref().map(|joint| joint.jerk),
            tip: None,
            torque: None,
        }
    }
}

impl Limits<'_> {
    /// The limits of a motion that is to take a share of the speed: the same motion, slower, keeps them. Torques may be what they may be at
    /// full speed: gravity does not wait.
    #[must_use]
    pub fn scaled(self, share: f64) -> Self {
        Self {
            velocity: self.velocity.map(|v| v * share),
            acceleration: self.acceleration.map(|a| a * share * share),
            jerk: self.jerk.map(|jerk| jerk.map(|j| j * share * share * share)),
            tip: self.tip.map(|tip| TipSpeed { speed: tip.speed * share, ..tip }),
            torque: self.torque,
        }
    }

    /// How far a joint goes at its top speed while the jerk takes its acceleration from nothing to the greatest, at the most.
    pub(super) fn reversal(&self) -> f64 {
        (0..2).map(|k| self.jerk[k].map_or(0.0, |j| self.acceleration[k] / j * self.velocity[k])).fold(0.0, f64::max)
    }

    /// How far a joint goes until it has its top speed, at the most.
    pub(super) fn ramp(&self) -> f64 {
        let torque = self.torque.map_or([f64::INFINITY; 2], |torque| torque.accelerations());
        let acceleration = |k: usize| self.acceleration[k].min(torque[k]);
        (0..2).map(|k| self.velocity[k] * self.velocity[k] / (2.0 * acceleration(k))).fold(0.0, f64::max)
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
