//! The planners. Adding one takes an entry in the table at the end of this file.

use super::ladder::{Request, by_visibility, on_cells, on_polygons, on_zoned_cells};
use super::setting::{FIRST_CELLS, Setting, Settings};
use super::{Answer, CellCounts, first, shortest, subdivision};
use Setting::{
    Cells, Criterion, Field, Forward, Gap, Graph, GridSearch, Margin, Nearest, Neighborhood, Path, Samples, Search,
    Seed, Space, Ties,
};
use cplan_core::planner::{Harmonic, PathKind, Planner, Trapezoid, Visibility, Wavefront};
use cplan_fields::FieldPlanner;
use cplan_roadmaps::{Prm, Triangles, Voronoi};
use std::fmt;
use std::str::FromStr;

/// A planner's own description: all that the rest of the program knows about it.
#[derive(Debug)]
pub struct Descriptor {
    /// Name on the command line.
    pub name: &'static str,
    /// What it does, in a line: for the help.
    pub summary: &'static str,
    /// Planners that work alike.
    pub family: Family,
    /// Paths that it can give.
    pub paths: &'static [PathKind],
    /// Settings that it reads, in the order in which JSON has them. A planner that reads [`Setting::Gap`] looks for the optimum,
    /// and proves how near its path is. One that reads [`Setting::Margin`] plans among polygons, one that reads [`Setting::Search`]
    /// on a roadmap, one that reads [`Setting::Space`] on a grid.
    pub settings: &'static [Setting],
    /// Its settings if none are given.
    pub(super) defaults: fn() -> Settings,
    /// Builds the space that it plans in, level after level, and answers.
    pub(super) solve: fn(Request) -> Answer,
}

/// Planners that work alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// A graph over the polygons of free space.
    Roadmap,
    /// Values on a grid's cells.
    Field,
    /// Planners that judge the scene itself: by exact slices, slabs, boxes.
    Exact,
}

impl Family {
    /// All families, in the order of the tables.
    pub const ALL: [Family; 3] = [Family::Roadmap, Family::Field, Family::Exact];

    /// Its planners, in the plural.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Family::Roadmap => "roadmaps",
            Family::Field => "fields",
            Family::Exact => "exact planners",
        }
    }
}

impl Method {
    /// Returns its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.descriptor().name
    }

    /// Returns whether it reads a setting.
    #[must_use]
    pub fn reads(self, setting: Setting) -> bool {
        self.descriptor().settings.contains(&setting)
    }

    /// Returns the path that it gives if no other is asked for.
    #[must_use]
    pub fn path_kind(self) -> PathKind {
        (self.descriptor().defaults)().path
    }

    /// Returns whether it has a path of its own beside the taut one.
    #[must_use]
    pub fn has_own_path(self) -> bool {
        self.descriptor().paths.contains(&PathKind::Own)
    }

    /// Returns whether it looks for the optimum of a metric, and proves how near its path is to it.
    #[must_use]
    pub fn optimises(self) -> bool {
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

/// Makes [`Method`] of the table: a variant, its line in the help, its descriptor.
macro_rules! planners {
    ($($method:ident: $summary:literal { $($field:ident: $value:expr),+ $(,)? })+) => {
        /// A planner by name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Method {
            $(#[doc = $summary] $method),+
        }

        impl Method {
            /// All, in the order of the help and of tables.
            pub const ALL: [Method; [$(Method::$method),+].len()] = [$(Method::$method),+];

            /// Returns what it says of itself.
            #[must_use]
            pub fn descriptor(self) -> &'static Descriptor {
                match self {
                    $(Method::$method => const { &Descriptor { summary: $summary, $($field: $value),+ } }),+
                }
            }
        }
    };
}

const TAUT: &[PathKind] = &[PathKind::Taut];
const OWN_AND_TAUT: &[PathKind] = &[PathKind::Own, PathKind::Taut];

// The default, roadmap planners, field planners, those that judge the scene itself.
planners! {
    Shortest: "The shortest path, from exact slices, with a proven bound on the optimum; or a proof that there is none" {
        name: "shortest",
        family: Family::Exact,
        paths: TAUT,
        settings: &[Criterion, Gap, Margin],
        defaults: Settings::default,
        solve: shortest::solve,
    }
    Visibility: "Visibility graph: the shortest path, with a proven bound on the optimum" {
        name: Visibility::NAME,
        family: Family::Roadmap,
        paths: TAUT,
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
    Triangles: "Triangles of free space: a channel of them, and the funnel path through it" {
        name: Triangles::NAME,
        family: Family::Roadmap,
        paths: OWN_AND_TAUT,
        settings: &[Path, Margin, Search],
        defaults: Settings::default,
        solve: |request| on_polygons(request, |s, _| Triangles { path: s.path, search: s.search }),
    }
    Voronoi: "Voronoi diagram: the way whose least distance from obstacles, in joint space, is the greatest" {
        name: Voronoi::NAME,
        family: Family::Roadmap,
        paths: OWN_AND_TAUT,
        settings: &[Path, Margin, Search],
        // Far from obstacles, which a taut path is not.
        defaults: || Settings { path: PathKind::Own, ..Settings::default() },
        solve: |request| on_polygons(request, |s, _| Voronoi { path: s.path, search: s.search }),
    }
    Prm: "Probabilistic roadmap: random configurations, each joined to the nearest that it sees" {
        name: Prm::NAME,
        family: Family::Roadmap,
        paths: OWN_AND_TAUT,
        settings: &[Samples, Nearest, Seed, Path, Margin, Search],
        defaults: Settings::default,
        solve: |request| on_polygons(request, |s, level| {
            Prm { samples: s.samples << level, nearest: s.nearest, seed: s.seed, path: s.path, search: s.search }
        }),
    }
    Wavefront: "Manhattan wavefront on a grid" {
        name: Wavefront::NAME,
        family: Family::Field,
        paths: OWN_AND_TAUT,
        settings: &[GridSearch, Ties, Forward, Neighborhood, Space, Path, Cells],
        // Given, so that cells are not made square in joint space.
        defaults: || Settings { cells: Some(CellCounts::square(FIRST_CELLS)), ..Settings::default() },
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
        paths: OWN_AND_TAUT,
        settings: &[Field, Space, Path, Cells],
        // Fields are for being followed.
        defaults: || Settings { path: PathKind::Own, ..Settings::default() },
        solve: |request| match request.options.planner.field().copied() {
            None => on_cells(request, |s, _| Harmonic { path: s.path }),
            Some(field) => on_zoned_cells(request, |s, _| FieldPlanner { path: s.path, ..field }),
        },
    }
    Subdivision: "Subdivision into boxes: a path with room around it, or a proof that there is none" {
        name: "subdivision",
        family: Family::Exact,
        paths: OWN_AND_TAUT,
        settings: &[Path],
        defaults: Settings::default,
        solve: subdivision::solve,
    }
    First: "The first certified path that is found, or a proof that there is none: the quickest answer" {
        name: "first",
        family: Family::Exact,
        paths: TAUT,
        settings: &[],
        defaults: Settings::default,
        solve: first::solve,
    }
}
