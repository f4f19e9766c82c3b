//! Starts and goals that are free, but blocked in a space whose obstacles are grown by a margin.
//!
//! A smaller margin everywhere would give many more corners. Instead, a *stand-in* replaces such a start or goal: a
//! configuration that is free in the space, at the end of a short, certified straight motion. That motion completes the
//! planner's path, and the result is judged as a whole, like any other path.

use super::planner_space::PlannerSpace;
use cplan_judge::certify;
use cplan_model::space::{Configuration, Path, Segment, Topology};
use cplan_model::{MotionProblem, Scene};
use cplan_planners::cspace::free_stretches;
use cplan_planners::planner::Query;
use std::f64::consts::TAU;

/// Number of directions in which the search for a stand-in looks.
const STAND_IN_DIRECTIONS: usize = 64;

/// Number of steps that are tried in each direction, the shortest first. Each is twice as long as the one before.
const STEPS_PER_DIRECTION: usize = 13;

/// Length of the shortest step, radians or metres. A stand-in usually needs far longer steps with the default margin, a
/// thousandth of the reach.
const SHORTEST_STEP: f64 = 1e-4;

/// Returns `q` if the space admits it. Otherwise returns an admitted configuration to which a certified straight motion
/// leads from `q`, the shortest that is found. Returns `q` itself if none is found.
fn stand_in(scene: &Scene, space: &impl PlannerSpace, q: Configuration) -> Configuration {
    if space.admits(q) {
        return q;
    }
    let direction = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / STAND_IN_DIRECTIONS as f64).sin_cos();
        Configuration::new(cos, sin)
    };
    for step in 0..STEPS_PER_DIRECTION {
        let length = SHORTEST_STEP * (1_u32 << step) as f64;
        for k in 0..STAND_IN_DIRECTIONS {
            let there = q + direction(k) * length;
            let direct = || certify(scene, Path::new(vec![q, there]));
            if space.admits(there) && direct().is_ok() {
                return there;
            }
        }
    }
    q
}

/// Number of samples on a free stretch of goals. With them the search tests whether the space admits any part of the
/// stretch.
const SAMPLES_PER_STRETCH: usize = 17;

/// Largest number of stretches of goals that get a stand-in. The longest stretches come first.
const MAX_STRETCHES: usize = 8;

/// Start and goals of a problem, with their stand-ins.
pub(super) struct Ends {
    topology: Topology,
    start: Configuration,
    /// Pairs of a stand-in and its true goal, on the turns near the start.
    stand_ins: Vec<[Configuration; 2]>,
    /// The query for the planner.
    pub query: Query,
}

/// Distance below which two configurations count as the same, up to whole turns, in radians or metres. It is far above
/// rounding, and far below any distance that matters.
const COPY_DISTANCE: f64 = 1e-9;

impl Ends {
    /// Finds stand-ins for the start and for single goals that the space does not admit. Of a goal segment, the space
    /// usually admits some part. If it admits no part of a free stretch, the stretch's middle gets a stand-in.
    pub fn new(problem: &MotionProblem, space: &impl PlannerSpace) -> Self {
        let (scene, start) = (problem.scene(), problem.start());
        let topology = scene.arm().topology();
        let mut goals: Vec<Segment> = Vec::new();
        let mut stand_ins = Vec::new();
        let mut wanted: Vec<Configuration> = Vec::new();
        for piece in problem.goals().pieces() {
            if piece.is_point() {
                wanted.push(piece.ends()[0]);
                continue;
            }
            for part in piece.within_domain(&topology) {
                goals.push(part);
                wanted.extend(middles_unknown(scene, space, &part));
            }
        }
        for goal in wanted {
            let goal = topology.lift(goal, start);
            let there = stand_in(scene, space, goal);
            goals.push(Segment::point(there));
            stand_ins.push([there, goal]);
        }
        let query = Query { start: stand_in(scene, space, start), goals: goals.into_iter().collect() };
        Self { topology, start, stand_ins, query }
    }

    /// Returns true if any goal has a stand-in.
    pub fn has_goal_stand_ins(&self) -> bool {
        self.stand_ins.iter().any(|[stand_in, goal]| stand_in != goal)
    }

    /// Completes the planner's path, so that it leads from the true start to the true goal through the stand-ins.
    pub fn complete(&self, path: &Path) -> Path {
        self.join(path.waypoints(), self.goal_reached(path))
    }

    /// Completes the planner's path, but leaves out the stand-ins. The result is shorter than that of
    /// [`Ends::complete`] if the direct motion is free. Returns `None` if the path has no stand-ins.
    pub fn past_stand_ins(&self, path: &Path) -> Option<Path> {
        let (inner, goal) = (path.waypoints(), self.goal_reached(path));
        let (first, last) = (self.start != path.start(), goal != path.goal());
        let past = || self.join(&inner[usize::from(first)..inner.len() - usize::from(last)], goal);
        (inner.len() > 1 && (first || last)).then(past)
    }

    /// Returns the true goal that the path leads to, on the turn where the path ends.
    fn goal_reached(&self, path: &Path) -> Configuration {
        let end = path.goal();
        let of = |[stand_in, goal]: &[Configuration; 2]| {
            (self.topology.distance(*stand_in, end) < COPY_DISTANCE).then(|| end + (goal - stand_in))
        };
        self.stand_ins.iter().find_map(of).unwrap_or(end)
    }

    fn join(&self, middle: &[Configuration], goal: Configuration) -> Path {
        Path::new([self.start].into_iter().chain(middle.iter().copied()).chain([goal]).collect())
    }
}

/// Returns the middles of those free stretches of a segment of which the space admits no part. Each needs a stand-in.
fn middles_unknown(scene: &Scene, space: &impl PlannerSpace, piece: &Segment) -> Vec<Configuration> {
    let knows = |stretch: &Segment| {
        (0..SAMPLES_PER_STRETCH).any(|k| space.admits(stretch.at(k as f64 / (SAMPLES_PER_STRETCH - 1) as f64)))
    };
    let mut unknown = free_stretches(scene, piece, scene.workspace().clearance);
    unknown.retain(|stretch| !knows(stretch));
    unknown.sort_by(|a, b| b.length().total_cmp(&a.length()));
    unknown.truncate(MAX_STRETCHES);
    unknown.iter().map(|stretch| stretch.at(0.5)).collect()
}
