//! Tests of the cells of a grid.

use serde::{Deserialize, Serialize};

/// Test that determines which cells of a grid are free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GridSpace {
    /// Exact slices. Each number of cells has two attempts: first, a cell is free if all of it is free; then, if its centre is
    /// free. [`Proves`](cplan_planners::cspace::Proves) states which of them applies.
    #[default]
    Rows,
    /// Exact slices. In every attempt, a cell is free only if all of it is free.
    Whole,
    /// Exact slices. In every attempt, a cell is free if its centre is free, as usual in the literature.
    Centers,
    /// Collision checks by parry2d at the centres of cells ([`Proves::Sampled`](cplan_planners::cspace::Proves::Sampled)), for
    /// comparison with other libraries. They take as many times longer than slices as a slice has cells.
    Sampled,
}

impl GridSpace {
    /// All tests, in the order of the command line's help.
    pub const ALL: [Self; 4] = [Self::Rows, Self::Whole, Self::Centers, Self::Sampled];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Whole => "whole",
            Self::Centers => "centers",
            Self::Sampled => "sampled",
        }
    }

    /// Returns the number of attempts with cells of one size.
    pub fn levels_per_size(self) -> usize {
        match self {
            Self::Rows => 2,
            Self::Whole | Self::Centers | Self::Sampled => 1,
        }
    }

    /// Returns the name in results. `None` for the default.
    pub fn reported_name(self) -> Option<&'static str> {
        (self != Self::Rows).then(|| self.name())
    }
}
