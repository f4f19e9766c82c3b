//! The kinds of a planner's paths.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The kind of path, for planners with several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PathKind {
    /// The planner's own path: along the gradient of a field, from cell to cell of a wavefront, or through the middles
    /// of portals between the cells of a decomposition.
    Own,
    /// The planner's own path, pulled taut as far as its cells allow. It is shorter and nearer to obstacles, and the
    /// properties of the planner's method no longer apply to it.
    Taut,
    /// A path of the trapezoidal decomposition through the middles of the portals alone. It visits a cell's centre only
    /// where the portals before and after it lie on one vertical.
    Middles,
}

impl PathKind {
    /// The two kinds for every planner with a path of its own.
    pub const ALL: [Self; 2] = [Self::Own, Self::Taut];

    /// These, and the one for the trapezoidal decomposition only, in the order of the command line's help.
    pub const CHOICES: [Self; 3] = [Self::Own, Self::Taut, Self::Middles];

    /// Returns the name on the command line and in results.
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
