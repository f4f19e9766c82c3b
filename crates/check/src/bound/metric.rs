//! Length metrics.

use crate::certificate::Metric;
use crate::decimal::Decimal;
use crate::error::CheckError;
use crate::interval::{Interval, Point, length};
use num_bigint::{BigInt, Sign};
use std::fmt;

/// Returns a lower bound on the distance between two rectangles along each axis. It is 0 if they may overlap along the
/// axis.
fn axis_distances(a: &Point, b: &Point) -> [BigInt; 2] {
    [0, 1].map(|k| (&b[k].lower - &a[k].upper).max(&a[k].lower - &b[k].upper).max(BigInt::ZERO))
}

impl fmt::Display for Metric {
    /// Writes the text that follows a length in a message: nothing, the weights, or seconds with the speeds.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Euclidean => Ok(()),
            Self::Weights([a, b]) => write!(f, ", with the joints' values times {a} and {b}"),
            Self::Speeds([a, b]) => write!(f, " s, at speeds of the joints of no more than {a} and {b}"),
        }
    }
}

impl Metric {
    pub(super) fn is_a_norm(&self) -> Result<(), CheckError> {
        let (Self::Weights(factors) | Self::Speeds(factors)) = self else { return Ok(()) };
        let is_positive = |factor: &Decimal| Interval::from(factor).lower.sign() == Sign::Plus;
        // Whole turns must have a positive length.
        let tells = |k: usize| self.scaled(k, &Interval::whole(1)).lower.sign() == Sign::Plus;
        if factors.iter().all(is_positive) && tells(0) && tells(1) {
            return Ok(());
        }
        CheckError::fails("the metric's weights or speeds must be greater than 0 and not too large")
    }

    /// Returns true if the metric is the greatest entry of a displacement. If false, it is the root of the sum of
    /// squares.
    pub(super) fn is_greatest(&self) -> bool {
        matches!(self, Self::Speeds(_))
    }

    /// Converts a joint's value to the units of the metric.
    pub(super) fn scaled(&self, joint: usize, value: &Interval) -> Interval {
        match self {
            Self::Euclidean => value.clone(),
            Self::Weights(weights) => value * &Interval::from(&weights[joint]),
            Self::Speeds(speeds) => value.divided(&Interval::from(&speeds[joint])),
        }
    }

    /// Returns a lower bound on the length of all paths between two rectangles.
    pub(super) fn length_bound(&self, a: &Point, b: &Point) -> BigInt {
        let [x, y] = axis_distances(a, b);
        if self.is_greatest() { x.max(y) } else { length(&[x, y].map(Interval::exact)).lower }
    }

    /// Returns true if all paths between two rectangles are at least as long as `least`, which must be positive.
    pub(super) fn is_at_least(&self, a: &Point, b: &Point, least: &BigInt) -> bool {
        let [x, y] = axis_distances(a, b);
        if self.is_greatest() { x.max(y) >= *least } else { &x * &x + &y * &y >= least * least }
    }
}
