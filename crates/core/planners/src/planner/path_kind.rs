//! The kinds of path that planners offer.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The kind of path of a planner that offers several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PathKind {
    /// The planner's own path. It follows the gradient of a field, the cells of a wavefront, or the middles of the
    /// portals of a decomposition.
    Own,
    /// The planner's own path, pulled taut as far as its cells allow. It is shorter and nearer to obstacles, and no
    /// longer has the properties of the planner's method.
    Taut,
    /// For the trapezoidal decomposition only: a path through the middles of the portals. It visits a cell's centre
    /// only if it enters and leaves the cell through the same vertical line.
    Middles,
}

impl PathKind {
    /// The kinds that all planners with their own paths offer.
    pub const ALL: [Self; 2] = [Self::Own, Self::Taut];

    /// All kinds, in the order of the command line's help.
    pub const CHOICES: [Self; 3] = [Self::Own, Self::Taut, Self::Middles];

    /// Returns the name on the command line and in results.
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
