//! Going through steps in a fixed order, without planning motions.

use super::super::least_time::least_time;
use super::super::legs::{Legs, Refusal};
use super::super::state::State;
use cplan_geometry::Ordered;
use cplan_handling::Task;
use cplan_interrupt::checkpoint;
use std::collections::BTreeMap;

/// States that are followed at once, those soonest reached: all there are with level payloads, whose places do not depend on
/// IK solutions.
const WIDTH: usize = 8;

/// States of the world after the same steps, with the least seconds to each; never empty.
pub(super) type Layer = Vec<(f64, State)>;

/// The item that cannot be done after those before it.
pub(super) struct Failure {
    pub item: usize,
    /// Why, from each state and with each IK solution.
    pub refusals: Vec<Refusal>,
}

/// Goes through all items of a task without groups in any order, as far as cheap questions tell.
///
/// # Errors
/// The first item that cannot be done.
pub(super) fn walk(task: &Task, legs: &mut Legs) -> Result<(), Failure> {
    let mut layer = vec![(0.0, State::at_start(task))];
    while !layer[0].1.is_done(task) {
        let item = layer[0].1.progress.item;
        layer = advance(task, legs, &layer).map_err(|refusals| Failure { item, refusals })?;
    }
    Ok(())
}

/// The states after the next step.
///
/// # Errors
/// Why there are none.
pub(super) fn advance(task: &Task, legs: &mut Legs, layer: &Layer) -> Result<Layer, Vec<Refusal>> {
    // By what tells states apart, so that each is reached once.
    let mut next: BTreeMap<Vec<i64>, (f64, State)> = BTreeMap::new();
    let mut refusals = Vec::new();
    for (seconds, state) in layer {
        checkpoint();
        for way in state.candidates(task).into_iter().flat_map(|candidates| candidates.ways) {
            let after = state.after(task, &way, way.to);
            let seconds = seconds + least_time(&task.arm, state.q, way.to, way.step.speed);
            let key = after.key(task);
            if next.get(&key).is_some_and(|(known, _)| *known <= seconds) {
                continue;
            }
            match legs.promising(task, state, &way) {
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
    layer.sort_by_key(|(seconds, _)| Ordered(*seconds));
    layer.truncate(WIDTH);
    Ok(layer)
}
