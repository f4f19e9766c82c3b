//! A planner with options of its own.

use super::{CellCounts, GridSpace, Method};
use cplan_core::model::Arm;
use cplan_core::planner::{GridSearch, PathKind, RoadmapSearch, VisibilityGraph, Wavefront};
use cplan_core::space::Metric;
use cplan_core::waves::Neighborhood;
use cplan_core::waves::search::Ties;
use cplan_fields::FieldPlanner;
use cplan_roadmaps::Prm;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// What makes a path short.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// Square root of the sum of squares, radians and metres as they come.
    #[default]
    Euclidean,
    /// The same with the joints' values multiplied by these weights, both positive.
    Weighted([f64; 2]),
    /// Seconds at the joints' top speeds.
    Time,
}

impl Criterion {
    /// The metric for an arm.
    #[must_use]
    pub fn metric(self, arm: &Arm) -> Metric {
        match self {
            Criterion::Euclidean => Metric::Euclidean,
            Criterion::Weighted(weights) => Metric::Weighted { weights },
            Criterion::Time => Metric::Time { speeds: arm.joints.each_ref().map(|joint| joint.velocity) },
        }
    }
}

/// A planner with what it can be told. [`Planner::named`] has the defaults.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Planner {
    /// The shortest path, from exact slices, with a proven bound on the optimum.
    Shortest {
        /// What makes a path short.
        criterion: Criterion,
        /// Refine until the path is proven to be longer than the optimum by no more than this share of it; none for 1e-4. A
        /// larger one leaves room in which motions are faster.
        gap: Option<f64>,
        /// As of [`Planner::Visibility`], whose graph has its turn where slices do not tell.
        margin: f64,
    },
    /// The first certified path that is found.
    First,
    /// Visibility graph and A*: the shortest path, with a proven bound on the optimum.
    Visibility {
        /// What makes a path short.
        criterion: Criterion,
        /// As of [`Planner::Shortest`]; none for what the first margin gives.
        gap: Option<f64>,
        /// First margin by which polygonal obstacles are grown, as a share of the arm's reach; quartered where needed. 0 for the
        /// exact polygons of a gantry, which have the first attempt; paths that touch them are sought among grown ones.
        margin: f64,
        /// How the graph is searched.
        #[serde(default)]
        search: RoadmapSearch,
        /// Which arcs the graph has.
        #[serde(default)]
        graph: VisibilityGraph,
    },
    /// Trapezoidal decomposition: a channel of cells.
    Trapezoid {
        /// Which path through the channel.
        path: PathKind,
        /// As of [`Planner::Visibility`].
        margin: f64,
        /// How the adjacency of cells is searched.
        #[serde(default)]
        search: RoadmapSearch,
    },
    /// Triangular decomposition: a channel of triangles.
    Triangles {
        /// Which path through the channel.
        path: PathKind,
        /// As of [`Planner::Visibility`].
        margin: f64,
        /// How the roadmap is searched.
        search: RoadmapSearch,
    },
    /// Voronoi diagram of the obstacles: the way whose least distance from them is the greatest.
    Voronoi {
        /// Which path: along the diagram, or that one pulled taut.
        path: PathKind,
        /// As of [`Planner::Visibility`].
        margin: f64,
        /// How the ways of greatest width are searched.
        search: RoadmapSearch,
    },
    /// Probabilistic roadmap: random configurations, each joined to the nearest that it sees.
    Prm {
        /// How many, twice as many where needed.
        samples: usize,
        /// To how many of the nearest each is joined.
        nearest: usize,
        /// What they follow from.
        seed: u64,
        /// Which path.
        path: PathKind,
        /// As of [`Planner::Visibility`].
        margin: f64,
        /// How the roadmap is searched.
        search: RoadmapSearch,
    },
    /// Manhattan wavefront, or another search of a grid.
    Wavefront {
        /// How the grid is searched.
        search: GridSearch,
        /// Which of equally promising cells A\* expands.
        #[serde(default, skip_serializing_if = "Ties::is_usual")]
        ties: Ties,
        /// Whether the search begins at the start, not at the goals.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        forward: bool,
        /// Where a move can lead.
        neighborhood: Neighborhood,
        /// How cells are decided.
        space: GridSpace,
        /// Which path through the cells.
        path: PathKind,
        /// First numbers of cells along the axes; doubled where needed.
        cells: CellCounts,
    },
    /// Harmonic potential on a grid, or another field.
    Harmonic {
        /// The field in place of the harmonic one; its path is the one that stands beside it here.
        field: Option<FieldPlanner>,
        /// How cells are decided.
        space: GridSpace,
        /// Which path: the curve along the gradient, or that one pulled taut.
        path: PathKind,
        /// First numbers of cells along the axes; none for 256 x 256 cells' worth of cells that are square in joint space.
        cells: Option<CellCounts>,
    },
    /// Subdivision into free, stuck and mixed boxes.
    Subdivision {
        /// Which path through the free boxes.
        path: PathKind,
    },
}

/// Shares of the arm's reach that a margin can be: 0, or more, at most this.
pub const MOST_MARGIN: f64 = 0.1;

/// The first margin.
const MARGIN: f64 = 1e-3;

/// The first number of cells along an axis, if none is asked for.
pub const FIRST_CELLS: usize = 256;

/// Numbers of cells along an axis to begin with.
pub const CELLS: RangeInclusive<usize> = 8..=2048;

/// Numbers of samples to begin with.
pub const SAMPLES: RangeInclusive<usize> = 1..=100_000;

/// Numbers of samples to which each is joined.
pub const NEAREST: RangeInclusive<usize> = 1..=1000;

impl Planner {
    /// The planner of that name, as it is if nothing else is said.
    #[must_use]
    pub fn named(method: Method) -> Self {
        let (criterion, gap, margin) = (Criterion::Euclidean, None, MARGIN);
        let (path, space, search) = (method.path_kind(), GridSpace::default(), RoadmapSearch::default());
        match method {
            Method::Shortest => Planner::Shortest { criterion, gap, margin },
            Method::First => Planner::First,
            Method::Visibility => {
                Planner::Visibility { criterion, gap, margin, search, graph: VisibilityGraph::default() }
            }
            Method::Trapezoid => Planner::Trapezoid { path, margin, search },
            Method::Triangles => Planner::Triangles { path, margin, search },
            Method::Voronoi => Planner::Voronoi { path, margin, search },
            Method::Prm => {
                let Prm { samples, nearest, seed, .. } = Prm::default();
                Planner::Prm { samples, nearest, seed, path, margin, search }
            }
            Method::Wavefront => {
                let Wavefront { search, ties, forward, neighborhood, .. } = Wavefront::default();
                let cells = CellCounts::square(FIRST_CELLS);
                Planner::Wavefront { search, ties, forward, neighborhood, space, path, cells }
            }
            Method::Harmonic => Planner::Harmonic { field: None, space, path, cells: None },
            Method::Subdivision => Planner::Subdivision { path },
        }
    }

    /// Which planner it is.
    #[must_use]
    pub fn method(&self) -> Method {
        match self {
            Planner::Shortest { .. } => Method::Shortest,
            Planner::First => Method::First,
            Planner::Visibility { .. } => Method::Visibility,
            Planner::Trapezoid { .. } => Method::Trapezoid,
            Planner::Triangles { .. } => Method::Triangles,
            Planner::Voronoi { .. } => Method::Voronoi,
            Planner::Prm { .. } => Method::Prm,
            Planner::Wavefront { .. } => Method::Wavefront,
            Planner::Harmonic { .. } => Method::Harmonic,
            Planner::Subdivision { .. } => Method::Subdivision,
        }
    }

    /// Which of its paths it gives.
    #[must_use]
    pub fn path_kind(&self) -> PathKind {
        match *self {
            Planner::Trapezoid { path, .. }
            | Planner::Triangles { path, .. }
            | Planner::Voronoi { path, .. }
            | Planner::Prm { path, .. }
            | Planner::Wavefront { path, .. }
            | Planner::Harmonic { path, .. }
            | Planner::Subdivision { path } => path,
            Planner::Shortest { .. } | Planner::First | Planner::Visibility { .. } => PathKind::Taut,
        }
    }

    /// The same planner, giving the other path, if it has two.
    #[must_use]
    pub fn with_path(mut self, kind: PathKind) -> Self {
        if let Planner::Trapezoid { path, .. }
        | Planner::Triangles { path, .. }
        | Planner::Voronoi { path, .. }
        | Planner::Prm { path, .. }
        | Planner::Wavefront { path, .. }
        | Planner::Harmonic { path, .. }
        | Planner::Subdivision { path } = &mut self
        {
            *path = kind;
        }
        self
    }

    /// The same planner, for which this makes a path short, if it optimises.
    #[must_use]
    pub fn with_criterion(mut self, shortest: Criterion) -> Self {
        if let Planner::Shortest { criterion, .. } | Planner::Visibility { criterion, .. } = &mut self {
            *criterion = shortest;
        }
        self
    }

    /// The same planner, asked for this gap, if it optimises.
    #[must_use]
    pub fn with_gap(mut self, share: f64) -> Self {
        if let Planner::Shortest { gap, .. } | Planner::Visibility { gap, .. } = &mut self {
            *gap = Some(share);
        }
        self
    }

    /// The same planner with this first margin, if it has one.
    #[must_use]
    pub fn with_margin(mut self, share: f64) -> Self {
        if let Planner::Shortest { margin, .. }
        | Planner::Visibility { margin, .. }
        | Planner::Trapezoid { margin, .. }
        | Planner::Triangles { margin, .. }
        | Planner::Voronoi { margin, .. }
        | Planner::Prm { margin, .. } = &mut self
        {
            *margin = share;
        }
        self
    }

    /// The same planner with this first number of cells along each axis, if it has cells.
    #[must_use]
    pub fn with_cells(self, n: usize) -> Self {
        self.with_cell_counts(CellCounts::square(n))
    }

    /// The same planner with these first numbers of cells along the axes, if it has cells.
    #[must_use]
    pub fn with_cell_counts(mut self, counts: CellCounts) -> Self {
        match &mut self {
            Planner::Wavefront { cells, .. } => *cells = counts,
            Planner::Harmonic { cells, .. } => *cells = Some(counts),
            _ => {}
        }
        self
    }

    /// The same planner that searches its roadmap like this, if it has one.
    #[must_use]
    pub fn with_search(mut self, how: RoadmapSearch) -> Self {
        if let Planner::Visibility { search, .. }
        | Planner::Trapezoid { search, .. }
        | Planner::Triangles { search, .. }
        | Planner::Voronoi { search, .. }
        | Planner::Prm { search, .. } = &mut self
        {
            *search = how;
        }
        self
    }

    /// The same planner with cells decided like this, if it has cells.
    #[must_use]
    pub fn with_space(mut self, by: GridSpace) -> Self {
        if let Planner::Wavefront { space, .. } | Planner::Harmonic { space, .. } = &mut self {
            *space = by;
        }
        self
    }

    /// The first margin of its polygons, if it has any.
    pub fn margin(&self) -> f64 {
        match *self {
            Planner::Shortest { margin, .. }
            | Planner::Visibility { margin, .. }
            | Planner::Trapezoid { margin, .. }
            | Planner::Triangles { margin, .. }
            | Planner::Voronoi { margin, .. }
            | Planner::Prm { margin, .. } => margin,
            _ => MARGIN,
        }
    }

    /// Whether the exact polygons of a gantry are asked for: in files and pictures, and for the first attempt.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.margin() == 0.0
    }

    /// The first numbers of cells along the axes, if they are given.
    #[must_use]
    pub fn cells(&self) -> Option<CellCounts> {
        match *self {
            Planner::Wavefront { cells, .. } => Some(cells),
            Planner::Harmonic { cells, .. } => cells,
            _ => None,
        }
    }

    /// Which visibility graph it searches, if it does.
    #[must_use]
    pub fn graph(&self) -> Option<VisibilityGraph> {
        if let Planner::Visibility { graph, .. } = *self { Some(graph) } else { None }
    }

    /// How it measures paths of an arm.
    #[must_use]
    pub fn metric(&self, arm: &Arm) -> Metric {
        match *self {
            Planner::Shortest { criterion, .. } | Planner::Visibility { criterion, .. } => criterion.metric(arm),
            _ => Metric::Euclidean,
        }
    }

    /// What it is after: the gap asked for, of planners that optimise.
    #[must_use]
    pub fn gap(&self) -> Option<f64> {
        match *self {
            Planner::Shortest { gap, .. } | Planner::Visibility { gap, .. } => gap,
            _ => None,
        }
    }

    /// How it searches its roadmap, if it has one.
    #[must_use]
    pub fn search(&self) -> Option<RoadmapSearch> {
        match *self {
            Planner::Visibility { search, .. }
            | Planner::Trapezoid { search, .. }
            | Planner::Triangles { search, .. }
            | Planner::Voronoi { search, .. }
            | Planner::Prm { search, .. } => Some(search),
            _ => None,
        }
    }

    /// Whether it looks for the optimum as it is told to search.
    #[must_use]
    pub fn optimises(&self) -> bool {
        self.method().optimises() && self.search().is_none_or(|search| search.order.is_optimal())
    }

    /// How the cells of its grid are decided, if it has one.
    #[must_use]
    pub fn space(&self) -> Option<GridSpace> {
        match *self {
            Planner::Wavefront { space, .. } | Planner::Harmonic { space, .. } => Some(space),
            _ => None,
        }
    }

    /// The field that it follows, if it is not the plain harmonic one.
    #[must_use]
    pub fn field(&self) -> Option<&FieldPlanner> {
        if let Planner::Harmonic { field, .. } = self { field.as_ref() } else { None }
    }
}
