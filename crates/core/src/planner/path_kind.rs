//! Which of a planner's paths is wanted.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A path of a planner that has several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PathKind {
    /// The planner's own: along the gradient of a field, from cell to cell of a wavefront, through the middles of portals
    /// between the cells of a decomposition.
    Own,
    /// That one pulled taut as far as the planner's cells allow: shorter and nearer to obstacles, and no longer what the
    /// planner's method says of its path.
    Taut,
    /// Of the trapezoidal decomposition: through the middles of the portals alone, and through a cell's centre only where the portals
    /// before and after it lie on one vertical.
    Middles,
}

impl PathKind {
    /// The two kinds of every planner that has a path of its own.
    pub const ALL: [Self; 2] = [Self::Own, Self::Taut];

    /// These and the one of the trapezoidal decomposition alone, in the order of the command line's help.
    pub const CHOICES: [Self; 3] = [Self::Own, Self::Taut, Self::Middles];

    /// Name on the command line and in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Taut => "taut",
            Self::Middles => "middles",
        }
    }
}

impl fmt::Display for PathKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
