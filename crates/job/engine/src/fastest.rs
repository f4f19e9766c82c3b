//! The fastest motion along several paths.

use cplan_model::MotionProblem;
use cplan_model::space::Metric;
use cplan_motion::{DurationOptimality, Limits, TimedMotion, TimingError, least_duration};
use cplan_solver::{BoundedPath, Criterion, Options, bound, solve};

/// Gap, as a fraction, to which a lower bound on the path's length is refined. A lower bound on the time follows from it.
const LENGTH_BOUND_GAP: f64 = 1e-3;

/// Returns the fastest motion found, and a lower bound on the duration of every motion. Tries the planner's path and, if the
/// planner minimises a length, also the shortest path by Euclidean length and the one by time at top speed.
pub(super) fn fastest(
    problem: &MotionProblem,
    path: &BoundedPath,
    options: &Options,
) -> Result<(TimedMotion, Option<DurationOptimality>), TimingError> {
    let scene = problem.scene();
    let mut best = options.drive.along(scene, &path.certified, 1.0)?;
    for criterion in [Criterion::Time, Criterion::Euclidean] {
        let planner = options.planner.with_criterion(criterion);
        if planner == options.planner {
            continue;
        }
        let other = solve(problem, &Options { planner, bounded: false, ..*options }, &mut |_| {});
        if let Some(other) = other.outcome.found()
            && other.path() != path.path()
        {
            let timed = options.drive.along(scene, &other.certified, 1.0)?;
            if timed.trajectory.duration() < best.trajectory.duration() {
                best = timed;
            }
        }
    }
    let arm = scene.arm();
    let of_joints = Metric::Time { speeds: arm.joints.each_ref().map(|joint| joint.velocity), sum: None };
    let length = |metric: Metric| {
        let known = path.bound.filter(|bound| bound.metric == metric).map(|bound| bound.lower);
        known.unwrap_or_else(|| bound(problem, best.curve.curve().path(), metric, LENGTH_BOUND_GAP).lower)
    };
    let lower = || {
        let of_joints_alone = least_duration(length(of_joints), &Limits::from(&arm.joints));
        match arm.time_metric() {
            metric if metric == of_joints => of_joints_alone,
            // Motors with high accelerations can lower this bound, so the greater of both bounds counts.
            metric => of_joints_alone.max(least_duration(length(metric), &Limits::from(arm))),
        }
    };
    let fastest = options.bounded.then(|| DurationOptimality::new(best.trajectory.duration(), lower()));
    Ok((best, fastest))
}
