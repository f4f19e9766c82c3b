//! Starts and goals that the arm cannot be at, and the nearest ones that it can.

use super::question::{Question, Target};
use cplan_core::cspace::{NearestFree, nearest_free};
use cplan_core::model::{Arm, Obstruction, inverse};
use cplan_core::space::{Configuration, JointRange};
use cplan_geometry::Point;
use serde::Serialize;

/// Values of each joint from which the nearest place of the tip is looked for.
const SAMPLES: usize = 128;

/// Steps of the search for it end here, as a share of a joint's range.
const FINEST: f64 = 1e-12;

/// Which end of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// Where it begins.
    Start,
    /// Where it is to end.
    Goal,
}

/// A start or goal that is outside the limits or not free.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockedEnd {
    /// Which of the two.
    pub end: End,
    /// The configuration; of a tip goal an IK solution.
    pub at: Configuration,
    /// By how much each joint is beyond its limits.
    pub beyond: [f64; 2],
    /// What the arm hits there, or comes too near to.
    pub hits: Vec<Obstruction>,
    /// The nearest configuration that is free; none if there is none anywhere.
    pub nearest: Option<NearestFree>,
}

impl BlockedEnd {
    /// How far the tip moves to the nearest free configuration, metres.
    #[must_use]
    pub fn tip_moves(&self, arm: &Arm) -> Option<f64> {
        self.nearest.map(|nearest| (arm.tip_at(nearest.configuration) - arm.tip_at(self.at)).norm())
    }
}

/// A tip goal that no configuration within the limits reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutOfReach {
    /// The goal.
    pub tip: Point,
    /// The nearest place that the tip can be at, whatever is in the way: an upper bound on how far off it is.
    pub nearest: Point,
    /// Where the joints are then.
    pub at: Configuration,
}

/// What is wrong with the ends of a question: the start, and if no goal will do all of them, the nearest to a free configuration first.
#[must_use]
pub fn blocked_ends(question: &Question) -> (Vec<BlockedEnd>, Option<OutOfReach>) {
    let mut blocked: Vec<BlockedEnd> = Vec::new();
    if !question.is_free(question.start()) {
        blocked.push(of(question, End::Start, question.start()));
    }
    let mut out_of_reach = None;
    if question.goals().is_empty() {
        let arm = question.scene().arm();
        let goals: Vec<Configuration> = match question.target() {
            Target::Goals(goals) => goals.pieces().iter().map(|piece| piece.ends()[0]).collect(),
            Target::Tip(tip) => {
                let within = question.ends();
                if within.is_empty() {
                    out_of_reach = Some(nearest_tip(arm, *tip));
                }
                let beyond = inverse(arm, *tip, question.start()).branches;
                if within.is_empty() { beyond } else { within.iter().map(|piece| piece.at(0.5)).collect() }
            }
        };
        // A goal at the start has been told as that.
        let elsewhere = goals.into_iter().filter(|&q| q != question.start());
        let mut goals: Vec<BlockedEnd> = elsewhere.map(|q| of(question, End::Goal, q)).collect();
        let far = |end: &BlockedEnd| end.nearest.map_or(f64::INFINITY, |nearest| nearest.distance);
        goals.sort_by(|a, b| far(a).total_cmp(&far(b)));
        blocked.extend(goals);
    }
    (blocked, out_of_reach)
}

fn of(question: &Question, end: End, at: Configuration) -> BlockedEnd {
    let scene = question.scene();
    let beyond = [0, 1].map(|k| match scene.arm().joints[k].range {
        JointRange::Interval { lower, upper } => (lower - at[k]).max(at[k] - upper).max(0.0),
        JointRange::Circle => 0.0,
    });
    BlockedEnd { end, at, beyond, hits: scene.obstructions(at), nearest: nearest_free(scene, at) }
}

/// The nearest place that the tip gets to within the limits: the best of a lattice of configurations, and from there by steps that are halved.
fn nearest_tip(arm: &Arm, tip: Point) -> OutOfReach {
    let ranges = arm.topology().ranges;
    let at = |share: [f64; 2]| {
        Configuration::from_fn(|k, _| {
            let (lower, upper) = ranges[k].domain();
            (lower + (upper - lower) * share[k]).clamp(lower, upper)
        })
    };
    let off = |share: [f64; 2]| (arm.tip_at(at(share)) - tip).norm();
    let lattice = (0..=SAMPLES).flat_map(|i| (0..=SAMPLES).map(move |j| [i, j].map(|n| n as f64 / SAMPLES as f64)));
    let mut best = lattice.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or([0.5; 2]);
    let mut step = 1.0 / SAMPLES as f64;
    while step > FINEST {
        let beside = (0..9).filter(|&k| k != 4).map(|k| [k / 3, k % 3].map(|n| f64::from(n) - 1.0));
        let beside = beside.map(|to| [0, 1].map(|k| (best[k] + step * to[k]).clamp(0.0, 1.0)));
        match beside.min_by(|a, b| off(*a).total_cmp(&off(*b))).filter(|next| off(*next) < off(best)) {
            Some(next) => best = next,
            None => step /= 2.0,
        }
    }
    OutOfReach { tip, nearest: arm.tip_at(at(best)), at: at(best) }
}
