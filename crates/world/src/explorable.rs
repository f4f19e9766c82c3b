//! The input of an exploration: the start, and possibly a goal.

use super::{LoadedScene, Overrides};
use crate::Sensor;
use cplan_model::Scene;
use cplan_model::space::{Configuration, GoalSet};
use cplan_robot::{DiagnosticKind, InputError, RobotReport};

/// A world to explore, and how it was read.
#[derive(Debug, Clone)]
pub struct Explorable {
    /// The true scene.
    pub scene: Scene,
    /// The sensor.
    pub sensor: Sensor,
    /// The start. It is free and within the limits.
    pub start: Configuration,
    /// The goals that are free. `None` if neither the world nor the command line gives a goal.
    pub goals: Option<GoalSet>,
    /// Report on how the robot was read.
    pub robot: RobotReport,
    /// Notes for the user about start and goal.
    pub notes: Vec<String>,
}

impl LoadedScene {
    /// Reads the start, and the goal if one is given, for the exploration of this scene.
    ///
    /// # Errors
    /// The errors of [`LoadedScene::problem`], except that a goal may be missing.
    pub fn explorable(self, overrides: &Overrides) -> Result<Explorable, InputError> {
        self.require_static_obstacles("explorations are for worlds without moving obstacles")?;
        let sensor = self.sensor();
        let has_goal = self.world.goals.is_some() || overrides.goal.is_some() || overrides.goal_tip.is_some();
        if has_goal || self.is_task() {
            let loaded = self.problem(overrides)?;
            let (start, goals) = (loaded.problem.start(), Some(loaded.problem.goals().clone()));
            let scene = loaded.problem.into_scene();
            return Ok(Explorable { scene, sensor, start, goals, robot: loaded.robot, notes: loaded.notes });
        }
        let loaded = self.with_clearance(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, place) = loaded.start(overrides, &mut notes)?;
        loaded.require("the start", start, &place).map_err(|diagnostic| diagnostic.with_kind(DiagnosticKind::Start))?;
        Ok(Explorable { scene: loaded.scene, sensor, start, goals: None, robot: loaded.robot, notes })
    }

    /// Returns the sensor of the world. Properties that the world file does not state are those of [`Sensor::default_for`].
    #[must_use]
    pub fn sensor(&self) -> Sensor {
        let turn = self.world.place.as_ref().map_or(0.0, |place| place.rotation.angle());
        self.world.sensor.completed_by(Sensor { turn, ..Sensor::default_for(self.scene.arm()) })
    }
}
