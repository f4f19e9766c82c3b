//! The rule that ends a relaxation.

use serde::{Deserialize, Serialize};

/// The quantity that is measured in a sweep. `change` is the difference of a cell's value before and after the sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Sum of `|change|`.
    SumOfChange,
    /// Sum of `change^2`.
    SumOfSquares,
    /// Difference between the sums of `|change|` in this sweep and in the previous one. The literature uses this measure, but it
    /// is a poor one: two equal sums end the relaxation even if they are large.
    DifferenceOfSums,
    /// The greatest `|change|` of any cell.
    GreatestChange,
    /// Greatest `|change| / |value after|` of any cell. Only this measure notices changes where values are small.
    #[default]
    GreatestRelativeChange,
}

impl Measure {
    /// Returns true for [`Measure::GreatestRelativeChange`].
    pub fn is_relative(&self) -> bool {
        *self == Self::GreatestRelativeChange
    }
}

/// The rule that ends a relaxation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopping {
    /// The measured quantity.
    pub measure: Measure,
    /// Bound on the measure. A relaxation has converged when the measure is below this, or when a sweep changes nothing.
    pub below: f64,
    /// Largest number of sweeps, after which a relaxation ends without convergence.
    pub max_sweeps: usize,
}

/// Result of a relaxation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Number of sweeps: passes over all cells.
    pub sweeps: usize,
    /// The measure in the last sweep; infinite if there was none.
    pub change: f64,
    /// True if the measure fell below the requested bound.
    pub converged: bool,
}
