//! What an exploration is of: the start, and a goal if there is one.

use super::{LoadedScene, Overrides};
use crate::Sensor;
use cplan_core::model::Scene;
use cplan_core::space::{Configuration, GoalSet};
use cplan_robot::{DiagnosticKind, InputError, RobotReport};

/// A world to explore and how it was read.
#[derive(Debug, Clone)]
pub struct Explorable {
    /// What is really there.
    pub scene: Scene,
    /// What sees it.
    pub sensor: Sensor,
    /// Where the arm begins: within the limits and free.
    pub start: Configuration,
    /// Where it is to go, if the world or the command line says so: free.
    pub goals: Option<GoalSet>,
    /// How the robot was read.
    pub robot: RobotReport,
    /// What the user should know of start and goal.
    pub notes: Vec<String>,
}

impl LoadedScene {
    /// Puts the start into the scene, and a goal if one is given.
    ///
    /// # Errors
    /// As [`LoadedScene::problem`], but that there need not be a goal.
    pub fn explorable(self, overrides: &Overrides) -> Result<Explorable, InputError> {
        self.require_standing("a world is explored as it stands")?;
        let sensor = self.sensor();
        let has_goal = self.world.goals.is_some() || overrides.goal.is_some() || overrides.goal_tip.is_some();
        if has_goal || self.has_steps() {
            let loaded = self.problem(overrides)?;
            let (start, goals) = (loaded.problem.start(), Some(loaded.problem.goals().clone()));
            let scene = loaded.problem.into_scene();
            return Ok(Explorable { scene, sensor, start, goals, robot: loaded.robot, notes: loaded.notes });
        }
        let loaded = self.keeping(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, place) = loaded.start(overrides, &mut notes)?;
        loaded.require("the start", start, &place).map_err(|diagnostic| diagnostic.about(DiagnosticKind::Start))?;
        Ok(Explorable { scene: loaded.scene, sensor, start, goals: None, robot: loaded.robot, notes })
    }
}
