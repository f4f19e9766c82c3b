//! Starts and goals that are blocked or out of reach, and the nearest free configurations.

use cplan_blockers::{End, MotionQuestion, Target};
use cplan_geometry::Point;
use cplan_legs::StandstillScene;
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Arm, Elbow, Obstruction, Scene, inverse};
use cplan_planners::cspace::{NearestFree, nearest_free};

/// Number of values per joint in the lattice with which the search for the tip's nearest place starts.
const SAMPLES_PER_JOINT: usize = 128;

/// Smallest step of the search for the tip's nearest place, as a fraction of a joint's range.
const MIN_STEP: f64 = 1e-12;

/// A start or goal that is outside the limits, or not free.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockedEnd {
    /// The end that is blocked.
    pub end: End,
    /// The configuration. For a tip goal, an IK solution.
    pub at: Configuration,
    /// Distance of each joint's value from its range, in radians or metres; 0 inside the range.
    pub beyond: [f64; 2],
    /// Obstacles that the arm hits there, or that it comes too near to.
    pub hits: Vec<Obstruction>,
    /// The scene of these hits, if the arm hits them at rest. `None` for the scene of the motion.
    pub standing: Option<StandstillScene>,
    /// The nearest free configuration. `None` if no configuration is free, or if the arm is at rest.
    pub nearest: Option<NearestFree>,
}

impl BlockedEnd {
    /// Returns the scene of the hits. `scene` is that of the motion.
    pub fn scene<'a>(&'a self, scene: &'a Scene) -> &'a Scene {
        self.standing.as_ref().map_or(scene, |standing| &standing.scene)
    }

    /// Returns the distance of the elbow motor's angle from its range, in radians. `None` if the angle is inside, or
    /// has no range.
    pub fn beyond_motor(&self, arm: &Arm) -> Option<f64> {
        let (sum, motors) = arm.topology().sum.zip(arm.motors)?;
        let beyond = (sum.lower - sum.of(self.at)).max(sum.of(self.at) - sum.upper);
        (!sum.contains(self.at)).then_some(motors.gear[1].abs() * beyond)
    }

    /// Returns the distance, in metres, between the tip at the blocked configuration and the tip at the nearest free
    /// one. `None` if no configuration is free.
    pub fn tip_moves(&self, arm: &Arm) -> Option<f64> {
        self.nearest.map(|nearest| (arm.tip_at(nearest.configuration) - arm.tip_at(self.at)).norm())
    }
}

/// A tip goal that no configuration within the limits reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutOfReach {
    /// The goal.
    pub tip: Point,
    /// The required side of the elbow. `None` if either side will do.
    pub elbow: Option<Elbow>,
    /// The nearest place found that the tip can reach without obstacles. A nearer one may exist.
    pub nearest: Point,
    /// The joint values at that place.
    pub at: Configuration,
}

/// Finds the problems with start and goals of a question. Goals are reported only if all of them are blocked. The goal
/// nearest to a free configuration comes first.
pub fn blocked_ends(question: &MotionQuestion) -> (Vec<BlockedEnd>, Option<OutOfReach>) {
    let mut blocked: Vec<BlockedEnd> = Vec::new();
    if !question.is_start_free() {
        blocked.push(blocked_end(question, End::Start, question.start()));
    }
    let mut out_of_reach = None;
    if question.goals().is_empty() {
        let arm = question.scene().arm();
        let goals: Vec<Configuration> = match question.target() {
            Target::Goals(goals) => goals.pieces().iter().map(|piece| piece.ends()[0]).collect(),
            Target::Tip(tip, elbow) => {
                let within = question.ends();
                if within.is_empty() {
                    out_of_reach = Some(nearest_tip(arm, *tip, *elbow));
                }
                let beyond = inverse(arm, *tip, question.start()).with_elbow(arm, *elbow).branches;
                if within.is_empty() { beyond } else { within.iter().map(|piece| piece.at(0.5)).collect() }
            }
        };
        // A goal that equals the start is already reported as the start.
        let elsewhere = goals.into_iter().filter(|&q| q != question.start());
        let mut goals: Vec<BlockedEnd> = elsewhere.map(|q| blocked_end(question, End::Goal, q)).collect();
        let far = |end: &BlockedEnd| end.nearest.map_or(f64::INFINITY, |nearest| nearest.distance);
        goals.sort_by(|a, b| far(a).total_cmp(&far(b)));
        blocked.extend(goals);
    }
    (blocked, out_of_reach)
}

fn blocked_end(question: &MotionQuestion, end: End, at: Configuration) -> BlockedEnd {
    let scene = question.scene();
    let beyond = [0, 1].map(|k| match scene.arm().joints[k].range {
        JointRange::Interval { lower, upper } => (lower - at[k]).max(at[k] - upper).max(0.0),
        JointRange::Circle => 0.0,
    });
    let hits = scene.obstructions(at);
    let standing = if hits.is_empty() { question.blocked_standstill(end, at).cloned() } else { None };
    match standing {
        Some(standing) => {
            let hits = standing.scene.obstructions(at);
            BlockedEnd { end, at, beyond, hits, standing: Some(standing), nearest: None }
        }
        None => BlockedEnd { end, at, beyond, hits, standing, nearest: nearest_free(scene, at) },
    }
}

/// Finds the place nearest to a goal that the tip reaches within the limits, with the elbow on the stated side.
/// Improves the best configuration of a lattice by ever smaller steps.
fn nearest_tip(arm: &Arm, tip: Point, elbow: Option<Elbow>) -> OutOfReach {
    let ranges = arm.topology().ranges;
    let at = |share: [f64; 2]| {
        Configuration::from_fn(|k, _| {
            let (lower, upper) = ranges[k].domain();
            (lower + (upper - lower) * share[k]).clamp(lower, upper)
        })
    };
    let off = |share: [f64; 2]| match elbow.is_none_or(|elbow| elbow.allows(arm, at(share))) {
        true => (arm.tip_at(at(share)) - tip).norm(),
        false => f64::INFINITY,
    };
    let lattice = (0..=SAMPLES_PER_JOINT)
        .flat_map(|i| (0..=SAMPLES_PER_JOINT).map(move |j| [i, j].map(|n| n as f64 / SAMPLES_PER_JOINT as f64)));
    let mut best = lattice.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or([0.5; 2]);
    let mut step = 1.0 / SAMPLES_PER_JOINT as f64;
    while step > MIN_STEP {
        let beside = (0..9).filter(|&k| k != 4).map(|k| [k / 3, k % 3].map(|n| f64::from(n) - 1.0));
        let beside = beside.map(|to| [0, 1].map(|k| (best[k] + step * to[k]).clamp(0.0, 1.0)));
        match beside.min_by(|a, b| off(*a).total_cmp(&off(*b))).filter(|next| off(*next) < off(best)) {
            Some(next) => best = next,
            None => step /= 2.0,
        }
    }
    OutOfReach { tip, elbow, nearest: arm.tip_at(at(best)), at: at(best) }
}
