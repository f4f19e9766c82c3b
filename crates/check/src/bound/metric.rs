//! Length metrics.

use crate::certificate::{Metric, MotorSpeeds};
use crate::decimal::Decimal;
use crate::error::CheckError;
use crate::interval::{Interval, Point, length};
use num_bigint::{BigInt, Sign};
use std::fmt;

/// Returns a lower bound on the distance between two rectangles along each axis. It is 0 if they may overlap along that axis.
fn axis_distances(a: &Point, b: &Point) -> [BigInt; 2] {
    [0, 1].map(|k| (&b[k].lower - &a[k].upper).max(&a[k].lower - &b[k].upper).max(BigInt::ZERO))
}

impl fmt::Display for Metric {
    /// Writes the text that follows a length in a message: nothing, the weights, or "seconds" with the speeds.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Euclidean => Ok(()),
            Self::Weights([a, b]) => write!(f, ", with the joints' values times {a} and {b}"),
            Self::Speeds([a, b]) => write!(f, " s, if the joints' speeds are at most {a} and {b}"),
            Self::MotorSpeeds(MotorSpeeds { speeds: [a, b], ratio, speed }) => write!(
                f,
                " s, if the joints' speeds are at most {a} and {b}, and that of {ratio} q1 + q2 at most {speed}"
            ),
            Self::Motor(ratio) => write!(f, ", of q1 and {ratio} q1 + q2"),
        }
    }
}

impl Metric {
    pub(super) fn is_a_norm(&self) -> Result<(), CheckError> {
        let (factors, speed) = match self {
            Self::Euclidean | Self::Motor(_) => return Ok(()),
            Self::Weights(factors) | Self::Speeds(factors) => (factors, None),
            Self::MotorSpeeds(motor) => (&motor.speeds, Some(&motor.speed)),
        };
        let is_positive = |factor: &Decimal| Interval::from(factor).lower.sign() == Sign::Plus;
        // Whole turns must have a positive length.
        let tells = |k: usize| self.scaled(k, &Interval::whole(1)).lower.sign() == Sign::Plus;
        if factors.iter().chain(speed).all(is_positive) && tells(0) && tells(1) {
            return Ok(());
        }
        CheckError::fails("the metric's weights or speeds must be greater than 0 and not too large")
    }

    /// Returns true if the length of a displacement is its greatest entry. If false, it is the root of the sum of squares.
    pub(super) fn is_greatest(&self) -> bool {
        matches!(self, Self::Speeds(_) | Self::MotorSpeeds(_))
    }

    /// Returns true if the length of a displacement depends only on the magnitudes of its entries.
    pub(super) fn is_of_entries(&self) -> bool {
        !matches!(self, Self::Motor(_))
    }

    /// Returns the greatest entry of a displacement of this length.
    pub(super) fn reach(&self, joint: usize, length: &BigInt) -> BigInt {
        match self {
            // The second entry is the sum minus the first one times the factor.
            Self::Motor(ratio) if joint == 1 => {
                (&Interval::exact(length.clone()) * &(&Interval::whole(1) + &Interval::from(ratio).abs())).upper
            }
            _ => length.clone(),
        }
    }

    /// Converts a joint's value to the units of the metric.
    pub(super) fn scaled(&self, joint: usize, value: &Interval) -> Interval {
        match self {
            Self::Euclidean | Self::Motor(_) => value.clone(),
            Self::Weights(weights) => value * &Interval::from(&weights[joint]),
            Self::Speeds(speeds) | Self::MotorSpeeds(MotorSpeeds { speeds, .. }) => {
                value.divided(&Interval::from(&speeds[joint]))
            }
        }
    }

    /// Returns a lower bound on the sum of two entries of the displacement between two rectangles, in units of the metric.
    /// `None` if the metric has no such sum.
    fn sum_bound(&self, a: &Point, b: &Point) -> Option<BigInt> {
        let [x, y] = [0, 1].map(|k| &b[k] - &a[k]);
        let sum = match self {
            Self::Euclidean | Self::Weights(_) | Self::Speeds(_) => return None,
            Self::MotorSpeeds(MotorSpeeds { speeds, ratio, speed }) => {
                let [first, second] = speeds.each_ref().map(Interval::from);
                (&(&(&x * &first) * &Interval::from(ratio)) + &(&y * &second)).divided(&Interval::from(speed))
            }
            Self::Motor(ratio) => &(&x * &Interval::from(ratio)) + &y,
        };
        Some(sum.abs().lower)
    }

    /// Returns a lower bound on the length of all paths between two rectangles.
    pub(super) fn length_bound(&self, a: &Point, b: &Point) -> BigInt {
        let [x, y] = axis_distances(a, b);
        match (self.sum_bound(a, b), self.is_greatest()) {
            (None, true) => x.max(y),
            (Some(sum), true) => x.max(y).max(sum),
            (None, false) => length(&[x, y].map(Interval::exact)).lower,
            (Some(sum), false) => length(&[x, sum].map(Interval::exact)).lower,
        }
    }

    /// Returns true if all paths between two rectangles are at least as long as `least`, which must be positive.
    pub(super) fn is_at_least(&self, a: &Point, b: &Point, least: &BigInt) -> bool {
        let [x, y] = axis_distances(a, b);
        match (self.sum_bound(a, b), self.is_greatest()) {
            (sum, true) => x.max(y) >= *least || sum.is_some_and(|sum| sum >= *least),
            (sum, false) => {
                let y = sum.unwrap_or(y);
                &x * &x + &y * &y >= least * least
            }
        }
    }
}
