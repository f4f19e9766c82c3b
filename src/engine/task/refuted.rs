//! The proof that a task cannot be done, for a certificate: step by step, from all IK solutions at the target of the step before.

use super::state::State;
use crate::check::StuckBox;
use crate::geometry::Point;
use crate::model::{Action, Grip, Holding, Item, Scene, Step, Task};
use crate::space::Configuration;
use std::sync::Arc;

/// A case of a step: where the arm is before it, and what rules out that it comes from there to where the step ends; nothing where that is
/// not ruled out.
pub struct RefutedCase {
    /// The step's number in the world file.
    pub step: usize,
    /// None at the start.
    pub from: Option<Configuration>,
    /// What is where.
    pub scene: Scene,
    /// Configurations that are not free.
    pub stuck: Vec<StuckBox>,
}

/// States beyond these are not looked at for one step.
const MOST_STATES: usize = 64;

/// What rules out all ways to do the steps up to the one of a number, by what rules out motions from one configuration to another; none where
/// that is not known, or not of the kind that the checker knows. Groups in any order, turns of a wrist and IK solutions that leave
/// a joint free are not.
pub(in crate::engine) fn refuted(
    task: &Task,
    last: usize,
    mut rule_out: impl FnMut(&Scene, [Configuration; 2]) -> Option<Vec<StuckBox>>,
) -> Option<Vec<RefutedCase>> {
    // As a rule it is enough that the last cannot be done from anywhere.
    [last, 0].into_iter().find_map(|first| Walk { task, first, last }.cases(&mut rule_out))
}

/// A walk over the steps, as they are done the first time.
struct Walk<'a> {
    task: &'a Task,
    /// The first step of which it is looked what rules it out.
    first: usize,
    last: usize,
}

impl Walk<'_> {
    fn cases(
        &self,
        rule_out: &mut impl FnMut(&Scene, [Configuration; 2]) -> Option<Vec<StuckBox>>,
    ) -> Option<Vec<RefutedCase>> {
        let task = self.task;
        let mut cases = Vec::new();
        let mut states = vec![State::at_start(task)];
        let mut is_start = true;
        // The step before.
        let mut before: Option<&Step> = None;
        for item in &task.items {
            let step = match item {
                Item::Step(step) => step,
                Item::Renew(_) => continue,
                Item::AnyOrder(_) => return None,
            };
            let taken = before.and_then(|before| match before.action {
                Action::Pick { grasp, .. } => Some(grasp),
                _ => None,
            });
            let is_new = cases.iter().all(|case: &RefutedCase| case.step != step.number);
            let is_looked_at = is_new && step.number >= self.first;
            let (mut next, mut own): (Vec<State>, Vec<RefutedCase>) = (Vec::new(), Vec::new());
            for state in &states {
                let [candidates] = &state.candidates(task)[..] else { return None };
                if !candidates.all {
                    return None;
                }
                let from = (!is_start).then_some(state.q);
                let scene = self.scene(state, step, taken.is_some());
                let mut case = RefutedCase { step: step.number, from, scene, stuck: Vec::new() };
                for way in &candidates.ways {
                    match is_looked_at.then(|| rule_out(&case.scene, [state.q, way.to])).flatten() {
                        Some(stuck) => case.stuck.extend(stuck),
                        None => next.push(as_known(state.after(task, way, way.to), step, task)),
                    }
                }
                own.push(case);
            }
            // Where what turns with the arm is let go of depends on where it was taken.
            let is_open = matches!(step.action, Action::Place { angle: None, .. })
                && taken.is_some_and(|grasp| grasp != Point::origin());
            let is_asked = is_open && is_new && step.number + 1 >= self.first;
            if own.iter().any(|case| !case.stuck.is_empty()) || next.is_empty() || is_asked {
                cases.append(&mut own);
            }
            if next.is_empty() {
                return Some(cases);
            }
            if step.number == self.last {
                return None;
            }
            next.sort_by_key(|state| state.key(task));
            next.dedup_by_key(|state| state.key(task));
            if next.len() > MOST_STATES {
                return None;
            }
            (states, is_start) = (next, false);
            before = Some(step);
        }
        None
    }

    /// What is where while a step is done, as far as a checker knows.
    fn scene(&self, state: &State, step: &Step, is_just_taken: bool) -> Scene {
        let is_known = |grip: Grip| match grip {
            Grip::Rigid(_) => is_just_taken,
            Grip::Level { .. } => self.task.wrist.is_none(),
        };
        let held = state.held.clone().filter(|held| is_known(held.grip));
        State { held, ..state.clone() }.scene(self.task, step.action.picked())
    }
}

/// Without an object of which it depends on how the steps were done how it lies.
fn as_known(mut state: State, step: &Step, task: &Task) -> State {
    if let (Action::Place { angle: None, .. }, Some(object)) = (&step.action, state.released) {
        let keeps = task.wrist.is_none() && task.objects[object].holding == Holding::Level;
        if !keeps {
            Arc::make_mut(&mut state.poses)[object] = None;
        }
    }
    state
}
