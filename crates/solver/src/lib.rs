//! From a problem to a verdict: build a space, plan, certify; refine and replan where that fails; and where no path is
//! found, look for a proof that there is none.
//!
//! Planners see approximations of the configuration space, so their paths are proposals. What leaves this module as
//! found has passed [`cplan_motion::recorded`], what leaves it as infeasible is proven there.
//!
//! # The ladder
//!
//! A rung is a space: for roadmaps `cspace::regions` with a margin (a quarter of it on the next rung), for fields
//! `cspace::outer_grid`, whose free cells are wholly free, then `cspace::grid_from_slices` with as many cells free at their
//! centres (passages look some three cells wider, and the certificate judges the path), then twice the cells. The cells
//! of fields are square in joint space unless their number is given, so that the equation is that of the configuration
//! space (`rungs`). A start or goal nearer to an obstacle than the margin is free, but not in such a space: `admission`
//! lets a certified straight step lead to where it is (or, where that is certified too, the path goes past it).
//!
//! The path that a planner proposes is certified. What fails is refined and planned again; after the first failure, and
//! at the end, [`cplan_proofs`] looks for a proof that there is no path. Should it find a path instead, which the
//! planner's space does not show, the answer stays unknown, and says so ([`Unknown::witness`]).
//!
//! # Replays
//!
//! [`Replay`] tells a run again in phases, from its trace, and from what is found once more for it alone.
//!
//! # Planners without a space
//!
//! [`decide`], and the planner `first`, is that question by itself, within one budget (among thousands of pieces it is
//! put to some of them first: what these close is closed). The planner `subdivision` is the search of boxes itself: it
//! judges the scene, so it has no representation to build or to refine, and `planner` lends it only the funnel path.
//!
//! The planner `shortest`, the default, is the search that bounds the optimum, twice. Slabs give a first path, which says
//! how far to look; among obstacles that are grown by a hair the way keeps off the true ones and is certified; the same
//! slices among the true ones give the bound. What is left of the gap is spent on fewer corners (`corners`), which makes
//! motions faster. Of gantries, whose C-obstacles are polygons, a visibility graph past polygons grown by a little has the
//! path, and one past polygons shrunk by a hair the bound: milliseconds where strips take seconds, as in a long spiral.
//! Otherwise polygons and graphs are built where the search fails only: then the visibility graph has its turn on behalf of
//! `shortest`. The planner `visibility` itself climbs to finer margins until both ends of the interval meet; without
//! `--gap` two levels at the most, where the interval is wider than 5 %.

mod admission;
mod answer;
mod bound;
mod cell_counts;
mod corners;
mod field_cells;
mod first;
mod grid_space;
mod ladder;
mod options;
mod planner;
mod planner_errors;
mod registry;
mod replay;
mod rungs;
mod setting;
mod settle;
mod shortest;
mod subdivision;
mod thinned;

pub use answer::{Answer, BoundedPath, Unknown};
pub use bound::{Bound, bound};
pub use cell_counts::CellCounts;
pub use field_cells::field_on_cells;
pub use grid_space::GridSpace;
pub use ladder::solve;
pub use options::{LEVELS, NamedJoints, Options};
pub use planner::Planner;
pub use registry::{Descriptor, Family, Method};
pub use replay::{Phase, Replay, Shows, SlabBoxes, Sweeps};
pub use setting::{CELLS, Criterion, FIRST_CELLS, MOST_MARGIN, NEAREST, SAMPLES, Setting, Settings};
pub use settle::{LARGE_PROOF, decide};

use cplan_core::cspace::{Grid, Regions};
use std::ops::Add;
use std::time::Duration;

/// The representation that the last attempt worked on.
#[derive(Debug, Clone)]
pub enum Space {
    /// Polygons, with the margin that obstacles were grown by, metres.
    Regions(Box<Regions>),
    /// Cells of a grid.
    Grid(Box<Grid>),
    /// None: subdivision judges the scene itself.
    Scene,
}

/// Time spent in each stage, over all attempts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stages {
    /// Building the configuration space, and what the planner prepares without start and goal.
    pub build: Duration,
    /// Answering the query.
    pub query: Duration,
    /// Certifying the paths that planners propose.
    pub certify: Duration,
    /// Looking for a proof that there is no path.
    pub prove: Duration,
    /// Bounding the optimum from below.
    pub bound: Duration,
}

impl Stages {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.build + self.query + self.certify + self.prove + self.bound
    }
}

impl Add for Stages {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            build: self.build + other.build,
            query: self.query + other.query,
            certify: self.certify + other.certify,
            prove: self.prove + other.prove,
            bound: self.bound + other.bound,
        }
    }
}
