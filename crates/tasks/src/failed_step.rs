//! The step of a task that fails.

use super::legs::Refusal;
use super::state::State;
use cplan_core::check::CheckedProof;
use cplan_core::model::{Arm, Joint, Scene};
use cplan_core::space::Configuration;
use cplan_handling::Step;
use std::sync::Arc;

/// Beginnings of motions beyond these are not named for one reason.
const NAMED: usize = 4;

/// Digits behind the point of joint values in words.
const DIGITS: i32 = 4;

/// An IK solution at the target of a step that the arm cannot take, or is not known to.
#[derive(Debug, Clone, PartialEq)]
pub struct RefusedIkSolution {
    /// The values of both joints.
    pub ik_solution: Configuration,
    /// Why, in words.
    pub reason: String,
    /// That boxes of colliding configurations separate it from where the arm stands, where that is the reason.
    pub proof: Option<CheckedProof>,
}

/// A step that cannot be done, or is not known to be possible; nor can the task in any other order.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedStep {
    /// The first step that cannot be done after as many as possible before it.
    pub step: Step,
    /// Why, in words, with the motions that were tried: also those from other IK solutions, or with other grips, than the
    /// steps before end with in the answer.
    pub reasons: Vec<String>,
    /// The world after the steps before, as it is for the motion that fails, and what is carried.
    pub scene: Arc<Scene>,
    /// Where the arm stands then.
    pub from: Configuration,
    /// The IK solutions that were tried from there; none if no IK solution within the joint limits reaches the target.
    pub ik_solutions: Vec<RefusedIkSolution>,
}

/// A step that could not be done.
pub(super) struct Refused<'a> {
    /// After how many steps.
    pub depth: usize,
    /// The node of the search from which it was tried.
    pub node: usize,
    pub step: &'a Step,
    /// With which IK solution; none if there is none.
    pub ik_solution: Option<Configuration>,
    pub refusal: Refusal,
}

impl Refused<'_> {
    /// The IK solution that is out of reach, if there is one.
    pub fn unreached(&self) -> Option<RefusedIkSolution> {
        let Refusal { reason, proof, .. } = &self.refusal;
        self.ik_solution.map(|ik_solution| RefusedIkSolution {
            ik_solution,
            reason: reason.clone(),
            proof: proof.clone(),
        })
    }
}

/// Why no more can be done where steps are refused: of the places where that is so, the farthest; of these the one reached first. With the node
/// from which it was tried.
pub(super) fn farthest<'s>(
    arm: &Arm,
    refused: &[Refused],
    state: impl Fn(usize) -> Option<&'s State>,
    scene: impl FnOnce(&State, &Step) -> Arc<Scene>,
) -> (FailedStep, usize) {
    let depth = refused.iter().map(|refused| refused.depth).max().unwrap_or(0);
    let farthest = || refused.iter().filter(|refused| refused.depth == depth);
    let Some((first, from)) = farthest().find_map(|refused| Some((refused, state(refused.node)?))) else {
        unreachable!("a search ends at the goal or where steps are refused");
    };
    let (node, step) = (first.node, first.step);
    let same = || farthest().filter(|refused| refused.step.number == step.number);
    let mut tried = Vec::new();
    for refused in same() {
        let Some(State { q, .. }) = state(refused.node) else { continue };
        tried.push(Tried { from: *q, to: refused.ik_solution, reason: &refused.refusal.reason });
    }
    let mut ik_solutions = Vec::new();
    for unreached in same().filter(|refused| refused.node == node).filter_map(Refused::unreached) {
        if !ik_solutions.contains(&unreached) {
            ik_solutions.push(unreached);
        }
    }
    let (reasons, scene) = (reasons(arm, &tried), scene(from, step));
    (FailedStep { step: step.clone(), reasons, scene, from: from.q, ik_solutions }, node)
}

/// A motion that was tried, and why it is refused.
struct Tried<'a> {
    from: Configuration,
    /// None where there is no IK solution at the target.
    to: Option<Configuration>,
    reason: &'a str,
}

/// Each reason once, with the motions that it holds for: `to joints (0.3, 1.2) rad and (1.5, -1.2) rad: ...`. Where they
/// begin is said if not all of them begin at one place.
fn reasons(arm: &Arm, tried: &[Tried]) -> Vec<String> {
    let several = tried.iter().any(|motion| motion.from != tried[0].from);
    let mut reasons: Vec<&str> = Vec::new();
    for motion in tried {
        if !reasons.contains(&motion.reason) {
            reasons.push(motion.reason);
        }
    }
    let explained = |reason: &str| {
        let mut motions: Vec<(Configuration, Vec<String>)> = Vec::new();
        for Tried { from, to, .. } in tried.iter().filter(|motion| motion.reason == reason) {
            let Some(to) = to.map(|to| joints(arm, to)) else { continue };
            match motions.iter_mut().find(|(known, _)| known == from) {
                Some((_, ends)) if ends.contains(&to) => {}
                Some((_, ends)) => ends.push(to),
                None => motions.push((*from, vec![to])),
            }
        }
        let others = motions.len().saturating_sub(NAMED);
        motions.truncate(NAMED);
        let words = motions.iter().map(|(from, ends)| {
            let beginning =
                if several { format!("from joints {} to ", joints(arm, *from)) } else { "to joints ".into() };
            beginning + &ends.join(" and ")
        });
        let mut words = words.collect::<Vec<_>>().join(", ");
        if others > 0 {
            words += &format!(", and from {others} others");
        }
        if words.is_empty() { reason.to_owned() } else { format!("{words}: {reason}") }
    };
    reasons.into_iter().map(explained).collect()
}

/// Joint values in words: `(0.3, 1.2) rad`, `(0.3 m, 1.2 rad)`.
fn joints(arm: &Arm, q: Configuration) -> String {
    let grains = 10_f64.powi(DIGITS);
    // Zero has no sign in words.
    let [a, b] = [0, 1].map(|k| (q[k] * grains).round() / grains + 0.0);
    match arm.joints.each_ref().map(Joint::unit) {
        [first, second] if first == second => format!("({a}, {b}) {first}"),
        [first, second] => format!("({a} {first}, {b} {second})"),
    }
}
