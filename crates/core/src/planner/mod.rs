//! Planners: pure functions from a space and a query to a run. They know nothing of arms or obstacles.
//!
//! Both roadmap planners begin with `geometry::planar`, which takes polygons apart into vertices and sides. A path may
//! touch obstacles, along sides too, but not squeeze between two that touch in a point: triangles and cells are
//! neighbours through pieces of positive length only. Which of two paths a planner gives, its own or that one pulled
//! taut, [`PathKind`] says. The `FieldPlanner` of the crate `fields` follows any field on a `cspace::ZonedGrid`, whose cells know the world's
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
use cplan_geometry::planar::NONE;
use cplan_harmonic::{Component, Potential, rough_harmonic};
use cplan_text::counted;
use std::borrow::Cow;
use std::sync::Arc;

/// What is asked of a planner. Configurations are unwrapped values within the space (see [`crate::cspace`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Query {
    /// Where the path begins.
    pub start: Configuration,
    /// Any of these will do; on a circle axis their copies too.
    pub goals: GoalSet,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Proposal {
    /// A path in the free space of the representation, starting at the start exactly and ending at a goal (or a copy of
    /// it) exactly.
    Found(Path),
    /// The representation holds no path. Whether that proves anything depends on [`crate::cspace::Proves`].
    NoPath,
    /// Neither: the reason, in words.
    GaveUp(String),
}

/// Size of what a planner built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// A roadmap as far as it was looked at, or all cells and their adjacencies.
    Graph {
        /// Nodes, or cells.
        nodes: usize,
        /// Arcs, or adjacencies.
        edges: usize,
    },
    /// A field on a grid, solved piece by piece.
    Windows {
        /// Free cells that were looked at.
        cells: usize,
        /// Sets of cells whose equations were solved together.
        windows: usize,
    },
    /// A field on a grid.
    Grid {
        /// Free cells that were looked at.
        cells: usize,
        /// Passes over them (levels of a wavefront).
        sweeps: usize,
    },
    /// Values of joint 1 at which free values of joint 2 are known exactly.
    Slices {
        /// How many such values there are.
        slices: usize,
    },
    /// Cells of a grid as far as a search came.
    Search {
        /// Those whose neighbours were looked at.
        expanded: usize,
        /// Those that were reached.
        labelled: usize,
    },
    /// Cells of a grid as far as a search came that began anew, round by round.
    Deepening {
        /// How often it began.
        rounds: usize,
        /// How many times a cell was expanded, in all rounds together.
        expansions: usize,
        /// Cells that were reached.
        labelled: usize,
    },
    /// Nothing was built.
    Nothing,
}

impl Size {
    /// Its numbers, by name.
    #[must_use]
    pub fn figures(self) -> Vec<(&'static str, usize)> {
        match self {
            Size::Graph { nodes, edges } => vec![("nodes", nodes), ("edges", edges)],
            Size::Windows { cells, windows } => vec![("cells", cells), ("windows", windows)],
            Size::Grid { cells, sweeps } => vec![("cells", cells), ("sweeps", sweeps)],
            Size::Slices { slices } => vec![("rows", slices)],
            Size::Search { expanded, labelled } => vec![("cells", labelled), ("expanded", expanded)],
            Size::Deepening { rounds, expansions, labelled } => {
                vec![("cells", labelled), ("expanded", expansions), ("rounds", rounds)]
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
            Size::Search { expanded, labelled } => {
                write!(f, "{} expanded of {labelled} labelled", counted(expanded, "cell"))
            }
            Size::Deepening { rounds, expansions, labelled } => {
                write!(
                    f,
                    "{}, {} of {}",
                    counted(rounds, "round"),
                    counted(expansions, "expansion"),
                    counted(labelled, "cell")
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

/// What a graph of straight motions is.
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
    /// Returns which visibility graph it is, if it is one.
    #[must_use]
    pub fn visibility(self) -> Option<VisibilityGraph> {
        if let Self::Visibility(graph) = self { Some(graph) } else { None }
    }
}

/// Shape of the cells of a decomposition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// Trapezoids that a line leaves as it sweeps over free space.
    Trapezoids,
    /// Triangles.
    Triangles,
}

/// What a planner saw on its way, for pictures.
#[derive(Debug, Clone, PartialEq)]
pub enum Trace {
    /// Arcs of the reduced visibility graph.
    Roadmap {
        /// Both ends of each.
        edges: Vec<[Configuration; 2]>,
        /// Whether all arcs between corners are among them; otherwise they are those that the search looked at.
        whole: bool,
    },
    /// Free stretches of slices that the path passes one after the other: both ends of each.
    Slices {
        /// Of each the least and the greatest value of joint 2.
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
        /// Where paths through the middle of the channel lead; empty where there are none of a fixed place.
        points: ChannelPoints,
        /// Where the search came, in order, if that is to be seen.
        expanded: Vec<Configuration>,
    },
    /// A graph of straight motions.
    Roads {
        /// Both ends of each.
        edges: Vec<[Configuration; 2]>,
        /// Where the search came, in order.
        expanded: Vec<Configuration>,
        /// Which graph it is.
        kind: GraphKind,
    },
    /// Boxes of a subdivision: lower and upper corner of each.
    Boxes {
        /// No collision anywhere in them.
        free: Vec<[Configuration; 2]>,
        /// Collision everywhere in them.
        stuck: Vec<[Configuration; 2]>,
        /// Boxes that are neither proven free nor proven stuck.
        mixed: Vec<[Configuration; 2]>,
    },
    /// Steps to the goal for every cell of the grid, of a forward search steps from the start; `u32::MAX` where it did not
    /// come.
    Wavefront {
        /// Shape of the grid.
        cells: [usize; 2],
        /// One a cell.
        labels: Vec<u32>,
        /// Cells in the order in which a search expanded them; none of the wave, which comes to all cells of a label at once.
        expanded: Vec<u32>,
        /// Whether the search began at the start.
        forward: bool,
    },
    /// Natural logarithm of the potential for every cell (0 at the goal, the lower the farther), minus infinity where
    /// there is none.
    Field {
        /// Shape of the grid.
        cells: [usize; 2],
        /// One a cell.
        potential: Vec<f64>,
    },
    /// The harmonic potential of the cells that the goal can be reached from. Its logarithms are for pictures alone, and
    /// computed when there is one ([`Trace::logarithms`]).
    Harmonic {
        /// The cells that the field covers.
        component: Component,
        /// Not known where the start is none of them.
        potential: Option<Potential>,
    },
    /// A potential that paths descend, for every cell; infinite where there is none.
    Potential {
        /// Shape of the grid.
        cells: [usize; 2],
        /// One a cell.
        heights: Vec<f64>,
    },
}

impl Trace {
    /// Of a field that paths ascend: the shape of the grid, and the natural logarithm of the potential for every cell, minus infinity
    /// where there is none. Linear in the number of cells.
    #[must_use]
    pub fn logarithms(&self) -> Option<([usize; 2], Cow<'_, [f64]>)> {
        match self {
            Self::Field { cells, potential } => Some((*cells, Cow::Borrowed(potential))),
            Self::Harmonic { component, potential } => {
                let guess = || Cow::Owned(rough_harmonic(component));
                let potential = potential.as_ref().map_or_else(guess, Cow::Borrowed);
                let mut ln = vec![f64::NEG_INFINITY; component.shape[0] * component.shape[1]];
                (0..component.len()).for_each(|at| ln[component.cell(at)] = potential.ln(at));
                Some((component.shape, Cow::Owned(ln)))
            }
            _ => None,
        }
    }
}

/// What a run has to add.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Note {
    /// The field was not relaxed to the tolerance asked for. No path is followed in it.
    Unconverged {
        /// Passes over all cells, until the limit.
        sweeps: usize,
        /// The measure in the last sweep.
        change: f64,
    },
    /// The path left local minima, which the forces alone do not leave.
    Escaped {
        /// How, in words.
        how: &'static str,
        /// Number of local minima.
        minima: usize,
        /// Number of moves that led out of them.
        moves: usize,
    },
    /// The field was relaxed to the tolerance of its measure, which left values about the path too small to be seen by it. Then it
    /// was relaxed to a relative tolerance.
    Continued {
        /// Passes over all cells until the measure was met.
        first: usize,
        /// Passes after that.
        more: usize,
    },
    /// Not relaxed to the tolerance, since the precision of a GPU goes no further.
    Floor {
        /// Passes over all cells, until only roundings changed.
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
    /// How it ended.
    pub outcome: Proposal,
    /// For pictures.
    pub trace: Trace,
    /// How much was built.
    pub size: Size,
    /// What to know about the outcome beyond it.
    pub note: Option<Note>,
}

/// A planner: settings are the fields of the implementing type.
///
/// What does not depend on the query is built once and can serve many queries. Deterministic: same input, same output.
pub trait Planner {
    /// Name on the command line.
    const NAME: &'static str;
    /// The representation it works on: that visibility needs polygons is a fact of the type.
    type Space;
    /// What it prepares.
    type Map;

    /// Prepares a space for queries.
    fn build(&self, space: &Self::Space) -> Self::Map;

    /// Answers one query.
    fn query(&self, space: &Self::Space, map: &Self::Map, query: &Query) -> Run;
}
