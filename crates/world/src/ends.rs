//! Where a motion is to begin and to end, if that is said anywhere.

use super::{LoadedScene, Overrides};
use cplan_core::model::Goal;
use cplan_robot::InputError;

impl LoadedScene {
    /// Start and goals, any of which will do: the command line's, else the world file's, else none. Whether they are free and within the limits is not
    /// looked at: a motion that begins or ends there shows it.
    ///
    /// # Errors
    /// Values on the command line that are none for these joints.
    pub fn ends(&self, overrides: &Overrides) -> Result<(Option<Goal>, Vec<Goal>), InputError> {
        let joints = &self.scene.arm().joints;
        let start = match &overrides.start {
            Some(values) => Some(Goal::Joints(values.resolve(joints, "--start")?)),
            None => self.world.start.as_ref().map(|(start, _)| *start),
        };
        let goal = match (&overrides.goal, &overrides.goal_tip) {
            (Some(values), _) => vec![Goal::Joints(values.resolve(joints, "--goal")?)],
            (None, Some(tip)) => vec![Goal::Tip(tip.0)],
            (None, None) => self.world.goals.as_ref().map_or_else(Vec::new, |(goals, _)| goals.clone()),
        };
        Ok((start, goal))
    }
}
