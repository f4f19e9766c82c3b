//! The motion of all joints of the robot, which a result of cplan states in addition to that of the arm's two joints.

use super::document;
use super::other_joints::values;
use super::samples::{Names, misplaced};
use super::{AllJoints, LoadedRecording};
use cplan_handling::RecordedJoints;
use cplan_robot::{InputError, Source};

impl Names<'_> {
    /// Reads the motion of all joints; `None` if the file has none.
    ///
    /// # Errors
    /// A motion without the arm's joints, and samples that are no motion.
    pub(super) fn all_joints(&self, source: &Source) -> Result<Option<AllJoints>, InputError> {
        let Some(samples) = document::all_joints(source)? else { return Ok(None) };
        let Some(arm) = self.of_arm(source)? else { return Ok(None) };
        let is_other = |name: &String| !self.arm.contains(&name.as_str());
        let others = samples.joints.iter().filter(|series| is_other(&series.name)).map(|series| {
            let values = values(series, &arm, &samples).map_err(|error| misplaced(source, &samples, &error))?;
            Ok((series.name.clone(), values))
        });
        let others = others.collect::<Result<_, InputError>>()?;
        let held = self.recording(source, samples).ok().map(|loaded| loaded.held);
        Ok(Some(AllJoints { joints: RecordedJoints { arm, others }, held }))
    }

    /// Reads the motion of all joints like a table with the same columns; `None` if the file has none.
    ///
    /// # Errors
    /// The same as for such a table.
    pub(super) fn whole_motion(&self, source: &Source) -> Result<Option<LoadedRecording>, InputError> {
        let Some(samples) = document::all_joints(source)? else { return Ok(None) };
        Ok(Some(self.recording(source, samples)?))
    }

    fn of_arm(&self, source: &Source) -> Result<Option<cplan_handling::Recording>, InputError> {
        let Some(mut samples) = document::all_joints(source)? else { return Ok(None) };
        samples.joints.retain(|series| self.arm.contains(&series.name.as_str()));
        Ok(Some(self.recording(source, samples)?.recording))
    }
}
