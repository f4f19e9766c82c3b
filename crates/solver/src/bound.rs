//! How far a path is from the optimum, at the most.

use super::rungs::extent;
use cplan_core::cspace::inner_regions;
use cplan_core::model::MotionProblem;
use cplan_core::planner::{Planner as _, Proposal, Query, Visibility};
use cplan_core::space::{Metric, Path};
use cplan_proofs::{BoundEvidence, Motions, bound_evidence, least_length};

/// A path's length and a proven lower bound on that of every other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// How lengths are measured.
    pub metric: Metric,
    /// No motion from the start to any of the goals, on whichever turns, is shorter.
    pub lower: f64,
    /// Length of the path.
    pub upper: f64,
}

impl Bound {
    /// By which share the path is longer than the lower bound: 0.001 for a thousandth. Infinite where nothing is known.
    #[must_use]
    pub fn gap(&self) -> f64 {
        if self.upper <= self.lower { 0.0 } else { self.upper / self.lower - 1.0 }
    }

    /// Finds anew what closes ways that are shorter than was stated.
    #[must_use]
    pub fn evidence(&self, problem: &MotionProblem) -> BoundEvidence {
        let gap = (self.gap() * FINER).clamp(LEAST_GAP, 1.0);
        bound_evidence(&motions(problem, self.metric), self.upper.max(self.lower), gap)
    }
}

/// A bound for `path`; see [`least_length`], and of gantries [`inner_regions`]. It is made better until the gap is known to be
/// below `gap` (0.001 for a thousandth), or cannot be. Milliseconds, as a rule.
#[must_use]
pub fn bound(problem: &MotionProblem, path: &Path, metric: Metric, gap: f64) -> Bound {
    let upper = metric.length(path);
    Bound { metric, lower: lower_bound(&motions(problem, metric), upper, gap, &[]), upper }
}

/// What polygons lose of obstacles, as shares of the gap and the arm's extent: a corner makes a way shorter by about as much.
const LOST: f64 = 0.02;

/// The same, as a share of the extent, at least: far above rounding.
const LEAST_LOST: f64 = 1e-9;

/// Of gantries the polygons of so many pairs are united at most: as fine as they are, that takes some tenths of a second, and a
/// minute with a few times as many that overlap.
pub(super) const FEW_POLYGONS: usize = 512;

/// What rounding may add to a length, as a share of it.
const ROUNDING: f64 = 1e-9;

/// A lower bound on the lengths of motions. Of gantries it is the shortest way past the exact C-obstacles, up to a hair; otherwise
/// that of [`least_length`].
pub(super) fn lower_bound(motions: &Motions, upper: f64, gap: f64, slices: &[f64]) -> f64 {
    past_polygons(motions, gap).unwrap_or_else(|| least_length(motions, upper, gap, slices))
}

/// The length of the shortest way past polygons that lie within the C-obstacles of a gantry; none where these are not known.
fn past_polygons(motions: &Motions, gap: f64) -> Option<f64> {
    let Motions { scene, start, goals, metric, .. } = *motions;
    if scene.pairs().len() > FEW_POLYGONS {
        return None;
    }
    let space = inner_regions(&scene.inner(), (LOST * gap.min(1.0)).max(LEAST_LOST) * extent(scene.arm()))?;
    let planner = Visibility { metric, ..Visibility::default() };
    let map = planner.build(&space);
    let run = planner.query(&space, &map, &Query { start, goals: goals.clone() });
    let Proposal::Found(path) = run.outcome else { return None };
    Some(metric.length(&path) * (1.0 - ROUNDING))
}

/// Share of the stated gap that the evidence may leave open: it is found in another way than the bound was, from fewer slices that
/// are known beforehand.
const FINER: f64 = 0.05;

/// The least gap that evidence is looked for.
const LEAST_GAP: f64 = 1e-9;

/// All motions that answer a problem.
pub(super) fn motions(problem: &MotionProblem, metric: Metric) -> Motions<'_> {
    let scene = problem.scene();
    let clearance = scene.workspace().clearance;
    Motions { scene, start: problem.start(), goals: problem.goals(), clearance, metric }
}
