//! Methods that decide the cells of a grid.

use serde::{Deserialize, Serialize};

/// The method that decides the cells of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GridSpace {
    /// Exact slices: first cells that are free throughout, then cells whose centres are free
    /// ([`Proves`](cplan_core::cspace::Proves) says which).
    #[default]
    Rows,
    /// Exact slices: cells whose centres are free, from the first attempt on, as grids in the literature do.
    Centers,
    /// Collision checks of parry2d at the centres ([`Proves::Sampled`](cplan_core::cspace::Proves::Sampled)), as other
    /// libraries do, for comparison. Slower than slices by the number of cells per slice.
    Sampled,
}

impl GridSpace {
    /// All methods, in the order of the command line's help.
    pub const ALL: [Self; 3] = [Self::Rows, Self::Centers, Self::Sampled];

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Centers => "centers",
            Self::Sampled => "sampled",
        }
    }

    /// Returns the number of attempts until cells become smaller. Slices decide cells of one size by two methods.
    #[must_use]
    pub fn levels_per_size(self) -> usize {
        match self {
            Self::Rows => 2,
            Self::Centers | Self::Sampled => 1,
        }
    }

    /// Returns the name for results. `None` for the default.
    #[must_use]
    pub fn reported_name(self) -> Option<&'static str> {
        (self != Self::Rows).then(|| self.name())
    }
}
