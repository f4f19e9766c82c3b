//! Bounds on how much longer a path is than the shortest one.

use super::rungs::extent;
use cplan_model::MotionProblem;
use cplan_model::space::{Metric, Path};
use cplan_planners::cspace::inner_regions;
use cplan_planners::planner::{Planner as _, Proposal, Query, Visibility};
use cplan_proofs::{BoundEvidence, MotionQuery, bound_evidence, least_length};

/// The length of a path, and a proven lower bound on the length of all paths for the same problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// The metric in which lengths are measured.
    pub metric: Metric,
    /// Lower bound on the lengths of all motions from the start to any goal, with any number of turns.
    pub lower: f64,
    /// Length of the path.
    pub upper: f64,
}

impl Bound {
    /// Returns the relative excess of the path's length over the lower bound: 0.001 for a thousandth. Infinite without a lower
    /// bound.
    pub fn gap(&self) -> f64 {
        if self.upper <= self.lower { 0.0 } else { self.upper / self.lower - 1.0 }
    }

    /// Searches for evidence of the lower bound: walls and barriers that close all shorter paths. The search for the bound keeps
    /// no evidence, so this repeats it.
    pub fn evidence(&self, problem: &MotionProblem) -> BoundEvidence {
        let gap = (self.gap() * EVIDENCE_GAP_SHARE).clamp(MIN_EVIDENCE_GAP, 1.0);
        bound_evidence(&motions(problem, self.metric), self.upper.max(self.lower), gap)
    }
}

/// Returns bounds for `path`; see [`least_length`], and [`inner_regions`] for gantries. Refines the lower bound until
/// the gap is below `gap` (0.001 for a thousandth), or until the bound cannot be improved. Usually takes milliseconds.
pub fn bound(problem: &MotionProblem, path: &Path, metric: Metric, gap: f64) -> Bound {
    let upper = metric.length(path);
    Bound { metric, lower: lower_bound(&motions(problem, metric), upper, gap, &[]), upper }
}

/// The polygons lie within the C-obstacles of a gantry, at most this far from their borders, as a share of the gap times the
/// arm's extent. At each corner, a path among the polygons is shorter by about this distance.
const POLYGON_LOSS: f64 = 0.02;

/// Lower limit of the distance that [`POLYGON_LOSS`] gives, as a share of the arm's extent. It is far greater than rounding
/// errors.
const MIN_POLYGON_LOSS: f64 = 1e-9;

/// Largest number of pairs of shapes of a gantry for which the polygons are united. With the accuracy of [`POLYGON_LOSS`], this
/// takes some tenths of a second; with several times as many overlapping pairs, it would take a minute.
pub(super) const MAX_UNITED_PAIRS: usize = 512;

/// Bound on the relative rounding error of a length.
const ROUNDING: f64 = 1e-9;

/// Computes a lower bound on the lengths of motions. For gantries, it is the length of the shortest path past the exact
/// C-obstacles, up to a small tolerance; for other arms, see [`least_length`].
pub(super) fn lower_bound(motions: &MotionQuery, upper: f64, gap: f64, slices: &[f64]) -> f64 {
    length_past_polygons(motions, gap).unwrap_or_else(|| least_length(motions, upper, gap, slices))
}

/// Computes the length of the shortest path past polygons within the C-obstacles of a gantry. `None` if there are no such
/// polygons.
fn length_past_polygons(motions: &MotionQuery, gap: f64) -> Option<f64> {
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

/// The search for evidence ends at this share of the stated gap. It lacks the initial slices that the search for the bound had,
/// so it must aim at a smaller gap to prove as much.
const EVIDENCE_GAP_SHARE: f64 = 0.05;

/// Lower limit of the gap at which the search for evidence ends.
const MIN_EVIDENCE_GAP: f64 = 1e-9;

/// Returns the query for all motions from the problem's start to its goals.
pub(super) fn motions(problem: &MotionProblem, metric: Metric) -> MotionQuery<'_> {
    let scene = problem.scene();
    let clearance = scene.workspace().clearance;
    MotionQuery { scene, start: problem.start(), goals: problem.goals(), clearance, metric }
}
