//! Picks and places of groups, each judged alone: its object at its place among the static obstacles, and the arm there
//! in each IK solution. A step that fails there fails in every order, so no order needs to be searched.
//!
//! As in a [`super::part`], the objects that steps move are omitted, except the one that is picked or placed. Only the
//! ends of motions are judged, no paths. So this takes about a millisecond per step.

use super::failed_step::{RefusedStep, farthest};
use super::ik_solutions::unreachable;
use super::plan::Found;
use super::refusal::{Refusal, require_unobstructed};
use super::state::{Candidate, Candidates, State};
use super::stroke::stroke;
use cplan_handling::{Action, Item, Step, Task};
use cplan_legs::FailedStep;
use cplan_model::{Outcome, Shape};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Returns the answer that a task is infeasible, if a pick or a place of its groups is proven to be impossible alone.
pub(super) fn impossible(task: &Task) -> Option<Found> {
    let moved: BTreeSet<usize> = task.steps().filter_map(|step| step.action.picked()).collect();
    let mut alone = task.clone();
    for object in &moved {
        (alone.objects[*object].shape, alone.objects[*object].pieces) = (Shape::Pieces, Vec::new());
    }
    // An object that is picked again may be at another place then.
    let mut picked = BTreeSet::new();
    task.items.iter().find_map(|item| {
        let Item::AnyOrder(pairs) = item else {
            if let Item::Step(step) = item {
                picked.extend(step.action.picked());
            }
            return None;
        };
        pairs.iter().find_map(|[pick, place]| {
            let object = pick.action.picked().filter(|object| picked.insert(*object))?;
            let is_own = |[other, _]: &&[Step; 2]| other.action.picked() == Some(object);
            if pairs.iter().filter(is_own).count() > 1 {
                return None;
            }
            let own = task.objects[object].clone();
            let shapeless = std::mem::replace(&mut alone.objects[object], own);
            // With a further step, the task does not end with the place.
            alone.items = [pick, place, place].map(|step| Item::Step(step.clone())).into();
            let failed = failed_step(&alone);
            alone.objects[object] = shapeless;
            Some(infeasible(failed?, &task.objects[object].name))
        })
    })
}

/// Returns the answer for a step that fails alone.
fn infeasible(mut failed: FailedStep, object: &str) -> Found {
    failed.reasons.push(whatever_the_order(&failed.step, object));
    Found { outcome: Outcome::Infeasible(failed), legs: Vec::new(), exact: true, seconds: f64::INFINITY }
}

/// Describes that a step fails in every order.
pub(super) fn whatever_the_order(step: &Step, object: &str) -> String {
    let done = match step.action {
        Action::Pick { .. } => "picked",
        _ => "placed",
    };
    format!("\"{object}\" cannot be {done} there, in any order, even without the other objects")
}

/// Returns the first of the two steps at the beginning of a task whose end is proven to be impossible, by any motion.
/// `None` without such a proof.
fn failed_step(task: &Task) -> Option<FailedStep> {
    let start = [State::at_start(task)];
    let lifted = match states_after(task, &start) {
        Ok(lifted) => lifted,
        Err(refused) => return explained(task, &start[0], refused?),
    };
    match states_after(task, &lifted) {
        Ok(_) => None,
        Err(refused) => explained(task, &lifted[0], refused?),
    }
}

/// Returns the states after the next step that are not ruled out, one for each grip.
///
/// # Errors
/// The refused candidates if all of them are proven to be impossible. `None` if none remains, but not all are examined or
/// proven.
fn states_after<'a>(task: &'a Task, states: &[State]) -> Result<Vec<State>, Option<Vec<RefusedStep<'a>>>> {
    let mut next: Vec<State> = Vec::new();
    let (mut refused, mut is_proven) = (Vec::new(), true);
    for state in states {
        for Candidates { step, ways, has_every_ik_solution, .. } in state.candidates(task) {
            is_proven &= has_every_ik_solution;
            let mut refuse = |candidate: Option<Candidate<'a>>, refusal| {
                let ik_solution = candidate.as_ref().map(|candidate| candidate.to);
                refused.push(RefusedStep { depth: 0, node: 0, step, ik_solution, candidate, refusal });
            };
            if ways.is_empty() {
                refuse(None, Refusal::new(unreachable(step), true));
            }
            for candidate in ways {
                match check_target(task, state, &candidate) {
                    Err(refusal) if refusal.proven => refuse(Some(candidate), refusal),
                    Err(_) => is_proven = false,
                    Ok(()) => {
                        let after = state.after_step(task, &candidate, candidate.to);
                        if next.iter().all(|other| other.held != after.held) {
                            next.push(after);
                        }
                    }
                }
            }
        }
    }
    if next.is_empty() { Err(Some(refused).filter(|_| is_proven)) } else { Ok(next) }
}

/// Refuses a candidate if the arm or its object collides at the target. The object may be turned before it arrives, so
/// its orientation counts only with the tool lowered.
fn check_target(task: &Task, from: &State, candidate: &Candidate) -> Result<(), Refusal> {
    if candidate.turn.is_none() {
        require_unobstructed(&from.scene(task, candidate.step.action.picked()), candidate.to, "at its end")?;
    }
    stroke(task, from, candidate).map(|_| ())
}

/// Returns the step whose candidates are all refused, with the reasons. All of them count from `state`, since they hold
/// from anywhere.
fn explained(task: &Task, state: &State, refused: Vec<RefusedStep>) -> Option<FailedStep> {
    let scene = |from: &State, step: &Step| Arc::new(from.scene(task, step.action.picked()));
    (!refused.is_empty()).then(|| farthest(task, &refused, |_| Some(state), scene).0)
}
