//! The standstill before a motion while the tool is raised.

use super::state::State;
use super::stroke::raising_scene;
use cplan_handling::Task;
use cplan_legs::Standstill;

/// Returns the standstill at the start of a task while the tool is raised there. `None` if the tool is already raised.
pub fn raising_at_start(task: &Task) -> Option<Standstill> {
    raising_of(task, &State::at_start(task))
}

/// Returns the standstill before the motion from a state.
pub(super) fn raising_of(task: &Task, from: &State) -> Option<Standstill> {
    raising_scene(task, from).map(|scene| Standstill { at: from.q, scenes: vec![scene] })
}
