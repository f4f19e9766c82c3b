//! The motion of one joint while all others rest.

use super::profile::rest_to_rest;
use super::sample::MIN_INTERVAL;

/// Returns the fastest motion of one joint over a distance, from rest to rest. Each entry is an end of a phase: the
/// time in seconds from the beginning (whole nanoseconds), the distance so far, and the speed. Cubics between the
/// entries are exact. A distance of 0 gives only the beginning. `velocity` and `acceleration` are positive.
#[must_use]
pub fn single(distance: f64, velocity: f64, acceleration: f64) -> Vec<[f64; 3]> {
    let mut samples = vec![[0.0; 3]];
    if distance > 0.0 {
        let mut time = 0.0;
        for phase in rest_to_rest(distance, velocity, acceleration, MIN_INTERVAL) {
            time += phase.duration;
            samples.push([time, phase.to, phase.leave]);
        }
    }
    samples
}
