//! What became of a task, in the formats of files.

use super::answer::{Leg, TaskAnswer};
use super::report::TaskReport;
#[cfg(feature = "mcap")]
use crate::trajectory::mcap;
use crate::trajectory::{Format, csv_with_steps, ros_yaml};

impl TaskReport {
    /// The result as a file in this format holds it; `answer` is what the report was made from. None if the format holds nothing but a
    /// trajectory and there is none.
    ///
    /// Tables have a column with the number of each sample's step among those that are done, from 1. ROS 2 messages hold the
    /// motion as one, recordings a message for the motion of each step.
    #[must_use]
    pub fn bytes(&self, format: Format, answer: &TaskAnswer) -> Option<Vec<u8>> {
        Some(match format {
            Format::Json => self.json().into_bytes(),
            Format::Csv => {
                let numbers: Vec<usize> = self.steps_of_samples().iter().map(|step| step + 1).collect();
                csv_with_steps(self.joints(), self.trajectory()?, &numbers).into_bytes()
            }
            Format::Yaml => ros_yaml(self.joints(), self.trajectory()?).into_bytes(),
            #[cfg(feature = "mcap")]
            Format::Mcap => {
                self.trajectory()?;
                let begins = self.steps().iter().map(|step| step.begin);
                let motions: Vec<_> = answer.legs.iter().map(|leg| &leg.timed.trajectory).zip(begins).collect();
                mcap(self.joints(), &motions)
            }
        })
    }

    /// The same for the motion of one step alone, on a clock of its own and without standing still; `number` is the step's
    /// among those that are done, from 1. None for formats that hold more than one trajectory.
    #[must_use]
    pub fn step_bytes(&self, format: Format, number: usize, leg: &Leg) -> Option<Vec<u8>> {
        let trajectory = &leg.timed.trajectory;
        match format {
            Format::Csv => {
                let numbers = vec![number; trajectory.time.len()];
                Some(csv_with_steps(self.joints(), trajectory, &numbers).into_bytes())
            }
            Format::Yaml => Some(ros_yaml(self.joints(), trajectory).into_bytes()),
            _ => None,
        }
    }
}
