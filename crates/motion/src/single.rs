//! One joint that moves while all others stand.

use super::profile::rest_to_rest;
use super::sample::SHORTEST_INTERVAL;

/// The fastest motion of a joint over a distance from rest to rest, as it is at the ends of its phases: seconds from the
/// beginning, whole nanoseconds; the way that it has gone, and its speed. Between them cubics are exact. A distance of 0 gives
/// the beginning alone. `velocity` and `acceleration` are positive.
#[must_use]
pub fn single(distance: f64, velocity: f64, acceleration: f64) -> Vec<[f64; 3]> {
    let mut samples = vec![[0.0; 3]];
    if distance > 0.0 {
        let mut time = 0.0;
        for phase in rest_to_rest(distance, velocity, acceleration, SHORTEST_INTERVAL) {
            time += phase.duration;
            samples.push([time, phase.to, phase.leave]);
        }
    }
    samples
}
