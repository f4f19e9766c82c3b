//! Scenes in which the arm stands still at an end of its motion.

use super::state::State;
use super::stroke::raising_scene;
use cplan_handling::Task;
use cplan_model::Scene;
use cplan_model::space::Configuration;

/// A configuration at an end of a motion, with the scenes in which the arm stands still there: while its tool is
/// lowered, or after objects have changed their places. The obstacles of all scenes have the numbers that they have
/// during the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Standstill {
    /// The configuration.
    pub at: Configuration,
    /// The scenes. The arm must be free in all of them.
    pub scenes: Vec<StandstillScene>,
}

/// A scene in which the arm stands still.
#[derive(Debug, Clone, PartialEq)]
pub struct StandstillScene {
    /// The time of the scene as a phrase for messages, such as `while the tool is lowered`.
    pub when: &'static str,
    /// The arm with its tool at the heights of this time, among the obstacles of this time.
    pub scene: Scene,
}

impl Standstill {
    /// Returns the index of the first scene in which the arm is not free. `None` if it is free in all of them.
    pub fn blocked_scene(&self) -> Option<usize> {
        self.scenes.iter().position(|standing| !standing.scene.obstructions(self.at).is_empty())
    }
}

/// Returns the standstill at the start of a task while the tool is raised there. `None` if the tool is already raised.
#[must_use]
pub fn raising_at_start(task: &Task) -> Option<Standstill> {
    raising_of(task, &State::at_start(task))
}

/// Returns the standstill before the motion from a state.
pub(super) fn raising_of(task: &Task, from: &State) -> Option<Standstill> {
    raising_scene(task, from).map(|scene| Standstill { at: from.q, scenes: vec![scene] })
}
