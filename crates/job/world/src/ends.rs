//! The start and the goals of a motion, if they are given.

use super::problem::Place;
use super::{LoadedScene, Overrides};
use cplan_model::Goal;
use cplan_robot::InputError;

impl LoadedScene {
    /// Returns the start and the alternative goals. Values on the command line override those of the world file. Start and goals
    /// may be blocked or outside the limits: the check of the recorded motion reports this.
    ///
    /// # Errors
    /// Invalid values on the command line, and a side of the elbow if the arm has no elbow.
    pub fn ends(&self, overrides: &Overrides) -> Result<(Option<Goal>, Vec<Goal>), InputError> {
        let joints = &self.scene.arm().joints;
        let start = match &overrides.start {
            Some(values) => Some(Goal::Joints(values.resolve(joints, "--start")?)),
            None => self.world.start.as_ref().map(|(start, _)| *start),
        };
        let goal = match (&overrides.goal, overrides.tip_goal()) {
            (Some(values), _) => vec![Goal::Joints(values.resolve(joints, "--goal")?)],
            (None, Some(goal)) => {
                self.require_elbow(&goal, &Place::Option("--goal-tip"))?;
                vec![goal]
            }
            (None, None) => {
                let (goals, at) = self.world.goals.clone().unwrap_or_default();
                let place = Place::World(self, at);
                goals.iter().try_for_each(|goal| self.require_elbow(goal, &place))?;
                goals
            }
        };
        Ok((start, goal))
    }
}
