//! Lower bounds on the duration of motions.

use super::limits::{LimitedAxis, Limits};

/// Number of times that the range of durations is halved in the search for a duration.
const TIME_HALVINGS: usize = 64;

/// Relative rounding error of a duration that bisection finds.
const ROUNDING: f64 = 1e-9;

/// Returns a lower bound on the duration, in seconds, of every motion from rest to rest on a path. `length` is the time, in
/// seconds, that the path takes at the joints' top speeds ([`cplan_model::space::Metric::Time`]). If the limits include those of
/// a sum of joint values, the metric may include that sum.
///
/// Let `f(t)` be the greatest fraction of its top speed that any joint, or the sum, can reach `t` seconds after rest, given its
/// acceleration and jerk. At the time `t` of a motion of `T` seconds, all speeds are at most the fraction
/// `min(1, f(t), f(T - t))` of top speed. So the length of the path is at most the integral of this fraction, which increases
/// with `T`.
pub fn least_duration(length: f64, limits: &Limits) -> f64 {
    let limits = Limits { wrist: None, ..*limits };
    // The acceleration of the sum is at most that of both joints together.
    let together = |of: &dyn Fn(usize) -> f64| limits.sum.map_or(0.0, |sum| sum.ratio.abs() * of(0) + of(1));
    let rate = |own: &dyn Fn(&LimitedAxis) -> f64, of_joint: &dyn Fn(usize) -> f64| {
        let rate = |axis: LimitedAxis| match axis.joint() {
            Some(_) => own(&axis) / axis.velocity,
            None => own(&axis).min(together(of_joint)) / axis.velocity,
        };
        limits.axes().map(rate).fold(0.0, f64::max)
    };
    let acceleration = rate(&|axis| axis.acceleration, &|k| limits.acceleration[k]);
    let jerk = rate(&|axis| axis.jerk.unwrap_or(f64::INFINITY), &|k| limits.jerk[k].unwrap_or(f64::INFINITY));
    // Time in which the jerk builds up the greatest acceleration, or in which the greatest speed is reached if that is earlier; 0
    // without a limit on the jerk.
    let grown = if jerk.is_finite() { (acceleration / jerk).min((2.0 / jerk).sqrt()) } else { 0.0 };
    let lost = if jerk.is_finite() { jerk * grown * grown / 2.0 } else { 0.0 };
    let top = if lost < 1.0 && acceleration.is_finite() { grown + (1.0 - lost) / acceleration } else { grown };
    // The distance from rest in this many seconds.
    let distance = |time: f64| {
        let first = time.min(grown);
        let second = (time.min(top) - grown).max(0.0);
        let growing = if first > 0.0 { jerk * first * first * first / 6.0 } else { 0.0 };
        let rising = if second > 0.0 { second * (lost + acceleration * second / 2.0) } else { 0.0 };
        growing + rising + (time - top).max(0.0)
    };
    let (mut too_short, mut enough) = (length, length + 2.0 * top);
    for _ in 0..TIME_HALVINGS {
        let middle = (too_short + enough) / 2.0;
        if 2.0 * distance(middle / 2.0) < length {
            too_short = middle;
        } else {
            enough = middle;
        }
    }
    too_short * (1.0 - ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(velocity: f64, acceleration: f64, jerk: Option<f64>) -> Limits<'static> {
        Limits {
            velocity: [velocity; 2],
            acceleration: [acceleration; 2],
            jerk: [jerk; 2],
            tip: None,
            torque: None,
            wrist: None,
            sum: None,
        }
    }

    #[test]
    fn bang_bang_durations_agree_with_the_closed_form() {
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-7 * expected, "{found} {expected}");
        // 6 rad at 2 rad/s with 4 rad/s2: 3 s and a ramp.
        close(least_duration(3.0, &limits(2.0, 4.0, None)), 3.5);
        // 0.5 rad: the top speed is not reached.
        close(least_duration(0.25, &limits(2.0, 4.0, None)), 2.0 * (0.5_f64 / 4.0).sqrt());
        close(least_duration(0.25, &limits(2.0, f64::INFINITY, None)), 0.25);
    }

    /// Compares the bound for limited jerk with a numerical integration in small time steps.
    #[test]
    fn durations_with_a_jerk_limit_agree_with_integration() {
        for (length, jerk) in [(0.1, 5.0), (0.1, 500.0), (1.0, 20.0), (3.0, 1.0), (1e-4, 3.0)] {
            let [velocity, acceleration] = [2.0, 4.0];
            let found = least_duration(length, &limits(velocity, acceleration, Some(jerk)));
            let (n, mut distance, mut speed) = (200_000, 0.0, 0.0_f64);
            let h = found / 2.0 / f64::from(n);
            for i in 0..n {
                let pull = (jerk * (f64::from(i) + 0.5) * h).min(acceleration);
                let next = (speed + pull * h).min(velocity);
                distance += (speed + next) / 2.0 * h;
                speed = next;
            }
            let expected = length * velocity;
            assert!(
                (2.0 * distance - expected).abs() < 1e-4 * expected,
                "{length} {jerk}: {} {expected}",
                2.0 * distance
            );
        }
    }
}
