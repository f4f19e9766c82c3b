//! When a relaxation ends.

use serde::{Deserialize, Serialize};

/// The quantity measured in a sweep. `change` is the difference of a value before and after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Sum of `|change|`.
    SumOfChange,
    /// Sum of `change^2`.
    SumOfSquares,
    /// Difference between the sum of `|change|` and that of the sweep before. (Two equal sums of any size end the
    /// relaxation: the literature uses it, that does not make it a good rule.)
    DifferenceOfSums,
    /// The greatest `|change|` of any cell.
    GreatestChange,
    /// Greatest `|change| / |value after|`: the only one that sees what happens where values are small.
    #[default]
    GreatestRelativeChange,
}

impl Measure {
    /// Returns true for [`Measure::GreatestRelativeChange`].
    #[must_use]
    pub fn is_relative(&self) -> bool {
        *self == Self::GreatestRelativeChange
    }
}

/// When a relaxation ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopping {
    /// The measured quantity.
    pub measure: Measure,
    /// It has converged when the measure falls below this, and when a sweep changes nothing at all.
    pub below: f64,
    /// It ends after so many sweeps anyway.
    pub max_sweeps: usize,
}

/// Result of a relaxation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Passes over all cells.
    pub sweeps: usize,
    /// The measure in the last of them; infinite before the first.
    pub change: f64,
    /// True if the measure fell below the requested bound.
    pub converged: bool,
}

/// Sums up the changes of a sweep.
pub(super) trait Tally {
    /// Adds a value to the measure.
    fn add(total: f64, old: f64, new: f64) -> f64;
}

pub(super) struct SumTally;
pub(super) struct SquareTally;
pub(super) struct GreatestTally;
pub(super) struct RelativeTally;

impl Tally for SumTally {
    fn add(total: f64, old: f64, new: f64) -> f64 {
        total + (new - old).abs()
    }
}

impl Tally for SquareTally {
    fn add(total: f64, old: f64, new: f64) -> f64 {
        total + (new - old) * (new - old)
    }
}

impl Tally for GreatestTally {
    fn add(total: f64, old: f64, new: f64) -> f64 {
        total.max((new - old).abs())
    }
}

impl Tally for RelativeTally {
    fn add(total: f64, old: f64, new: f64) -> f64 {
        // Nothing over nothing is NaN, which `max` passes over: no change. To 0 from anything else is infinite.
        total.max((new - old).abs() / new.abs())
    }
}
