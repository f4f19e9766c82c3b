//! Planners: pure functions from a space and a query to a run. They know nothing of arms or obstacles.
//!
//! Both roadmap planners begin with `geometry::planar`, which takes polygons apart into vertices and sides. A path may
//! touch obstacles, along sides too, but not squeeze between two that touch in a point: triangles and cells are
//! neighbours only through pieces of positive length. [`PathKind`] selects the planner's own path or a taut one. The
//! `FieldPlanner` of the crate `fields` follows any field on a `cspace::ZonedGrid`, whose cells know the world's
//! preferences.
//!
//! ```
//! use cplan_core::cspace::regions;
//! use cplan_core::model::{Arm, Obstacle, Scene, Workspace};
//! use cplan_core::planner::{Planner, Proposal, Query, Visibility};
//! use cplan_core::space::Configuration;
//!
//! let workspace = Workspace::new([Obstacle::circle("post", [1.5, 0.0], 0.1)?]);
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, workspace)?;
//! let (start, goal) = (Configuration::new(-0.6, 0.2), Configuration::new(0.6, 0.2));
//! // Polygons a millimetre larger than the C-obstacles, over one turn to either side of the start.
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
pub mod grid_path;
mod harmonic;
pub mod mesh;
mod path_kind;
pub mod shortcut;
pub mod simplify;
mod polyanya;
pub mod roadmap;
pub mod terminals;
mod trapezoid;
mod visibility;
mod wavefront;

pub use harmonic::Harmonic;
pub use path_kind::PathKind;
pub use roadmap::{RoadmapSearch, SearchOrder};
pub use trapezoid::{Trapezoid, TrapezoidMap};
pub use visibility::{Visibility, VisibilityGraph, VisibilityMap};
pub use wavefront::{GridSearch, Wavefront};

use crate::space::{Configuration, GoalSet, Path};
use cplan_geometry::planar::NO_ENTRY;
use cplan_harmonic::{Component, Potential, estimated_harmonic};
use cplan_text::counted;
use std::borrow::Cow;
use std::sync::Arc;

/// A query to a planner. Configurations are unwrapped values within the space (see [`crate::cspace`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Query {
    /// First configuration of the path.
    pub start: Configuration,
    /// Alternative goals; on a circle axis also their copies.
    pub goals: GoalSet,
}

/// The outcome of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Proposal {
    /// A path in the free space of the representation, starting at the start exactly and ending at a goal (or a copy of
    /// it) exactly.
    Found(Path),
    /// The representation holds no path. [`crate::cspace::Proves`] tells what that proves.
    NoPath,
    /// Unknown: the reason, in words.
    GaveUp(String),
}

/// Size of the structure that a planner built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// The visited part of a roadmap, or all cells and their adjacencies.
    Graph {
        /// Nodes, or cells.
        nodes: usize,
        /// Arcs, or adjacencies.
        edges: usize,
    },
    /// A field on a grid, solved piece by piece.
    Windows {
        /// Free cells that were visited.
        cells: usize,
        /// Sets of cells whose equations were solved together.
        windows: usize,
    },
    /// A field on a grid.
    Grid {
        /// Free cells that were visited.
        cells: usize,
        /// Passes over them (levels of a wavefront).
        sweeps: usize,
    },
    /// Values of joint 1 at which free values of joint 2 are known exactly.
    Slices {
        /// Number of such values.
        slices: usize,
    },
    /// Cells of a grid that a search reached.
    Search {
        /// Cells whose neighbours were examined.
        expanded: usize,
        /// Cells that were reached.
        labeled: usize,
    },
    /// Cells of a grid reached by a search that restarts, round by round.
    Deepening {
        /// Number of rounds.
        rounds: usize,
        /// Number of times that a cell was expanded, in all rounds together.
        expansions: usize,
        /// Cells that were reached.
        labeled: usize,
    },
    /// Nothing was built.
    Nothing,
}

impl Size {
    /// Returns the numbers, by name.
    #[must_use]
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

/// Points of a channel through which paths may lead.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChannelPoints {
    /// Centres of area of its cells, in order (`C1`, `C2`, ...).
    pub centers: Vec<Configuration>,
    /// Middles of the portals between them, one less (`Q1`, `Q2`, ...).
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
    /// Returns the kind of visibility graph, if it is one.
    #[must_use]
    pub fn visibility(self) -> Option<VisibilityGraph> {
        if let Self::Visibility(graph) = self { Some(graph) } else { None }
    }
}

/// Shape of the cells of a decomposition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// Trapezoids from a line that sweeps over free space.
    Trapezoids,
    /// Triangles.
    Triangles,
}

/// A record of the planner's search, for pictures.
#[derive(Debug, Clone, PartialEq)]
pub enum Trace {
    /// Arcs of the reduced visibility graph.
    Roadmap {
        /// Both ends of each arc.
        edges: Vec<[Configuration; 2]>,
        /// True if the arcs include all arcs between corners; otherwise they are those that the search examined.
        whole: bool,
    },
    /// Free stretches of slices on the path, one after the other: both ends of each.
    Slices {
        /// The least and the greatest value of joint 2 of each stretch.
        free: Vec<[Configuration; 2]>,
    },
    /// Cells of the decomposition (corners, counter-clockwise) and the indices of those in the channel, in order.
    Channel {
        /// Shape of the cells.
        kind: CellKind,
        /// Corners of each cell; shared with the planner's map.
        cells: Arc<[Vec<Configuration>]>,
        /// Indices of the channel's cells.
        channel: Vec<usize>,
        /// Points on paths through the middle of the channel; empty if they have no fixed place.
        points: ChannelPoints,
        /// Configurations that the search expanded, in order, if they are to be shown.
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
    /// Boxes of a subdivision: lower and upper corner of each.
    Boxes {
        /// Boxes without any collision.
        free: Vec<[Configuration; 2]>,
        /// Boxes with collisions only.
        stuck: Vec<[Configuration; 2]>,
        /// Boxes that are neither proven free nor proven stuck.
        mixed: Vec<[Configuration; 2]>,
    },
    /// Steps to the goal for every cell of the grid, or steps from the start for a forward search; `u32::MAX` for cells
    /// that were not reached.
    Wavefront {
        /// Shape of the grid.
        cells: [usize; 2],
        /// One value per cell.
        labels: Vec<u32>,
        /// Cells in the order in which a search expanded them; empty for the wave, which reaches all cells of a label
        /// at once.
        expanded: Vec<u32>,
        /// True if the search began at the start.
        forward: bool,
    },
    /// Natural logarithm of the potential for every cell (0 at the goal, lower farther away), minus infinity where
    /// there is no potential.
    Field {
        /// Shape of the grid.
        cells: [usize; 2],
        /// One value per cell.
        potential: Vec<f64>,
    },
    /// The harmonic potential of the cells from which the goal can be reached. Its logarithms are for pictures alone,
    /// and are computed when a picture needs them ([`Trace::logarithms`]).
    Harmonic {
        /// The cells that the field covers.
        component: Component,
        /// `None` if the start is in none of these cells.
        potential: Option<Potential>,
    },
    /// A potential that paths descend, for every cell; infinite where there is no potential.
    Potential {
        /// Shape of the grid.
        cells: [usize; 2],
        /// One value per cell.
        heights: Vec<f64>,
    },
}

impl Trace {
    /// Returns the shape of the grid and the natural logarithm of the potential for every cell, for a field that paths
    /// ascend. The logarithm is minus infinity where there is no potential. Linear in the number of cells.
    #[must_use]
    pub fn logarithms(&self) -> Option<([usize; 2], Cow<'_, [f64]>)> {
        match self {
            Self::Field { cells, potential } => Some((*cells, Cow::Borrowed(potential))),
            Self::Harmonic { component, potential } => {
                let guess = || Cow::Owned(estimated_harmonic(component));
                let potential = potential.as_ref().map_or_else(guess, Cow::Borrowed);
                let mut ln = vec![f64::NEG_INFINITY; component.shape[0] * component.shape[1]];
                (0..component.len()).for_each(|at| ln[component.cell(at)] = potential.ln(at));
                Some((component.shape, Cow::Owned(ln)))
            }
            _ => None,
        }
    }
}

/// A remark of a planner about a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Note {
    /// The field was not relaxed to the required tolerance. No path is followed in it.
    Unconverged {
        /// Passes over all cells, until the limit.
        sweeps: usize,
        /// The measure in the last sweep.
        change: f64,
    },
    /// The path left local minima, which the forces alone do not leave.
    Escaped {
        /// The method, in words.
        how: &'static str,
        /// Number of local minima.
        minima: usize,
        /// Number of moves that led out of them.
        moves: usize,
    },
    /// The field was relaxed to the tolerance of its measure, but its values around the path were too small for that
    /// measure. Then it was relaxed to a relative tolerance.
    Continued {
        /// Passes over all cells until the measure was met.
        first: usize,
        /// Passes after that.
        more: usize,
    },
    /// The relaxation stopped before the tolerance, at the limit of a GPU's precision.
    Floor {
        /// Passes over all cells, until only rounding changed.
        sweeps: usize,
        /// Greatest relative change of a value in the last sweep.
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
                    "the measure was met after {first} sweeps; {more} more, by relative change, for the small values about the \
                     path"
                )
            }
            Self::Escaped { how, minima, moves } => {
                let minima = if *minima == 1 { "a local minimum".to_owned() } else { format!("{minima} local minima") };
                write!(f, "escaped from {minima} {how}: {} that the forces do not make", counted(*moves, "move"))
            }
            Self::Floor { sweeps, change } => {
                write!(f, "after {sweeps} sweeps single precision goes no further, at a change of {change:.1e}")
            }
        }
    }
}

/// A planner's answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The outcome.
    pub outcome: Proposal,
    /// The trace, for pictures.
    pub trace: Trace,
    /// Size of the structure that was built.
    pub size: Size,
    /// A remark about the outcome, if any.
    pub note: Option<Note>,
}

/// A planner: settings are the fields of the implementing type.
///
/// Structures that do not depend on the query are built once and can serve many queries. Deterministic: same input,
/// same output.
pub trait Planner {
    /// Name on the command line.
    const NAME: &'static str;
    /// The representation that it works on. The type states, for example, that visibility needs polygons.
    type Space;
    /// The structure that it prepares.
    type Map;

    /// Prepares a space for queries.
    fn build(&self, space: &Self::Space) -> Self::Map;

    /// Answers one query.
    fn query(&self, space: &Self::Space, map: &Self::Map, query: &Query) -> Run;
}
