//! The rounding errors of a recording's numbers, according to their decimals.

use cplan_handling::Recording;
use cplan_model::space::Configuration;

/// A number with at least this many decimals counts as rounded in its last decimal.
const MIN_ROUNDED_DECIMALS: i32 = 6;

/// A number with fewer than [`MIN_ROUNDED_DECIMALS`] decimals counts as exact to this number of decimals: `0.5` is exactly a
/// half. In a time in seconds, nine decimals are a nanosecond.
const EXACT_DECIMALS: i32 = 9;

/// Rounding error of a computed sample, and of the piece through it, in units in the last place of a double.
const ULPS: f64 = 4.0;

/// Bounds on the rounding errors of a recording's numbers.
pub(super) struct Precision {
    position: [f64; 2],
    velocity: [f64; 2],
    acceleration: [f64; 2],
    time: f64,
}

/// Precision of the numbers of one joint.
pub(super) struct JointPrecision {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub time: f64,
}

impl Precision {
    /// Returns the bounds for the numbers of a recording, according to their decimals.
    pub fn of(recording: &Recording) -> Self {
        let each = |rows: Option<&[Configuration]>| {
            [0, 1].map(|k| rows.map_or(0.0, |rows| rounding(rows.iter().map(|row| row[k]))))
        };
        Self {
            position: each(Some(recording.positions())),
            velocity: each(recording.velocities()),
            acceleration: each(recording.accelerations()),
            time: recording.times().map_or(0.0, |times| rounding(times.iter().copied())),
        }
    }

    /// Returns the precision of `ratio q1 + q2`; `ratio` must not be negative.
    pub fn of_sum(&self, ratio: f64) -> JointPrecision {
        let sum = |[first, second]: [f64; 2]| ratio * first + second;
        let [position, velocity, acceleration] = [self.position, self.velocity, self.acceleration].map(sum);
        JointPrecision { position, velocity, acceleration, time: self.time }
    }

    /// Returns the precision of the numbers of one joint.
    pub fn of_joint(&self, k: usize) -> JointPrecision {
        JointPrecision {
            position: self.position[k],
            velocity: self.velocity[k],
            acceleration: self.acceleration[k],
            time: self.time,
        }
    }
}

/// Returns half a unit of the last decimal of the numbers, plus the rounding error of doubles of their size.
fn rounding(values: impl Iterator<Item = f64>) -> f64 {
    let (mut most, mut largest) = (0, 0.0_f64);
    for value in values {
        largest = largest.max(value.abs());
        // Doubles have at most 17 digits.
        if most < 17 {
            most = most.max(decimals(value));
        }
    }
    let digits = if most < MIN_ROUNDED_DECIMALS { EXACT_DECIMALS } else { most };
    0.5 * 10f64.powi(-digits) + ULPS * f64::EPSILON * largest
}

/// Returns the number of decimals of the shortest decimal number that reads as `value`.
fn decimals(value: f64) -> i32 {
    let text = format!("{value:e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return 0 };
    let digits = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
    digits as i32 - exponent.parse::<i32>().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_those_written() {
        for (value, expected) in [(0.0, 0), (1.0, 0), (120.0, -1), (0.25, 2), (-3.125, 3), (1e-7, 7), (1.5e-7, 8)] {
            assert_eq!(decimals(value), expected, "{value}");
        }
        assert_eq!(rounding([0.5, 1.0].into_iter()), 0.5e-9 + ULPS * f64::EPSILON);
        assert_eq!(rounding([0.5, 0.333_333].into_iter()), 0.5e-6 + 0.5 * ULPS * f64::EPSILON);
        assert!(rounding([0.123_456_789].into_iter()) < 0.6e-9);
    }
}
