//! Reasons why a motion of a task is not possible.

use cplan_judge::CheckedProof;
use cplan_model::Scene;
use cplan_model::space::Configuration;
use cplan_text::{counted, listed};
use std::collections::BTreeSet;

/// Distance of the neighbours of an IK solution that are checked as well, in radians and metres. IK solutions are
/// rounded, so a collision is certain only if the neighbours collide, too.
const NEIGHBOR_DISTANCE: f64 = 1e-9;

/// The reason why a motion is not possible.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refusal {
    /// The reason, in words for the summary.
    pub reason: String,
    /// True if it is proven that the motion is impossible; false if none was found.
    pub proven: bool,
    /// The proof that there is no path. `None` if the reason is another one.
    pub proof: Option<CheckedProof>,
    /// The objects that block the motion.
    pub blockers: Blockers,
}

/// Obstacles that prevent a motion, by their indices in [`Task::obstacles`], in ascending order.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Blockers {
    /// At the end of the motion, the arm or its payload hits all of these.
    AtEnd(Vec<usize>),
    /// Together, these block all paths to the end of the motion.
    OnTheWay(Vec<usize>),
    /// The blocking obstacles are not known.
    Unknown,
}

impl Refusal {
    /// Creates a refusal without a proof by boxes and without known blockers.
    pub fn new(reason: impl Into<String>, proven: bool) -> Self {
        Self { reason: reason.into(), proven, proof: None, blockers: Blockers::Unknown }
    }

    /// Creates a refusal with a proof that there is no path.
    pub fn proven(proof: CheckedProof) -> Self {
        let stuck = proof.collision_boxes();
        let reason = format!(
            "there is no path: colliding configurations separate start and goal (proven, {})",
            counted(stuck.len(), "box")
        );
        let blockers = Blockers::OnTheWay(distinct(stuck.iter().map(|stuck| stuck.pair.obstacle)));
        Self { proof: Some(proof), blockers, ..Self::new(reason, true) }
    }
}

fn distinct(numbers: impl Iterator<Item = usize>) -> Vec<usize> {
    numbers.collect::<BTreeSet<_>>().into_iter().collect()
}

/// Refuses a configuration with collisions. `when` is a phrase for the message: when the arm is there.
pub(super) fn require_unobstructed(scene: &Scene, q: Configuration, when: &str) -> Result<(), Refusal> {
    let hits = scene.obstructions(q);
    if hits.is_empty() {
        return Ok(());
    }
    let words: Vec<String> = hits.iter().map(|hit| scene.explain(hit)).collect();
    let blockers = Blockers::AtEnd(distinct(hits.iter().map(|hit| hit.contact.pair.obstacle)));
    let certain = scene.inner();
    let beside = [
        [0.0, 0.0],
        [NEIGHBOR_DISTANCE, 0.0],
        [-NEIGHBOR_DISTANCE, 0.0],
        [0.0, NEIGHBOR_DISTANCE],
        [0.0, -NEIGHBOR_DISTANCE],
    ];
    let is_proven = beside.iter().all(|&by| !certain.obstructions(q + Configuration::from(by)).is_empty());
    Err(Refusal { blockers, ..Refusal::new(format!("{when}, {}", listed(&words)), is_proven) })
}
