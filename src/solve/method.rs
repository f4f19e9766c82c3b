//! The closed list of planners, for the edges of the program.

use crate::plan::{Harmonic, Planner, Trapezoid, Visibility, Wavefront};
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
}

impl Method {
    /// All, roadmap planners first.
    pub const ALL: [Method; 4] = [Method::Visibility, Method::Trapezoid, Method::Wavefront, Method::Harmonic];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Method::Visibility => Visibility::NAME,
            Method::Trapezoid => Trapezoid::NAME,
            Method::Wavefront => Wavefront::NAME,
            Method::Harmonic => Harmonic::NAME,
        }
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
