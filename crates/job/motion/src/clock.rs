//! The clock of a motion: times are whole nanoseconds, as in ROS.
//!
//! Each sample is at a whole nanosecond, with the exact position and velocity at that time. So no format rounds times. If it did,
//! half a nanosecond would change the acceleration of a cubic between samples `h` seconds apart by `3e-9 v / h^2`.

use cplan_geometry::Interval;

/// Nanoseconds in a second.
pub(super) const NANOSECONDS_PER_SECOND: u64 = 1_000_000_000;

/// Relative rounding error of a computed time. A time that exceeds a whole nanosecond by less is not rounded up to the next one.
const TIME_SLACK: f64 = 8.0 * f64::EPSILON;

/// Converts seconds to the nearest number of nanoseconds. Exact for times up to [`super::MAX_DURATION`], whose nanoseconds fit
/// into a double.
pub fn nanoseconds(time: f64) -> u64 {
    (time * NANOSECONDS_PER_SECOND as f64).round() as u64
}

/// Converts nanoseconds to seconds: to the nearest double, which prints with at most nine decimals.
pub fn seconds(nanoseconds: u64) -> f64 {
    nanoseconds as f64 / NANOSECONDS_PER_SECOND as f64
}

/// Greatest time that is rounded, seconds. No motion lasts longer, and doubles do not resolve a nanosecond beyond it.
const MAX_ROUNDED_TIME: f64 = 1e6;

/// Rounds a time up to a whole nanosecond, in seconds.
pub fn round_up(time: f64) -> f64 {
    if time >= MAX_ROUNDED_TIME {
        return time;
    }
    let near = nanoseconds(time);
    if seconds(near) < time { seconds(near + 1) } else { seconds(near) }
}

/// Rounds a non-negative time down to a whole nanosecond, in seconds.
pub fn round_down(time: f64) -> f64 {
    if time >= MAX_ROUNDED_TIME {
        return time;
    }
    let near = nanoseconds(time);
    if seconds(near) > time { seconds(near.saturating_sub(1)) } else { seconds(near) }
}

/// Returns the whole nanosecond, in seconds, within an interval (ends included) that is nearest to a time. `None` if the interval
/// contains none.
pub fn nearest_within(time: f64, [from, to]: Interval) -> Option<f64> {
    let (first, last) = (round_up(from), round_down(to));
    (first <= last).then(|| seconds(nanoseconds(time)).clamp(first, last))
}

/// Rounds a duration up to whole nanoseconds, but ignores an excess that is only a rounding error.
pub fn whole_nanoseconds(duration: f64) -> f64 {
    (duration * NANOSECONDS_PER_SECOND as f64 * (1.0 - TIME_SLACK)).ceil() / NANOSECONDS_PER_SECOND as f64
}

/// Returns the share of an acceleration limit that must stay unused because samples are at whole nanoseconds: the acceleration
/// may jump up to half a nanosecond before or after a sample. `interval` is the least time between samples, seconds.
///
/// The jump is at most twice the limit. So at a sample, the velocities of the polynomials on both sides differ by at most a
/// nanosecond times the limit. Differences `e0` and `e1` at the ends change the acceleration of the cubic by `(4 e0 + 2 e1) / h`,
/// and that of the polynomial of [`super::INTERPOLATION`] by `6 (e0 + e1) / h`.
pub(super) fn reserve(interval: f64) -> f64 {
    12.0 / NANOSECONDS_PER_SECOND as f64 / interval
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_rounded_up_to_the_grid() {
        for (duration, expected) in [(0.5, 0.5), (1e-6, 1e-6), (0.1 + 0.2, 0.3), (1.0 / 3.0, 0.333_333_334), (0.0, 0.0)]
        {
            assert_eq!(whole_nanoseconds(duration), expected);
        }
        assert!(whole_nanoseconds(f64::INFINITY).is_infinite());
    }

    /// The ends of the interval would both move outwards if they were rounded to the nearest nanosecond.
    #[test]
    fn times_are_rounded_into_intervals() {
        let [from, to] = [0.720_956_725_469_559_8, 0.820_956_725_669_559_8];
        assert!(seconds(nanoseconds(from)) < from && to < seconds(nanoseconds(to)));
        assert_eq!([round_up(from), round_down(to)], [0.720_956_726, 0.820_956_725]);
        assert_eq!(
            [from, 0.75, to].map(|time| nearest_within(time, [from, to])),
            [Some(0.720_956_726), Some(0.75), Some(0.820_956_725)]
        );
        assert_eq!(nearest_within(from, [from, from + 1e-10]), None);
        assert_eq!([round_up(0.3), round_down(0.3), round_down(f64::INFINITY)], [0.3, 0.3, f64::INFINITY]);
        assert_eq!(nearest_within(2.0, [1.0, f64::INFINITY]), Some(2.0));
    }

    #[test]
    fn nanoseconds_there_and_back() {
        for n in [0, 1, 123_456_789, 999_999_999_999_999] {
            assert_eq!(nanoseconds(seconds(n)), n);
        }
    }
}
