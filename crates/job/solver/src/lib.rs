//! The solver: it builds a space, plans a path and certifies it. If that fails, it refines the space and plans again.
//! If no path is found, it looks for a proof that no path exists.
//!
//! Planners see approximations of the configuration space, so their paths are only proposals. Every path that this
//! crate reports as found has passed [`cplan_judge::certify`]. Every answer reported as infeasible is proven.
//!
//! # The ladder
//!
//! A rung of the ladder is a space:
//! - Roadmaps use `cspace::regions` with a margin, which shrinks to a quarter on each rung.
//! - Fields first use `cspace::outer_grid`, whose free cells are free throughout. Then they use
//!   `cspace::grid_from_slices` with the same number of cells, which are free at their centres: passages look some
//!   three cells wider, and the certificate judges the path. Then the number of cells along each axis is doubled.
//!
//! The cells of fields are square in joint space unless their number is given, so that the equation is that of the
//! configuration space (`rungs`).
//!
//! A start or goal nearer to an obstacle than the margin is free, but not in such a space. For these, `admission` finds
//! a certified straight step to a configuration that is free in the space. If the path can also be certified without
//! this detour, it skips the configuration.
//!
//! The path that a planner proposes is certified. If that fails, the space is refined and the path planned again. After
//! the first failure, and at the end, [`cplan_proofs`] looks for a proof that there is no path. If that search finds a
//! path instead, which the planner's space does not show, the answer remains unknown and includes that path
//! ([`Unknown::witness`]).
//!
//! # Replays
//!
//! [`Replay`] shows a run again in phases, from its trace and from data that is recomputed only for the replay.
//!
//! # Planners without a space
//!
//! [`decide`], and the planner `first`, run that search alone, within one budget. Among thousands of pieces, they first
//! try some of the pieces: if these block all paths, so do all pieces together. The planner `subdivision` is the search
//! of boxes itself. It judges the scene, so it has no representation to build or to refine, and uses only the funnel
//! path of `planner`.
//!
//! The planner `shortest`, the default, runs the search that bounds the optimum twice:
//! - Slabs give a first path, whose length limits the search.
//! - Among slightly grown obstacles, the shortest path keeps off the true ones and can be certified.
//! - The same slices among the true obstacles give the bound.
//! - The remaining gap is spent on removing corners (`corners`), which makes motions faster.
//!
//! The C-obstacles of gantries are polygons. There, a visibility graph past slightly grown polygons gives the path, and
//! one past slightly shrunk polygons the bound. That takes milliseconds where strips take seconds, as in a long spiral.
//! For other arms, polygons and graphs are built only if the search fails: then the visibility graph answers for
//! `shortest`.
//!
//! The planner `visibility` itself climbs to finer margins until both ends of the interval meet. Without `--gap` it
//! climbs two levels at most, and only if the interval is wider than 5 %.

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
    /// No representation: subdivision works on the scene itself.
    Scene,
}

/// Time spent in each stage, over all attempts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stages {
    /// Building the configuration space, and the planner's preparation that does not depend on start and goal.
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
