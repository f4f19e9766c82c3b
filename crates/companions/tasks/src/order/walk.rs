//! Tries the steps of a fixed order without planning motions.

use super::super::least_time::least_time;
use super::super::motion_cache::MotionCache;
use super::super::refusal::Refusal;
use super::super::state::State;
use cplan_geometry::OrderedF64;
use cplan_handling::Task;
use cplan_interrupt::checkpoint;
use std::collections::BTreeMap;

/// Largest number of states after a step that are kept, the earliest first. It suffices for all states with level
/// payloads, because their places do not depend on IK solutions.
const MAX_STATES: usize = 8;

/// States after the same steps, each with a lower bound in seconds on the time at which it is reached. Never empty.
pub(super) type Layer = Vec<(f64, State)>;

/// An item that cannot be done after those before it.
pub(super) struct Failure {
    pub item: usize,
    /// The reasons, for each state before the item and each IK solution.
    pub refusals: Vec<Refusal>,
}

/// Checks all items of a task without free groups, one after the other. Uses only inexpensive checks.
///
/// # Errors
/// The first item that cannot be done.
pub(super) fn walk(task: &Task, legs: &mut MotionCache) -> Result<(), Failure> {
    let mut layer = vec![(0.0, State::at_start(task))];
    while !layer[0].1.is_done(task) {
        let item = layer[0].1.progress.item;
        layer = advance(task, legs, &layer).map_err(|refusals| Failure { item, refusals })?;
    }
    Ok(())
}

/// Returns the states after the next step.
///
/// # Errors
/// The reasons, if there are no such states.
pub(super) fn advance(task: &Task, legs: &mut MotionCache, layer: &Layer) -> Result<Layer, Vec<Refusal>> {
    // The states by their keys, so that each state occurs once.
    let mut next: BTreeMap<Vec<i64>, (f64, State)> = BTreeMap::new();
    let mut refusals = Vec::new();
    for (seconds, state) in layer {
        checkpoint();
        for candidate in state.candidates(task).into_iter().flat_map(|candidates| candidates.ways) {
            let after = state.after(task, &candidate, candidate.to);
            let seconds = seconds + least_time(&task.arm, state.q, candidate.to, candidate.step.speed);
            let key = after.key(task);
            if next.get(&key).is_some_and(|(known, _)| *known <= seconds) {
                continue;
            }
            match legs.check_candidate(task, state, &candidate) {
                Ok(()) => {
                    next.insert(key, (seconds, after));
                }
                Err(refusal) => refusals.push(refusal),
            }
        }
    }
    if next.is_empty() {
        return Err(refusals);
    }
    let mut layer: Layer = next.into_values().collect();
    layer.sort_by_key(|(seconds, _)| OrderedF64(*seconds));
    layer.truncate(MAX_STATES);
    Ok(layer)
}
