//! Starts and goals that are free in the scene, but blocked in a space with grown obstacles.
//!
//! A smaller margin would give many more corners. Instead, a *stand-in* replaces such a start or goal: a configuration that is
//! free in the space, with a short, certified straight motion to the start or goal. This motion completes the planner's path, and
//! the whole path is then certified like any other.

use super::planner_space::PlannerSpace;
use cplan_judge::certify;
use cplan_model::space::{Configuration, Path, Segment, Topology};
use cplan_model::{MotionProblem, Scene};
use cplan_planners::cspace::free_stretches;
use cplan_planners::planner::Query;
use std::f64::consts::TAU;

/// Number of directions in which stand-ins are sought.
const STAND_IN_DIRECTIONS: usize = 64;

/// Number of steps that are tried in each direction. The shortest comes first, and each is twice as long as the previous one.
const STEPS_PER_DIRECTION: usize = 13;

/// Length of the shortest step, radians or metres. With the default margin, a thousandth of the reach, stand-ins usually need far
/// longer steps.
const SHORTEST_STEP: f64 = 1e-4;

/// Returns `q` if the space admits it. Otherwise returns the nearest admitted configuration that the search finds with a
/// certified straight motion from `q`; if there is none, returns `q`.
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

/// Number of samples on a free stretch of goals that show whether the space admits a part of it.
const SAMPLES_PER_STRETCH: usize = 17;

/// Largest number of stretches of goals that get a stand-in. The longest stretches take precedence.
const MAX_STRETCHES: usize = 8;

/// Start and goals of a problem, with their stand-ins.
pub(super) struct Ends {
    topology: Topology,
    start: Configuration,
    /// Pairs of a stand-in and its true goal, shifted by whole turns to be near the start.
    stand_ins: Vec<[Configuration; 2]>,
    /// The query for the planner.
    pub query: Query,
}

/// Configurations closer than this count as the same, up to whole turns, in radians or metres. It is far above rounding errors,
/// and far below any relevant distance.
const COPY_DISTANCE: f64 = 1e-9;

impl Ends {
    /// Finds stand-ins for the start and for single goals that the space does not admit. The space usually admits a part of a
    /// goal segment. If it admits no part of a free stretch, the middle of the stretch gets a stand-in.
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

    /// Completes the planner's path through the stand-ins: from the true start to the true goal.
    pub fn complete(&self, path: &Path) -> Path {
        self.join(path.waypoints(), self.goal_reached(path))
    }

    /// Completes the planner's path without the stand-ins. If the direct motion is free, the result is shorter than that of
    /// [`Ends::complete`]. Returns `None` if the path has no stand-ins.
    pub fn past_stand_ins(&self, path: &Path) -> Option<Path> {
        let (inner, goal) = (path.waypoints(), self.goal_reached(path));
        let (first, last) = (self.start != path.start(), goal != path.goal());
        let past = || self.join(&inner[usize::from(first)..inner.len() - usize::from(last)], goal);
        (inner.len() > 1 && (first || last)).then(past)
    }

    /// Returns the true goal to which the path leads, with the whole turns that the path has made.
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

/// Returns the middles of those free stretches of a segment of which the space admits no part. Each of them needs a stand-in.
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
