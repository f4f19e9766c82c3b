//! The step of a task that fails.

use super::motion_cache::scene_after;
use super::refusal::Refusal;
use super::standstill::raising_of;
use super::state::{Candidate, State};
use super::stroke::stroke_scene;
use cplan_handling::{Step, Task};
use cplan_legs::{FailedStep, RefusedIkSolution, Standstill};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Joint, Scene};
use std::sync::Arc;

/// Largest number of start configurations that a reason names.
const MAX_NAMED_STARTS: usize = 4;

/// Number of decimals of joint values in messages.
const DECIMALS: i32 = 4;

/// A step that could not be done after some node of the search.
pub(super) struct RefusedStep<'a> {
    /// Number of steps that were done before it.
    pub depth: usize,
    /// The node of the search at which the step was tried.
    pub node: usize,
    pub step: &'a Step,
    /// The IK solution that was tried. `None` if the target has none.
    pub ik_solution: Option<Configuration>,
    /// The candidate of that IK solution, if its obstacles do not move.
    pub candidate: Option<Candidate<'a>>,
    pub refusal: Refusal,
}

impl RefusedStep<'_> {
    /// Returns the IK solution that cannot be reached. `None` if the target has none.
    pub fn unreached(&self) -> Option<RefusedIkSolution> {
        let Refusal { reason, proof, .. } = &self.refusal;
        self.ik_solution.map(|ik_solution| RefusedIkSolution {
            ik_solution,
            reason: reason.clone(),
            proof: proof.clone(),
        })
    }
}

/// Explains why the search got no farther. It considers the refused steps that have the most steps before them, and of
/// these the node that was reached first. Also returns that node.
pub(super) fn farthest<'s>(
    task: &Task,
    refused: &[RefusedStep],
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
        tried.push(TriedMotion { from: *q, to: refused.ik_solution, reason: &refused.refusal.reason });
    }
    let mut ik_solutions = Vec::new();
    for unreached in same().filter(|refused| refused.node == node).filter_map(RefusedStep::unreached) {
        if !ik_solutions.contains(&unreached) {
            ik_solutions.push(unreached);
        }
    }
    let standstills = standstills(task, from, same().filter(|refused| refused.node == node));
    let (reasons, scene) = (reasons(&task.arm, &tried), scene(from, step));
    let (step, moving, from) = (step.clone(), from.moving.clone(), from.q);
    (FailedStep { step, reasons, scene, moving, from, ik_solutions, standstills }, node)
}

/// Returns the standstills before and after the motions that were tried from a state.
fn standstills<'a>(
    task: &Task,
    from: &State,
    tried: impl Iterator<Item = &'a RefusedStep<'a>>,
) -> [Vec<Standstill>; 2] {
    let at_goal = |candidate: Candidate| {
        let scenes = [scene_after(task, from, &candidate), stroke_scene(task, from, &candidate)];
        Standstill { at: candidate.to, scenes: scenes.into_iter().flatten().collect() }
    };
    let goals = tried.filter_map(|refused| refused.candidate).map(at_goal);
    [raising_of(task, from).into_iter().collect(), goals.collect()]
}

/// A motion that was tried, and the reason why it was refused.
struct TriedMotion<'a> {
    from: Configuration,
    /// The IK solution. `None` if the target has none.
    to: Option<Configuration>,
    reason: &'a str,
}

/// Returns each reason once, with the motions for which it holds: `to joints (0.3, 1.2) rad and (1.5, -1.2) rad: ...`.
/// Names the start configurations if there are several.
fn reasons(arm: &Arm, tried: &[TriedMotion]) -> Vec<String> {
    let several = tried.iter().any(|motion| motion.from != tried[0].from);
    let mut reasons: Vec<&str> = Vec::new();
    for motion in tried {
        if !reasons.contains(&motion.reason) {
            reasons.push(motion.reason);
        }
    }
    let explained = |reason: &str| {
        let mut motions: Vec<(Configuration, Vec<String>)> = Vec::new();
        for TriedMotion { from, to, .. } in tried.iter().filter(|motion| motion.reason == reason) {
            let Some(to) = to.map(|to| joints(arm, to)) else { continue };
            match motions.iter_mut().find(|(known, _)| known == from) {
                Some((_, ends)) if ends.contains(&to) => {}
                Some((_, ends)) => ends.push(to),
                None => motions.push((*from, vec![to])),
            }
        }
        let others = motions.len().saturating_sub(MAX_NAMED_STARTS);
        motions.truncate(MAX_NAMED_STARTS);
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

/// Formats joint values: `(0.3, 1.2) rad`, `(0.3 m, 1.2 rad)`.
fn joints(arm: &Arm, q: Configuration) -> String {
    let grains = 10_f64.powi(DECIMALS);
    // Without -0, which rounding may produce.
    let [a, b] = [0, 1].map(|k| (q[k] * grains).round() / grains + 0.0);
    match arm.joints.each_ref().map(Joint::unit) {
        [first, second] if first == second => format!("({a}, {b}) {first}"),
        [first, second] => format!("({a} {first}, {b} {second})"),
    }
}
