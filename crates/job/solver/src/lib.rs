//! The solver builds a space, plans a path and certifies it. If that fails, it refines the space and plans again. If it finds no
//! path, it looks for a proof that none exists.
//!
//! Planners see approximations of the configuration space, so their paths are only proposals. Every path that this crate returns
//! has passed [`cplan_judge::certify`], and every answer *infeasible* is proven.
//!
//! # The ladder
//!
//! A rung of the ladder is a space:
//! - Roadmaps use `cspace::regions` with a margin, which shrinks to a quarter on each rung.
//! - Fields first use `cspace::outer_grid`, whose free cells are free throughout. The next rung is `cspace::grid_from_slices`
//!   with the same number of cells, whose free cells are free at their centres: passages look some three cells wider, and the
//!   certificate decides about the path. Then the number of cells along each axis doubles.
//!
//! Unless their number is given, the cells of fields are square in joint space, so that the equation does not depend on the grid
//! (`rungs`).
//!
//! A free start or goal may be nearer to an obstacle than the margin, and thus blocked in the space. Then `admission` finds a
//! certified straight step to a configuration that is free in the space. The final path avoids this detour if it can be certified
//! without it.
//!
//! After the first failure, and at the end, [`cplan_proofs`] looks for a proof that there is no path. This search may find a path
//! that the planner's space does not show. Then the answer is still unknown, but includes the path ([`Unknown::witness`]).
//!
//! # Replays
//!
//! [`Replay`] shows a run in phases, from its trace and from data that is computed only for the replay.
//!
//! # Planners without a space
//!
//! [`decide`] and the planner `first` run only the search for a path or a proof. If there are thousands of pieces, they first try
//! some of them: if these block all paths, so do all pieces. The planner `subdivision` is the search of boxes. It works on the
//! scene itself, so it has no space to build or to refine.
//!
//! The planner `shortest`, the default, runs the search for a lower bound twice:
//! - Slabs give a first path, whose length limits the search.
//! - Among slightly grown obstacles, the shortest path keeps off the true ones and can be certified.
//! - Among the true obstacles, the same slices give the bound.
//! - The remaining gap is spent on removing corners (`corners`), which makes motions faster.
//!
//! The C-obstacles of gantries are polygons. For gantries, a visibility graph past slightly grown polygons gives the path, and
//! one past slightly shrunk polygons gives the bound. In a long spiral, for example, this takes milliseconds instead of seconds.
//! For other arms, `shortest` builds a visibility graph only if its own search fails.
//!
//! The planner `visibility` climbs to finer margins until the lower bound meets the path's length. Without `--gap`, it climbs at
//! most two levels, and only if the gap exceeds 5 %.

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
mod planner_space;
mod registry;
mod replay;
mod rungs;
mod setting;
mod decision;
mod shortest;
mod subdivision;
mod thinned;

pub use answer::{Answer, BoundedPath, Unknown};
pub use bound::{Bound, bound};
pub use cell_counts::CellCounts;
pub use cplan_proofs::BoundRound;
pub use decision::{LARGE_PROOF_BOXES, decide};
pub use field_cells::field_on_cells;
pub use grid_space::GridSpace;
pub use ladder::solve;
pub use options::{ALLOWED_LEVELS, NamedJoints, Options};
pub use planner::Planner;
pub use registry::{Descriptor, Family, Method};
pub use replay::{Phase, Replay, Shows, SlabBoxes, Sweeps};
pub use setting::{
    ALLOWED_CELLS, ALLOWED_NEIGHBORS, ALLOWED_SAMPLES, Criterion, DEFAULT_CELLS, MAX_MARGIN, Setting, Settings,
};

use cplan_planners::cspace::{Grid, Regions};
use std::ops::Add;
use std::time::Duration;

/// The representation used by the last attempt.
#[derive(Debug, Clone)]
pub enum Space {
    /// Polygons, with the margin by which obstacles were grown, metres.
    Regions(Box<Regions>),
    /// Cells of a grid.
    Grid(Box<Grid>),
    /// No space: subdivision works on the scene itself.
    Scene,
}

/// Time spent in each stage, over all attempts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stages {
    /// Building the space, and the planner's preparation, except what depends on start and goal.
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
    /// Returns the total time.
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
