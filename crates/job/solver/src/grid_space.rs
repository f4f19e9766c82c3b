//! Methods that decide the cells of a grid.

use serde::{Deserialize, Serialize};

/// The method that decides the cells of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GridSpace {
    /// Exact slices. Each size of cells is tried twice. In the first attempt, a cell counts as free only if all of it
    /// is free. In the second, it counts as free if its centre is free. [`Proves`](cplan_planners::cspace::Proves) states
    /// which of the two applies.
    #[default]
    Rows,
    /// Exact slices, and in every attempt a cell counts as free only if all of it is free.
    Whole,
    /// Exact slices. A cell counts as free if its centre is free, from the first attempt on, as usual in the
    /// literature.
    Centers,
    /// Collision checks by parry2d at the centres of cells ([`Proves::Sampled`](cplan_planners::cspace::Proves::Sampled)),
    /// for comparison with other libraries. Slower than slices by the number of cells per slice.
    Sampled,
}

impl GridSpace {
    /// All methods, in the order of the command line's help.
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

    /// Returns the name that results report. `None` for the default.
    pub fn reported_name(self) -> Option<&'static str> {
        (self != Self::Rows).then(|| self.name())
    }
}
