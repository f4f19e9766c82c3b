//! Planners: functions from a space and a query to a run. They do not depend on arms or obstacles.
//!
//! The planners for polygons begin with `geometry::planar`, which converts polygons to vertices and sides. A path may touch
//! obstacles, also along their sides. It does not pass between two that touch in a point, because triangles and cells are
//! neighbours only through portals of positive length. [`PathKind`] selects the planner's own path or a taut one. The
//! `FieldPlanner` of the crate `fields` follows any field on a `cspace::ZonedGrid`, whose cells know the world's preferences.
//!
//! ```
//! use cplan_planners::cspace::regions;
//! use cplan_model::{Arm, Obstacle, Scene, Workspace};
//! use cplan_planners::planner::{Planner, Proposal, Query, Visibility};
//! use cplan_model::space::Configuration;
//!
//! let workspace = Workspace::new([Obstacle::circle("post", [1.5, 0.0], 0.1)?]);
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, workspace)?;
//! let (start, goal) = (Configuration::new(-0.6, 0.2), Configuration::new(0.6, 0.2));
//! // Create polygons a millimetre larger than the C-obstacles, over one turn to either side of the start.
//! let space = regions(&scene, 1e-3, start, 1);
//! let planner = Visibility::default();
//! let map = planner.build(&space);
//! let run = planner.query(&space, &map, &Query { start, goals: goal.into() });
//! let Proposal::Found(path) = run.outcome else { panic!("there is a way") };
//! assert!(path.waypoints().len() > 2 && path.length() > 1.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod attach;
pub mod channel;
pub mod decomposition;
mod field_values;
pub mod grid_path;
pub mod mesh;
mod path_kind;
pub mod shortcut;
mod polyanya;
pub mod roadmap;
pub mod terminals;
mod trapezoid;
mod visibility;
mod wavefront;

pub use field_values::{FieldQuantity, FieldValues};
pub use path_kind::PathKind;
pub use roadmap::{RoadmapSearch, SearchOrder};
pub use trapezoid::{Trapezoid, TrapezoidMap};
pub use visibility::{Visibility, VisibilityGraph, VisibilityMap};
pub use wavefront::{GridSearch, Wavefront};

use crate::waves::search::Estimates;
use cplan_geometry::planar::NO_ENTRY;
use cplan_model::space::{Configuration, GoalSet, Path};
use cplan_text::counted;
use std::sync::Arc;

/// A query to a planner. Configurations are unwrapped values within the space (see [`crate::cspace`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Query {
    /// First configuration of the path.
    pub start: Configuration,
    /// Alternative goals. On a circle, their copies are goals, too.
    pub goals: GoalSet,
}

/// The outcome of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Proposal {
    /// A path in free space. It starts exactly at the start and ends exactly at a goal or a copy of one.
    Found(Path),
    /// Free space has no path. [`crate::cspace::Proves`] states whether this proves that there is none.
    NoPath,
    /// The planner cannot answer. The text is the reason.
    GaveUp(String),
}

/// Size of the structure in which a planner searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// The visited part of a roadmap, or all cells and portals of a decomposition.
    Graph {
        /// Number of nodes, or of cells.
        nodes: usize,
        /// Number of edges, or of portals.
        edges: usize,
    },
    /// A field on a grid, solved in groups of cells called windows.
    Windows {
        /// Number of free cells that were visited.
        cells: usize,
        /// Number of windows.
        windows: usize,
    },
    /// A field on a grid.
    Grid {
        /// Number of free cells that were visited.
        cells: usize,
        /// Number of passes over these cells, or of levels for a wavefront.
        sweeps: usize,
    },
    /// Values of joint 1 at which the free values of joint 2 were computed exactly.
    Slices {
        /// Number of such values.
        slices: usize,
    },
    /// Cells of a grid that a search reached.
    Search {
        /// Number of cells whose neighbours were examined.
        expanded: usize,
        /// Number of cells that were reached.
        labeled: usize,
    },
    /// A search of a grid in rounds, with a limit of moves that increases from round to round.
    Deepening {
        /// Number of rounds.
        rounds: usize,
        /// Number of expansions of cells, in all rounds together.
        expansions: usize,
        /// Number of cells that were reached.
        labeled: usize,
    },
    /// The planner built no structure.
    Nothing,
}

impl Size {
    /// Returns the sizes, with the names that they have in results.
    pub fn figures(self) -> Vec<(&'static str, usize)> {
        match self {
            Size::Graph { nodes, edges } => vec![("nodes", nodes), ("edges", edges)],
            Size::Windows { cells, windows } => vec![("cells", cells), ("windows", windows)],
            Size::Grid { cells, sweeps } => vec![("cells", cells), ("sweeps", sweeps)],
            Size::Slices { slices } => vec![("rows", slices)],
            Size::Search { expanded, labeled } => vec![("cells", labeled), ("expanded", expanded)],
            Size::Deepening { rounds, expansions, labeled } => {
                vec![("cells", labeled), ("expanded", expansions), ("rounds", rounds)]
            }
            Size::Nothing => Vec::new(),
        }
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Size::Graph { nodes, edges } => write!(f, "{}, {}", counted(nodes, "node"), counted(edges, "edge")),
            Size::Windows { cells, windows } => {
                write!(f, "{}, {}", counted(cells, "cell"), counted(windows, "window"))
            }
            Size::Grid { cells, sweeps } => write!(f, "{}, {}", counted(cells, "cell"), counted(sweeps, "sweep")),
            Size::Slices { slices } => write!(f, "{}", counted(slices, "slice")),
            Size::Search { expanded, labeled } => {
                write!(f, "{} expanded of {labeled} labelled", counted(expanded, "cell"))
            }
            Size::Deepening { rounds, expansions, labeled } => {
                write!(
                    f,
                    "{}, {} of {}",
                    counted(rounds, "round"),
                    counted(expansions, "expansion"),
                    counted(labeled, "cell")
                )
            }
            Size::Nothing => f.write_str("no space built"),
        }
    }
}

/// Points of a channel that the planner's paths pass through.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChannelPoints {
    /// Centroids of the channel's cells, in order (`C1`, `C2`, ...).
    pub centers: Vec<Configuration>,
    /// Middles of the portals between the cells (`Q1`, `Q2`, ...).
    pub middles: Vec<Configuration>,
}

/// The kind of a graph of straight motions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GraphKind {
    /// A visibility graph.
    Visibility(VisibilityGraph),
    /// A roadmap of random configurations, joined to their neighbours.
    Samples,
    /// Any other roadmap.
    Roadmap,
}

impl GraphKind {
    /// Returns the kind of visibility graph; `None` for other graphs.
    pub fn visibility(self) -> Option<VisibilityGraph> {
        if let Self::Visibility(graph) = self { Some(graph) } else { None }
    }
}

/// Shape of the cells of a decomposition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// Trapezoids, made by a line that sweeps over free space.
    Trapezoids,
    /// Triangles.
    Triangles,
}

/// A record of the planner's search, for pictures.
#[derive(Debug, Clone, PartialEq)]
pub enum Trace {
    /// Edges of the reduced visibility graph.
    Roadmap {
        /// Both ends of each edge.
        edges: Vec<[Configuration; 2]>,
        /// True if all edges between corners are included. False if only those that the search examined are.
        whole: bool,
    },
    /// The free intervals of the slices on the path, in order.
    Slices {
        /// Both ends of each interval: the configurations with the least and the greatest value of joint 2.
        free: Vec<[Configuration; 2]>,
    },
    /// The cells of a decomposition, and those in the channel.
    Channel {
        /// Shape of the cells.
        kind: CellKind,
        /// Corners of each cell, counter-clockwise. Shared with the planner's map.
        cells: Arc<[Vec<Configuration>]>,
        /// Indices of the cells in the channel, in order.
        channel: Vec<usize>,
        /// Points of paths through the middle of the channel. Empty if the planner has none.
        points: ChannelPoints,
        /// Configurations that the search expanded, in order. Empty if pictures do not show them.
        expanded: Vec<Configuration>,
    },
    /// A graph of straight motions.
    Roads {
        /// Both ends of each motion.
        edges: Vec<[Configuration; 2]>,
        /// Configurations that the search expanded, in order.
        expanded: Vec<Configuration>,
        /// The kind of graph.
        kind: GraphKind,
    },
    /// Boxes of a subdivision, by their lower and upper corners.
    Boxes {
        /// Boxes of free configurations only.
        free: Vec<[Configuration; 2]>,
        /// Boxes of colliding configurations only.
        stuck: Vec<[Configuration; 2]>,
        /// Boxes that are proven neither free nor colliding.
        mixed: Vec<[Configuration; 2]>,
    },
    /// One label per cell of a grid: the number of steps to the goal, or from the start for a forward search. Cells
    /// that were not reached have the label `u32::MAX`.
    Wavefront {
        /// Number of cells along each axis.
        cells: [usize; 2],
        /// One value per cell.
        labels: Vec<u32>,
        /// Cells in the order in which the search expanded them. Empty for the wave, which labels whole levels at once.
        expanded: Vec<u32>,
        /// True if the search began at the start.
        forward: bool,
        /// The estimates of the search. `None` for a search without estimates.
        estimates: Option<Estimates>,
    },
    /// A field on a grid that a path follows.
    Field {
        /// Number of cells along each axis.
        cells: [usize; 2],
        /// Meaning of the values.
        quantity: FieldQuantity,
        /// One value per cell. Infinite in cells without a potential.
        values: FieldValues,
    },
}

impl Trace {
    /// Returns the trace of a field.
    pub fn field(cells: [usize; 2], quantity: FieldQuantity, values: impl Into<FieldValues>) -> Self {
        Self::Field { cells, quantity, values: values.into() }
    }
}

/// A remark of a planner about a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Note {
    /// The relaxation of the field reached the limit of sweeps before its tolerance. The planner then follows no path.
    Unconverged {
        /// Number of passes over all cells.
        sweeps: usize,
        /// The measured change in the last pass.
        change: f64,
    },
    /// The path left local minima of the potential by moves against the forces.
    Escaped {
        /// The kind of these moves, in words that follow "escaped from a local minimum".
        how: &'static str,
        /// Number of local minima.
        minima: usize,
        /// Number of moves that left local minima.
        moves: usize,
    },
    /// The relaxation met its tolerance, but the values around the path were too small for a reliable path. So it
    /// continued to a relative tolerance.
    Continued {
        /// Number of passes over all cells until the tolerance was met.
        first: usize,
        /// Number of passes after that.
        more: usize,
    },
    /// The relaxation on a GPU reached the limits of single precision before its tolerance.
    Floor {
        /// Number of passes over all cells until only rounding changed values.
        sweeps: usize,
        /// Greatest relative change of a value in the last pass.
        change: f64,
    },
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unconverged { sweeps, change } => {
                write!(f, "not converged: relaxation stopped after {sweeps} sweeps, at a change of {change:.1e}")
            }
            Self::Continued { first, more } => {
                write!(
                    f,
                    "the tolerance was met after {first} sweeps; {more} more sweeps followed until the relative change was small, because values near the path are small"
                )
            }
            Self::Escaped { how, minima, moves } => {
                let minima = if *minima == 1 { "a local minimum".to_owned() } else { format!("{minima} local minima") };
                write!(f, "escaped from {minima} {how}, by {} that the forces do not cause", counted(*moves, "move"))
            }
            Self::Floor { sweeps, change } => {
                write!(
                    f,
                    "stopped after {sweeps} sweeps, at a change of {change:.1e}: single precision allows no more progress"
                )
            }
        }
    }
}

/// A planner's answer to a query.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The outcome.
    pub outcome: Proposal,
    /// A record of the search, for pictures.
    pub trace: Trace,
    /// Size of the structure that was searched.
    pub size: Size,
    /// A remark about the outcome; `None` if there is none.
    pub note: Option<Note>,
}

impl Run {
    /// Returns a run without a remark.
    pub fn new(outcome: Proposal, trace: Trace, size: Size) -> Self {
        Self { outcome, trace, size, note: None }
    }
}

/// A planner. Its settings are the fields of the implementing type.
///
/// Structures that do not depend on the query are built once and can serve many queries. Planners are deterministic:
/// the same input gives the same output.
pub trait Planner {
    /// Name on the command line.
    const NAME: &'static str;
    /// The representation of free space that the planner needs, such as polygons or a grid.
    type Space;
    /// The structure that the planner builds from a space.
    type Map;

    /// Builds the planner's structure for a space.
    fn build(&self, space: &Self::Space) -> Self::Map;

    /// Answers one query.
    fn query(&self, space: &Self::Space, map: &Self::Map, query: &Query) -> Run;
}
