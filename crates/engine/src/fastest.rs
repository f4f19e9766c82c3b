//! The fastest motion among several ways.

use cplan_core::model::MotionProblem;
use cplan_core::space::Metric;
use cplan_motion::{Fastest, Limits, Timed, TimingError, least_duration};
use cplan_solver::{BoundedPath, Criterion, Options, bound, solve};

/// Share of the least time by which its lower bound may be too low, for the ways that it is a bound on.
const GAP: f64 = 1e-3;

/// The fastest motion found: along the path that the planner answers with, and along those that are shortest by length and by time at top
/// speed, if it is a planner that can be asked for them; and a lower bound on the time of every motion.
pub(super) fn fastest(
    problem: &MotionProblem,
    path: &BoundedPath,
    options: &Options,
) -> Result<(Timed, Option<Fastest>), TimingError> {
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
    let joints = &scene.arm().joints;
    let metric = Metric::Time { speeds: joints.each_ref().map(|joint| joint.velocity) };
    let known = path.bound.filter(|bound| bound.metric == metric).map(|bound| bound.lower);
    let length = || known.unwrap_or_else(|| bound(problem, best.curve.curve().path(), metric, GAP).lower);
    let duration = best.trajectory.duration();
    let fastest = options.bounded.then(|| Fastest::new(duration, least_duration(length(), &Limits::from(joints))));
    Ok((best, fastest))
}
