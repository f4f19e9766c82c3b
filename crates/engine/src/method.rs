//! The closed list of planners, for the edges of the program.

use cplan_core::planner::{Harmonic, PathKind, Planner, Trapezoid, Visibility, Wavefront};
use cplan_roadmaps::{Prm, Triangles, Voronoi};
use std::fmt;
use std::str::FromStr;

/// A planner by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// The shortest path by slabs, slices and the search that bounds the optimum, with that bound.
    Shortest,
    /// The first certified path that slabs lead to, or a proof that there is none: the quickest answer.
    First,
    /// Visibility graph and A*: the shortest path, up to the margin.
    Visibility,
    /// Trapezoidal decomposition: a channel of cells, and a funnel path through it.
    Trapezoid,
    /// Triangular decomposition: a channel of triangles, and a funnel path through it.
    Triangles,
    /// Voronoi diagram of the obstacles: the way of greatest clearance.
    Voronoi,
    /// Probabilistic roadmap: random configurations, joined to their neighbours.
    Prm,
    /// Manhattan wavefront on a grid.
    Wavefront,
    /// Harmonic potential on a grid.
    Harmonic,
    /// Subdivision into free, stuck and mixed boxes: a path with proven room around it, or a proof that there is none.
    Subdivision,
}

impl Method {
    /// All: the default, roadmap planners, field planners, those that judge the scene itself.
    pub const ALL: [Method; 10] = [
        Method::Shortest,
        Method::Visibility,
        Method::Trapezoid,
        Method::Triangles,
        Method::Voronoi,
        Method::Prm,
        Method::Wavefront,
        Method::Harmonic,
        Method::Subdivision,
        Method::First,
    ];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            // No planners over a representation: these judge the scene itself.
            Method::Shortest => "shortest",
            Method::First => "first",
            Method::Visibility => Visibility::NAME,
            Method::Trapezoid => Trapezoid::NAME,
            Method::Triangles => Triangles::NAME,
            Method::Voronoi => Voronoi::NAME,
            Method::Prm => Prm::NAME,
            Method::Wavefront => Wavefront::NAME,
            Method::Harmonic => Harmonic::NAME,
            Method::Subdivision => "subdivision",
        }
    }

    /// The path that it gives where none is asked for: a field, or what is far from obstacles, is for being followed; cells are
    /// for finding a channel.
    #[must_use]
    pub fn path_kind(self) -> PathKind {
        if matches!(self, Method::Harmonic | Method::Voronoi) { PathKind::Own } else { PathKind::Taut }
    }

    /// Whether it has a path of its own beside the taut one. What is after the shortest path is taut as it is.
    #[must_use]
    pub fn has_own_path(self) -> bool {
        !self.optimises() && self != Method::First
    }

    /// Whether it plans among polygons, which have a margin.
    #[must_use]
    pub fn has_polygons(self) -> bool {
        self.has_roadmap() || self == Method::Shortest
    }

    /// Whether it has a roadmap, which can be searched in several orders.
    #[must_use]
    pub fn has_roadmap(self) -> bool {
        matches!(self, Method::Visibility | Method::Trapezoid | Method::Triangles | Method::Voronoi | Method::Prm)
    }

    /// Whether it is after the optimum of a metric, and tells how near its path is to it.
    #[must_use]
    pub fn optimises(self) -> bool {
        matches!(self, Method::Shortest | Method::Visibility)
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
