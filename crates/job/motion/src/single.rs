//! The motion of one joint while all others rest.

use super::jerk;
use super::profile::rest_to_rest;
use super::sample::MIN_INTERVAL;
use cplan_handling::ToolLimits;

/// Returns the fastest motion of one joint over a distance, from rest to rest. Each entry is an end of a phase: time in seconds
/// from the beginning (whole nanoseconds), distance so far, and speed. Cubics between the entries are exact: see [`phase_at`]. A
/// distance of 0 gives only the beginning.
pub fn single(distance: f64, limits: &ToolLimits) -> Vec<[f64; 3]> {
    let mut samples = vec![[0.0; 3]];
    if distance > 0.0 {
        let ToolLimits { velocity, acceleration, jerk } = *limits;
        let mut time = 0.0;
        let phases = match jerk {
            Some(jerk) => jerk::rest_to_rest(distance, velocity, acceleration, jerk, MIN_INTERVAL),
            None => rest_to_rest(distance, velocity, acceleration, MIN_INTERVAL),
        };
        for phase in phases {
            time += phase.duration;
            samples.push([time, phase.to, phase.leave]);
        }
    }
    samples
}

/// Returns distance, speed and acceleration at a time between both ends of a phase. Each end has a time, a distance and a speed.
/// The cubic between them is exact if the jerk is constant in the phase.
pub fn phase_at([[begin, distance, speed], [end, reached, later]]: [[f64; 3]; 2], time: f64) -> [f64; 3] {
    let span = end - begin;
    if span <= 0.0 {
        return [reached, later, 0.0];
    }
    let share = (time - begin) / span;
    let (along, first, last) = (reached - distance, speed * span, later * span);
    let (square, cube) = (3.0 * along - 2.0 * first - last, first + last - 2.0 * along);
    [
        distance + share * (first + share * (square + share * cube)),
        (first + share * (2.0 * square + 3.0 * share * cube)) / span,
        (2.0 * square + 6.0 * share * cube) / (span * span),
    ]
}
