//! The closed list of planners, for the edges of the program.

use crate::plan::{Harmonic, PathKind, Planner, Trapezoid, Visibility, Wavefront};
use std::fmt;
use std::str::FromStr;

/// A planner by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// Visibility graph and A*: the shortest path, up to the margin.
    Visibility,
    /// Trapezoidal decomposition: a channel of cells, and a taut string through it.
    Trapezoid,
    /// Manhattan wavefront on a grid.
    Wavefront,
    /// Harmonic potential on a grid.
    Harmonic,
    /// Subdivision into free, stuck and mixed boxes: a path with proven room around it, or a proof that there is none.
    Subdivision,
}

impl Method {
    /// All, roadmap planners first.
    pub const ALL: [Method; 5] =
        [Method::Visibility, Method::Trapezoid, Method::Wavefront, Method::Harmonic, Method::Subdivision];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Method::Visibility => Visibility::NAME,
            Method::Trapezoid => Trapezoid::NAME,
            Method::Wavefront => Wavefront::NAME,
            Method::Harmonic => Harmonic::NAME,
            // No planner over a representation: it judges the scene itself.
            Method::Subdivision => "subdivision",
        }
    }

    /// The path that it gives where none is asked for: a field is for being followed, cells are for finding a channel.
    #[must_use]
    pub fn path_kind(self) -> PathKind {
        if self == Method::Harmonic { PathKind::Own } else { PathKind::Taut }
    }

    /// Whether it has a path of its own beside the taut one. What a visibility graph leads to is taut as it is.
    #[must_use]
    pub fn has_own_path(self) -> bool {
        self != Method::Visibility
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Method::ALL.into_iter().find(|m| m.name() == name).ok_or_else(|| {
            let known: Vec<&str> = Method::ALL.iter().map(|m| m.name()).collect();
            format!("no planner is called \"{name}\"; choose one of {}", known.join(", "))
        })
    }
}
