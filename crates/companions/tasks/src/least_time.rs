//! Lower bounds on the durations of motions.

use super::ik_solutions::JOINT_ROUNDING;
use cplan_handling::{Action, Step, ToolLimits, Wrist, rest_to_rest};
use cplan_model::Arm;
use cplan_model::space::Configuration;

/// Returns a lower bound on the duration of a turn, in seconds.
pub(super) fn least_turn(wrist: &Wrist, angle: f64) -> f64 {
    least_of_tool(angle.abs(), &wrist.limits())
}

/// Returns a lower bound, in seconds, on the duration of every motion of a joint of the tool over a distance, from rest to
/// rest.
pub(super) fn least_of_tool(distance: f64, limits: &ToolLimits) -> f64 {
    let seconds = limits.least_seconds(distance);
    if limits.jerk.is_some() { seconds * (1.0 - ROUNDING) } else { seconds }
}

/// Fraction by which the time of a motion is lowered. So rounding cannot make the bound exceed the time of the straight
/// motion.
const ROUNDING: f64 = 1e-9;

/// Returns a lower bound, in seconds, on the duration of every motion between two configurations from rest to rest. The
/// joints move at most at the fraction `speed` of their top speeds. Each joint takes at least its own time. On a
/// circle, it takes the shorter direction. A displacement that is due to rounding takes no time.
pub(super) fn least_time(arm: &Arm, from: Configuration, to: Configuration, speed: f64) -> f64 {
    let displacement = arm.topology().displacement(from, to);
    let of = |k: usize| {
        let joint = &arm.joints[k];
        let distance = Some(displacement[k].abs()).filter(|distance| *distance > JOINT_ROUNDING).unwrap_or(0.0);
        rest_to_rest(distance, joint.velocity * speed, joint.acceleration * speed * speed)
    };
    of(0).max(of(1)) * (1.0 - ROUNDING)
}

/// Returns a lower bound, in seconds, on the duration of a step's motion that follows from the speed of the tip along a
/// line. 0 for other steps.
pub(super) fn least_line_time(step: &Step) -> f64 {
    if let Action::Follow(line) = &step.action { line.least_seconds() * (1.0 - ROUNDING) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_motion::single;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the bound with the fastest motions, whose phases are rounded up to whole nanoseconds.
        #[test]
        fn the_bound_of_the_tool_is_close(
            distance in 1e-3..6.0_f64, velocity in 0.1..9.0_f64, acceleration in 1.0..90.0_f64,
            jerk in proptest::option::of(1.0..5000.0_f64),
        ) {
            let limits = ToolLimits { velocity, acceleration, jerk };
            let (least, is) = (least_of_tool(distance, &limits), single(distance, &limits).last().unwrap()[0]);
            prop_assert!(least <= is && is <= least * (1.0 + 1e-4) + 1e-4, "{least} {is}");
        }
    }
}
