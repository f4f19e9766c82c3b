//! How grids come about.

use serde::{Deserialize, Serialize};

/// How the cells of a grid are decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GridSpace {
    /// By exact slices: cells that are wholly free, then cells whose centres are ([`Proves`](cplan_core::cspace::Proves) says which).
    #[default]
    Rows,
    /// By exact slices: cells whose centres are free, from the first attempt on, as the literature's grids have it.
    Centers,
    /// By parry2d's collision checks at the centres ([`Proves::Sampled`](cplan_core::cspace::Proves::Sampled)): what other libraries
    /// do, to compare with. Slower by as much as there are more cells than slices.
    Sampled,
}

impl GridSpace {
    /// All, in the order of the command line's help.
    pub const ALL: [Self; 3] = [Self::Rows, Self::Centers, Self::Sampled];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Centers => "centers",
            Self::Sampled => "sampled",
        }
    }

    /// Attempts until cells become smaller: by slices those of one size are decided in two ways.
    #[must_use]
    pub fn levels_of_a_size(self) -> usize {
        match self {
            Self::Rows => 2,
            Self::Centers | Self::Sampled => 1,
        }
    }

    /// What results say of it: nothing of slices.
    #[must_use]
    pub fn told(self) -> Option<&'static str> {
        (self != Self::Rows).then(|| self.name())
    }
}
