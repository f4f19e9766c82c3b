//! Where a path best ends, of all goals along a segment.

use crate::certify::{CertifiedPath, certify};
use crate::cspace::free_stretches;
use crate::model::Problem;
use crate::space::{Configuration, Measure, Metric, Path, Segment};

/// A path's end is on a segment of goals if it is this near: far above rounding, far below any distance that matters.
const ON: f64 = 1e-9;

/// The path with its end moved along the free stretch of goals that it leads to, so that its last leg is the shortest; it keeps
/// the share `kept` of the arm's reach beyond the clearance there. None if it leads to a single goal, if that would not make
/// it shorter, or if the new leg is not certified.
pub(super) fn shortened(problem: &Problem, path: &CertifiedPath, metric: Metric, kept: f64) -> Option<CertifiedPath> {
    let scene = problem.scene();
    let topology = scene.arm().topology();
    let waypoints = path.path().waypoints();
    let (&end, before) = waypoints.split_last()?;
    let &last = before.last()?;
    let measure = Measure::from(metric);
    let grow = scene.workspace().clearance + kept * scene.arm().reach();
    let here = |stretch: &Segment| -> Vec<Segment> {
        let holds = |copy: &Segment| copy.distance(Measure::from(Metric::Euclidean), end) <= ON;
        stretch.copies_near(&topology, end).filter(holds).collect()
    };
    let segments = problem.goals().pieces().iter().filter(|piece| !piece.is_point());
    let parts = segments.flat_map(|piece| piece.within_domain(&topology)).filter(|part| !here(part).is_empty());
    let stretches = parts.flat_map(|part| free_stretches(scene, &part, grow));
    let best = stretches.flat_map(|stretch| here(&stretch)).map(|stretch| stretch.nearest(measure, last));
    let shorter = |goal: &Configuration| metric.norm(goal - last) < metric.norm(end - last);
    let goal = best.filter(shorter).min_by(|a, b| metric.norm(a - last).total_cmp(&metric.norm(b - last)))?;
    let moved = Path::new(before.iter().copied().chain([goal]).collect());
    certify(scene, moved, scene.workspace().clearance).ok()
}
