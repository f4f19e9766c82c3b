//! The query of an explanation. Its start and goal may be blocked.

use super::{LoadedScene, Overrides};
use cplan_model::space::Configuration;
use cplan_model::{Goal, Scene};
use cplan_robot::{DiagnosticKind, InputError, RobotReport};

/// Scene, start and goals, and how they were read.
#[derive(Debug, Clone)]
pub struct LoadedEnds {
    /// The arm among its obstacles.
    pub scene: Scene,
    /// The start, which may be blocked.
    pub start: Configuration,
    /// The alternative goals, which may be out of reach.
    pub goals: Vec<Goal>,
    /// Report on how the robot was read.
    pub robot: RobotReport,
    /// Notes for the user about the world.
    pub notes: Vec<String>,
}

impl LoadedScene {
    /// Reads start and goal for this scene as [`LoadedScene::problem`] does, but checks neither limits nor obstacles.
    ///
    /// # Errors
    /// A world with steps, a missing start or goal, and a start given by the tip that does not have exactly one IK
    /// solution.
    pub fn query(self, overrides: &Overrides) -> Result<LoadedEnds, InputError> {
        if self.is_task() {
            return Err(self.has_no_goal(overrides).into());
        }
        let loaded = self.with_clearance(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, _) = loaded.start(overrides, &mut notes)?;
        let (mut goals, _) = loaded.goals(overrides).map_err(|error| error.with_kind(DiagnosticKind::Goal))?;
        for goal in &mut goals {
            if let Goal::Joints(q) = goal {
                *q = loaded.at_limits("the goal", *q, &mut notes);
            }
        }
        Ok(LoadedEnds { scene: loaded.scene, start, goals, robot: loaded.robot, notes })
    }
    /// Returns a query whose goal is its start. The world may have steps.
    ///
    /// # Errors
    /// A missing start, and a start given by the tip that does not have exactly one IK solution.
    pub fn start_alone(self, overrides: &Overrides) -> Result<LoadedEnds, InputError> {
        let loaded = self.with_clearance(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, _) = loaded.start(overrides, &mut notes)?;
        Ok(LoadedEnds { scene: loaded.scene, start, goals: vec![Goal::Joints(start)], robot: loaded.robot, notes })
    }
}
