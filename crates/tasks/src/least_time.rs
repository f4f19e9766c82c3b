//! Lower bounds on the durations of motions.

use cplan_core::model::Arm;
use cplan_core::space::Configuration;
use cplan_handling::{Action, Step};

/// Returns the time that a joint takes for a distance from rest to rest, in seconds. It accelerates constantly until it
/// reaches its top speed.
#[must_use]
pub fn rest_to_rest(distance: f64, velocity: f64, acceleration: f64) -> f64 {
    if distance * acceleration <= velocity * velocity {
        2.0 * (distance / acceleration).sqrt()
    } else {
        distance / velocity + velocity / acceleration
    }
}

/// Fraction by which the time of a motion is lowered. So rounding cannot make the bound exceed the time of the straight
/// motion.
const ROUNDING: f64 = 1e-9;

/// Returns a lower bound, in seconds, on the duration of every motion between two configurations from rest to rest. The
/// joints move at most at the fraction `speed` of their top speeds. Each joint takes at least its own time. On a
/// circle, it takes the shorter direction.
#[must_use]
pub(super) fn least_time(arm: &Arm, from: Configuration, to: Configuration, speed: f64) -> f64 {
    let displacement = arm.topology().displacement(from, to);
    let of = |k: usize| {
        let joint = &arm.joints[k];
        rest_to_rest(displacement[k].abs(), joint.velocity * speed, joint.acceleration * speed * speed)
    };
    of(0).max(of(1)) * (1.0 - ROUNDING)
}

/// Returns a lower bound, in seconds, on the duration of a step's motion that follows from the speed of the tip along a
/// line. 0 for other steps.
#[must_use]
pub(super) fn least_line_time(step: &Step) -> f64 {
    if let Action::Follow(line) = &step.action { line.least_seconds() * (1.0 - ROUNDING) } else { 0.0 }
}
