//! Lower bounds on the durations of motions.

use cplan_core::model::Arm;
use cplan_core::space::Configuration;

/// Returns the seconds that one joint takes for a distance from rest to rest, with constant acceleration, and constant
/// speed once its top speed is reached.
#[must_use]
pub fn rest_to_rest(distance: f64, velocity: f64, acceleration: f64) -> f64 {
    if distance * acceleration <= velocity * velocity {
        2.0 * (distance / acceleration).sqrt()
    } else {
        distance / velocity + velocity / acceleration
    }
}

/// Share by which such a time is lowered, so that it stays below that of the straight motion despite rounding.
const ROUNDING: f64 = 1e-9;

/// Returns a lower bound on the seconds of any motion between two configurations from rest to rest, at a share of the
/// joints' top speeds. Each joint takes at least its own time; on a circle it takes the shorter direction.
#[must_use]
pub(super) fn least_time(arm: &Arm, from: Configuration, to: Configuration, speed: f64) -> f64 {
    let displacement = arm.topology().displacement(from, to);
    let of = |k: usize| {
        let joint = &arm.joints[k];
        rest_to_rest(displacement[k].abs(), joint.velocity * speed, joint.acceleration * speed * speed)
    };
    of(0).max(of(1)) * (1.0 - ROUNDING)
}
