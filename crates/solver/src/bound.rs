//! Upper bound on a path's distance from the optimum.

use super::rungs::extent;
use cplan_core::cspace::inner_regions;
use cplan_core::model::MotionProblem;
use cplan_core::planner::{Planner as _, Proposal, Query, Visibility};
use cplan_core::space::{Metric, Path};
use cplan_proofs::{BoundEvidence, MotionQuery, bound_evidence, least_length};

/// The length of a path, and a proven lower bound on the length of every other path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// The metric in which lengths are measured.
    pub metric: Metric,
    /// Lower bound on the lengths of all motions from the start to any of the goals, on any turns.
    pub lower: f64,
    /// Length of the path.
    pub upper: f64,
}

impl Bound {
    /// Returns the share by which the path is longer than the lower bound: 0.001 for a thousandth. Infinite if no lower
    /// bound is known.
    #[must_use]
    pub fn gap(&self) -> f64 {
        if self.upper <= self.lower { 0.0 } else { self.upper / self.lower - 1.0 }
    }

    /// Finds anew what closes ways that are shorter than was stated.
    #[must_use]
    pub fn evidence(&self, problem: &MotionProblem) -> BoundEvidence {
        let gap = (self.gap() * EVIDENCE_GAP_SHARE).clamp(MIN_EVIDENCE_GAP, 1.0);
        bound_evidence(&motions(problem, self.metric), self.upper.max(self.lower), gap)
    }
}

/// Returns bounds for `path`; see [`least_length`], and [`inner_regions`] for gantries. Refines the lower bound until
/// the gap is known to be below `gap` (0.001 for a thousandth), or cannot be. Usually takes milliseconds.
#[must_use]
pub fn bound(problem: &MotionProblem, path: &Path, metric: Metric, gap: f64) -> Bound {
    let upper = metric.length(path);
    Bound { metric, lower: lower_bound(&motions(problem, metric), upper, gap, &[]), upper }
}

/// Loss of the polygons against the obstacles, as a share of the gap times the arm's extent. A corner shortens a path
/// by about that much.
const POLYGON_LOSS: f64 = 0.02;

/// Smallest such loss, as a share of the extent: far above rounding.
const MIN_POLYGON_LOSS: f64 = 1e-9;

/// Largest number of pairs of a gantry whose polygons are united. At this resolution, that many take some tenths of a
/// second. A few times as many overlapping ones take a minute.
pub(super) const MAX_UNITED_PAIRS: usize = 512;

/// Share that rounding may add to a length.
const ROUNDING: f64 = 1e-9;

/// Computes a lower bound on the lengths of motions. For gantries it is the length of the shortest path past the exact
/// C-obstacles, up to a small tolerance; otherwise it is that of [`least_length`].
pub(super) fn lower_bound(motions: &MotionQuery, upper: f64, gap: f64, slices: &[f64]) -> f64 {
    past_polygons(motions, gap).unwrap_or_else(|| least_length(motions, upper, gap, slices))
}

/// Computes the length of the shortest path past polygons inside the C-obstacles of a gantry. `None` if these polygons
/// are not known.
fn past_polygons(motions: &MotionQuery, gap: f64) -> Option<f64> {
    let MotionQuery { scene, start, goals, metric, .. } = *motions;
    if scene.pairs().len() > MAX_UNITED_PAIRS {
        return None;
    }
    let space =
        inner_regions(&scene.inner(), (POLYGON_LOSS * gap.min(1.0)).max(MIN_POLYGON_LOSS) * extent(scene.arm()))?;
    let planner = Visibility { metric, ..Visibility::default() };
    let map = planner.build(&space);
    let run = planner.query(&space, &map, &Query { start, goals: goals.clone() });
    let Proposal::Found(path) = run.outcome else { return None };
    Some(metric.length(&path) * (1.0 - ROUNDING))
}

/// Share of the stated gap that the evidence may leave open: it is found in another way than the bound was, from fewer slices that
/// are known beforehand.
const EVIDENCE_GAP_SHARE: f64 = 0.05;

/// Smallest gap for which evidence is sought.
const MIN_EVIDENCE_GAP: f64 = 1e-9;

/// Returns all motions that answer a problem.
pub(super) fn motions(problem: &MotionProblem, metric: Metric) -> MotionQuery<'_> {
    let scene = problem.scene();
    let clearance = scene.workspace().clearance;
    MotionQuery { scene, start: problem.start(), goals: problem.goals(), clearance, metric }
}
