//! How far a path is from the optimum, at the most.

use crate::cspace::{InnerObstacles, inner_regions};
use crate::geometry::{Convex, Pose, separation};
use crate::model::{Problem, Scene};
use crate::plan::{Outcome, Planner, Query, Visibility};
use crate::space::{Axis, Configuration, Metric, Path};
use std::f64::consts::TAU;

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

    /// What two bounds of the same problem say together: the shorter path, and the greater of what none is below.
    #[must_use]
    pub(super) fn and(self, other: Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.min(other.upper), ..self }
    }
}

/// A share in words: `0.031 %`.
#[must_use]
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent == 0.0 || percent >= 0.01 { format!("{percent:.2} %") } else { format!("{percent:.1e} %") }
}

/// What rounding and the tie-break of travel times may add to a shortest length, as a share of it.
const ROUNDING: f64 = 1e-9;

/// Distance of the configurations, radians or metres, at which a path is looked at for obstacles to add. Only how many
/// are found at once depends on it.
const STEP: f64 = 0.05;

/// Times that obstacles are added.
const ROUNDS: usize = 32;

/// Turns of the universal cover looked at, to either side of the start, at the most.
const MOST_PERIODS: usize = 3;

/// A bound for `path`, from obstacles made smaller by `margin` metres.
///
/// The shortest path among smaller and fewer obstacles is no longer than any motion that is free among the real ones, if
/// that stays within the window of the universal cover; motions that leave it are bounded by the way out and back to the
/// nearest goal. Obstacles are added as shortest paths run into them.
#[must_use]
pub fn bound(problem: &Problem, path: &Path, metric: Metric, margin: f64) -> Bound {
    let upper = metric.length(path);
    let mut inner = InnerObstacles::new(margin);
    let mut chosen = Vec::new();
    let mut lower = 0.0;
    for periods in 1..=MOST_PERIODS {
        let within = shortest(problem, &mut inner, &mut chosen, metric, periods);
        let around = leaving(problem, metric, periods);
        lower = f64::max(lower, within.min(around));
        if within <= around {
            break;
        }
    }
    Bound { metric, lower: lower.min(upper) * (1.0 - ROUNDING), upper }
}

/// Length of the shortest path within the window among as many smaller obstacles as make a difference; infinite if
/// there is none, and 0 where the search fails.
fn shortest(
    problem: &Problem,
    inner: &mut InnerObstacles,
    chosen: &mut Vec<usize>,
    metric: Metric,
    periods: usize,
) -> f64 {
    let scene = &problem.scene;
    let planner = Visibility { metric };
    let topology = scene.arm.topology();
    let goals = problem.goals.iter().map(|&goal| topology.lift(goal, problem.start)).collect();
    let query = Query { start: problem.start, goals };
    let mut length = 0.0;
    for _ in 0..ROUNDS {
        let regions = inner_regions(scene, inner, problem.start, periods, chosen);
        let path = match planner.query(&regions, &planner.build(&regions), &query).outcome {
            Outcome::Found(path) => path,
            Outcome::NoPath => return f64::INFINITY,
            Outcome::GaveUp(_) => return length,
        };
        length = metric.length(&path);
        let met = run_into(scene, &path, chosen);
        if met.is_empty() {
            break;
        }
        chosen.extend(met);
    }
    length
}

/// The pairs, not yet `known`, that a path leads through: looked at where steps end. A pair is passed over for as long as
/// its part has not moved by what it was away. `O(pairs log steps)` looks where a path keeps away from most of them.
fn run_into(scene: &Scene, path: &Path, known: &[usize]) -> Vec<usize> {
    let mut poses = Vec::new();
    for (from, to) in path.segments() {
        let steps = ((to - from).norm() / STEP).ceil().max(1.0) as usize;
        poses.extend((0..=steps).map(|i| scene.arm.poses(from + (to - from) * (i as f64 / steps as f64))));
    }
    let mut unknown = vec![true; scene.pairs().len()];
    known.iter().for_each(|&index| unknown[index] = false);
    let mut met = Vec::new();
    let mut moved: Vec<f64> = Vec::new();
    let mut of = None;
    for (index, &pair) in scene.pairs().iter().enumerate().filter(|(index, _)| unknown[*index]) {
        let part = scene.part(pair);
        if of != Some((pair.link, pair.part)) {
            of = Some((pair.link, pair.part));
            moved = displacements(part, &poses, pair.link);
        }
        let mut step = 0;
        while let Some(pose) = poses.get(step) {
            let apart = separation(&part.at(&pose[pair.link]), scene.piece(pair)).distance;
            let room = apart - scene.workspace.clearance;
            if room < 0.0 {
                met.push(index);
                break;
            }
            let from = moved[step];
            step = (step + 1).max(moved.partition_point(|to| to - from < room));
        }
    }
    met
}

/// By how much the points of a part have moved at the most from each pose to the next, summed up. A displacement is linear
/// in the point, so a corner of the core has the greatest.
fn displacements(part: &Convex, poses: &[[Pose; 2]], link: usize) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = poses.windows(2).map(|w| {
        let by = part.core().iter().map(|p| (w[1][link] * p - w[0][link] * p).norm());
        sum += by.fold(0.0, f64::max);
        sum
    });
    [0.0].into_iter().chain(steps).collect()
}

/// A lower bound on the length of motions that leave the window: on one axis they go to its end, and from there to a
/// copy of a goal.
fn leaving(problem: &Problem, metric: Metric, periods: usize) -> f64 {
    let topology = problem.scene.arm.topology();
    let out = TAU * periods as f64;
    let mut least = f64::INFINITY;
    for axis in (0..2).filter(|&k| topology.axes[k] == Axis::Circle) {
        for side in [-out, out] {
            let end = problem.start[axis] + side;
            for goal in &problem.goals {
                let back = (Axis::Circle.lift(goal[axis], end) - end).abs();
                let mut way = Configuration::zeros();
                way[axis] = out + back;
                least = least.min(metric.norm(way));
            }
        }
    }
    least
}
