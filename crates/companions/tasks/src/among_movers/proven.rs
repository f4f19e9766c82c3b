//! Proofs without a search in time: steps that cannot be done, and a lower bound on the end of the task.

use super::passing::passages;
use crate::state::State;
use cplan_handling::{Action, Item, Step, Task};
use cplan_legs::FailedStep;
use cplan_model::Outcome;
use cplan_solver::Options;
use std::sync::Arc;

/// Returns the failed step if a moving object is proven never to be within reach while it may be picked.
pub(super) fn failed_pick_out_of_reach(task: &Task, start: &State) -> Option<FailedStep> {
    let mut moving: Vec<usize> = start.moving.to_vec();
    let step = task.steps().find(|step| match &step.action {
        Action::Pick { object, grasp, when, .. } => {
            let is_first = moving.iter().position(|other| other == object).map(|place| moving.remove(place)).is_some();
            is_first && passages(&task.arm, &task.objects[*object], *grasp, when, 0.0).is_empty()
        }
        Action::Place { .. } | Action::Move(_) | Action::Follow(_) => false,
    })?;
    let name = &task.objects[step.action.picked()?].name;
    Some(FailedStep {
        step: step.clone(),
        reasons: vec![format!("\"{name}\" is not within the arm's reach at any time in the window of its pick")],
        scene: Arc::new(start.scene(task, step.action.picked())),
        moving: start.moving.clone(),
        from: start.q,
        ik_solutions: Vec::new(),
        standstills: [Vec::new(), Vec::new()],
    })
}

/// Returns the failed step if the task is proven to be infeasible even without moving obstacles. Returns `None` if
/// moving objects are picked, because then their places are unknown.
pub(super) fn static_failure(task: &Task, options: &Options, progress: &mut dyn FnMut(&str)) -> Option<FailedStep> {
    if task.initially_moving().next().is_some() {
        return None;
    }
    let mut standing = task.clone();
    standing.workspace.movers.clear();
    match crate::plan::plan(&standing, options, progress).outcome {
        Outcome::Infeasible(failed) => Some(failed),
        Outcome::Found(_) | Outcome::Unknown(_) => None,
    }
}

/// Returns a lower bound on the end of the task, in seconds. Each moving object that is picked must first come within
/// reach, one after the other.
pub(super) fn last_passage(task: &Task) -> f64 {
    let mut moving: Vec<usize> = task.initially_moving().collect();
    let mut after = |step: &Step, time: f64| {
        let place = moving.iter().position(|object| step.action.picked() == Some(*object));
        let passage = match &step.action {
            Action::Pick { object, grasp, when, .. } if place.is_some() => {
                passages(&task.arm, &task.objects[*object], *grasp, when, time).first().copied()
            }
            _ => None,
        };
        place.map(|place| moving.remove(place));
        passage.map_or(time, |passage| passage.times[0]) + step.dwell
    };
    task.items.iter().fold(0.0, |time, item| match item {
        Item::Step(step) => after(step, time),
        Item::AnyOrder(pairs) => {
            let each = pairs.iter().map(|[pick, place]| after(pick, time) + place.dwell);
            each.fold(time, f64::max)
        }
        Item::Renew(_) => time,
    })
}
