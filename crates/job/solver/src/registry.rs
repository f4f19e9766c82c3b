//! The planners. To add one, add an entry to the table at the end of this file.

use super::ladder::{Request, by_visibility, on_cells, on_polygons, on_zoned_cells};
use super::setting::{DEFAULT_CELLS, Setting, Settings};
use super::{Answer, CellCounts, first, shortest, subdivision};
use Setting::{
    Cells, Criterion, Field, Forward, Gap, Graph, GridSearch, Margin, Nearest, Neighborhood, Path, Samples, Search,
    Seed, Space, Ties,
};
use cplan_fields::FieldPlanner;
use cplan_harmonic::Harmonic;
use cplan_planners::planner::{PathKind, Planner, Trapezoid, Visibility, Wavefront};
use cplan_roadmaps::{Prm, Triangles, Voronoi};
use std::fmt;
use std::str::FromStr;

/// All that the rest of the program needs to know about a planner.
#[derive(Debug)]
pub struct Descriptor {
    /// Name on the command line.
    pub name: &'static str,
    /// Description of the planner, as a line of the help.
    pub summary: &'static str,
    /// Family to which the planner belongs.
    pub family: Family,
    /// Kinds of paths that the planner can give.
    pub paths: &'static [PathKind],
    /// Settings that the planner reads, in their order in JSON. Some of them imply how the planner works:
    /// - [`Setting::Gap`]: it minimises length, and bounds its path's distance from the optimum.
    /// - [`Setting::Margin`]: it plans among polygons.
    /// - [`Setting::Search`]: it plans on a roadmap.
    /// - [`Setting::Space`]: it plans on a grid.
    pub settings: &'static [Setting],
    /// Default settings.
    pub(super) defaults: fn() -> Settings,
    /// Function that answers a request with this planner.
    pub(super) solve: fn(Request) -> Answer,
}

/// A family of planners that work alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// Planners that search a graph among polygons.
    Roadmap,
    /// Planners that compute values on the cells of a grid.
    Field,
    /// Planners that work on the scene itself: by exact slices, slabs or boxes.
    Exact,
    /// Planners of other programs, whose paths are read from files.
    Other,
}

impl Family {
    /// All families, in the order of the tables.
    pub const ALL: [Family; 4] = [Family::Roadmap, Family::Field, Family::Exact, Family::Other];

    /// Returns the name of the family's planners, in the plural.
    pub fn name(self) -> &'static str {
        match self {
            Family::Roadmap => "roadmaps",
            Family::Field => "fields",
            Family::Exact => "exact planners",
            Family::Other => "other programs",
        }
    }
}

impl Method {
    /// Returns the planner's name on the command line.
    pub fn name(self) -> &'static str {
        self.descriptor().name
    }

    /// Returns true if the planner reads a setting.
    pub fn reads(self, setting: Setting) -> bool {
        self.descriptor().settings.contains(&setting)
    }

    /// Returns the kind of path that the planner gives by default.
    pub fn path_kind(self) -> PathKind {
        (self.descriptor().defaults)().path
    }

    /// Returns true if the planner has a path of its own in addition to the taut one.
    pub fn has_own_path(self) -> bool {
        self.descriptor().paths.contains(&PathKind::Own)
    }

    /// Returns true if the planner minimises length in some metric, and bounds its path's distance from the optimum.
    pub fn optimizes(self) -> bool {
        self.reads(Gap)
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

/// Defines [`Method`] from the table: for each planner a variant, with its line in the help as documentation, and a descriptor.
macro_rules! planners {
    ($($method:ident: $summary:literal { $($field:ident: $value:expr),+ $(,)? })+) => {
        /// A planner by name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Method {
            $(#[doc = $summary] $method),+
        }

        impl Method {
            /// All planners, in the order of the help and of tables.
            pub const ALL: [Method; [$(Method::$method),+].len()] = [$(Method::$method),+];

            /// Returns the planner's description.
            pub fn descriptor(self) -> &'static Descriptor {
                match self {
                    $(Method::$method => const { &Descriptor { summary: $summary, $($field: $value),+ } }),+
                }
            }
        }
    };
}

const TAUT_PATHS: &[PathKind] = &[PathKind::Taut];
const OWN_AND_TAUT_PATHS: &[PathKind] = &[PathKind::Own, PathKind::Taut];

// Order: the default planner, roadmap planners, field planners, and planners that work on the scene itself.
planners! {
    Shortest: "The shortest path by exact slices, with a proven bound on the optimum, or a proof of infeasibility" {
        name: "shortest",
        family: Family::Exact,
        paths: TAUT_PATHS,
        settings: &[Criterion, Gap, Margin],
        defaults: Settings::default,
        solve: shortest::solve,
    }
    Visibility: "Visibility graph: the shortest path, with a proven bound on the optimum" {
        name: Visibility::NAME,
        family: Family::Roadmap,
        paths: TAUT_PATHS,
        settings: &[Criterion, Gap, Margin, Search, Graph],
        defaults: Settings::default,
        solve: by_visibility,
    }
    Trapezoid: "Trapezoidal decomposition: a channel of cells, and the funnel path through it" {
        name: Trapezoid::NAME,
        family: Family::Roadmap,
        paths: &[PathKind::Own, PathKind::Taut, PathKind::Middles],
        settings: &[Path, Margin, Search],
        defaults: Settings::default,
        solve: |request| on_polygons(request, |s, _| Trapezoid { path: s.path, search: s.search }),
    }
    Triangles: "Triangulation of free space: a channel of triangles, and the funnel path through it" {
        name: Triangles::NAME,
        family: Family::Roadmap,
        paths: OWN_AND_TAUT_PATHS,
        settings: &[Path, Margin, Search],
        defaults: Settings::default,
        solve: |request| on_polygons(request, |s, _| Triangles { path: s.path, search: s.search }),
    }
    Voronoi: "Voronoi diagram: the path that keeps the greatest distance from obstacles, in joint space" {
        name: Voronoi::NAME,
        family: Family::Roadmap,
        paths: OWN_AND_TAUT_PATHS,
        settings: &[Path, Margin, Search],
        // The planner's own path keeps far from obstacles; a taut path would not.
        defaults: || Settings { path: PathKind::Own, ..Settings::default() },
        solve: |request| on_polygons(request, |s, _| Voronoi { path: s.path, search: s.search }),
    }
    Prm: "Probabilistic roadmap: random configurations, each joined to the nearest visible ones" {
        name: Prm::NAME,
        family: Family::Roadmap,
        paths: OWN_AND_TAUT_PATHS,
        settings: &[Samples, Nearest, Seed, Path, Margin, Search],
        defaults: Settings::default,
        solve: |request| on_polygons(request, |s, level| {
            Prm { samples: s.samples << level, nearest: s.nearest, seed: s.seed, path: s.path, search: s.search }
        }),
    }
    Wavefront: "Manhattan wavefront on a grid" {
        name: Wavefront::NAME,
        family: Family::Field,
        paths: OWN_AND_TAUT_PATHS,
        settings: &[GridSearch, Ties, Forward, Neighborhood, Space, Path, Cells],
        // A given number of cells prevents cells that are square in joint space.
        defaults: || Settings { cells: Some(CellCounts::square(DEFAULT_CELLS)), ..Settings::default() },
        solve: |request| on_cells(request, |s, _| Wavefront {
            search: s.grid_search,
            ties: s.ties,
            forward: s.forward,
            neighborhood: s.neighborhood,
            path: s.path,
        }),
    }
    Harmonic: "Harmonic potential on a grid" {
        name: Harmonic::NAME,
        family: Family::Field,
        paths: OWN_AND_TAUT_PATHS,
        settings: &[Field, Space, Path, Cells],
        // The path that follows the field is the one of interest.
        defaults: || Settings { path: PathKind::Own, ..Settings::default() },
        solve: |request| match request.options.planner.field().copied() {
            None => on_cells(request, |s, _| Harmonic { path: s.path }),
            Some(field) => on_zoned_cells(request, |s, _| FieldPlanner { path: s.path, ..field }),
        },
    }
    Subdivision: "Subdivision into boxes: a path with free space around it, or a proof of infeasibility" {
        name: "subdivision",
        family: Family::Exact,
        paths: OWN_AND_TAUT_PATHS,
        settings: &[Path],
        defaults: Settings::default,
        solve: subdivision::solve,
    }
    First: "The first certified path found, or a proof of infeasibility: the quickest answer" {
        name: "first",
        family: Family::Exact,
        paths: TAUT_PATHS,
        settings: &[],
        defaults: Settings::default,
        solve: first::solve,
    }
}
