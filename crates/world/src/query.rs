//! The query of an explanation, in which start or goal may be blocked.

use super::{LoadedScene, Overrides};
use cplan_core::model::{Goal, Scene};
use cplan_core::space::Configuration;
use cplan_robot::{DiagnosticKind, InputError, RobotReport};

/// Scene, start and goal, and how they were read.
#[derive(Debug, Clone)]
pub struct LoadedEnds {
    /// The arm among its obstacles.
    pub scene: Scene,
    /// The start, free or not.
    pub start: Configuration,
    /// The alternative goals, reachable or not.
    pub goals: Vec<Goal>,
    /// Report on how the robot was read.
    pub robot: RobotReport,
    /// Notes for the user about the world.
    pub notes: Vec<String>,
}

impl LoadedScene {
    /// Puts start and goal into the scene as [`LoadedScene::problem`] does, but looks neither at limits nor at obstacles.
    ///
    /// # Errors
    /// When the world has steps; when start or goal is missing, or a start of the tip is not reached by just one IK solution.
    pub fn query(self, overrides: &Overrides) -> Result<LoadedEnds, InputError> {
        if self.has_steps() {
            return Err(self.has_no_goal(overrides).into());
        }
        let loaded = self.keeping(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, _) = loaded.start(overrides, &mut notes)?;
        let (mut goals, _) = loaded.goals(overrides).map_err(|error| error.about(DiagnosticKind::Goal))?;
        for goal in &mut goals {
            if let Goal::Joints(q) = goal {
                *q = loaded.at_limits("the goal", *q, &mut notes);
            }
        }
        Ok(LoadedEnds { scene: loaded.scene, start, goals, robot: loaded.robot, notes })
    }
    /// Returns a query that stays at the start, for worlds with steps, too.
    ///
    /// # Errors
    /// When the start is missing, or one of the tip is not reached by just one IK solution.
    pub fn start_alone(self, overrides: &Overrides) -> Result<LoadedEnds, InputError> {
        let loaded = self.keeping(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, _) = loaded.start(overrides, &mut notes)?;
        Ok(LoadedEnds { scene: loaded.scene, start, goals: vec![Goal::Joints(start)], robot: loaded.robot, notes })
    }
}
