//! What became of a task, in the formats of files.

use super::report::TaskReport;
#[cfg(feature = "mcap")]
use crate::motion::mcap;
use crate::motion::{Format, csv_with_steps, ros_yaml};

impl TaskReport {
    /// The result as a file in this format holds it; none if the format holds nothing but a trajectory and there is none.
    ///
    /// Tables have a column with the number of each sample's step among those that are done, from 1. ROS 2 messages hold the
    /// motion as one, recordings a message for each step: its motion, and the turns of the wrist and strokes of the tool after it.
    #[must_use]
    pub fn bytes(&self, format: Format) -> Option<Vec<u8>> {
        Some(match format {
            Format::Json => self.json().into_bytes(),
            Format::Csv => {
                let numbers: Vec<usize> = self.steps_of_samples().iter().map(|step| step + 1).collect();
                csv_with_steps(self.joints(), self.trajectory()?, self.has_accelerations(), &numbers).into_bytes()
            }
            Format::Yaml => ros_yaml(&self.messages()?.0).into_bytes(),
            #[cfg(feature = "mcap")]
            Format::Mcap => {
                let (_, steps) = self.messages()?;
                mcap(&steps.iter().map(|(motion, begin)| (motion, *begin)).collect::<Vec<_>>())
            }
        })
    }

    /// The same for the motion of each step alone, on a clock of its own and without standing still. None if that format is
    /// not for single trajectories.
    #[must_use]
    pub fn bytes_per_step(&self, format: Format) -> Option<Vec<Vec<u8>>> {
        let text = match format {
            Format::Csv => self
                .motions()
                .zip(1..)
                .map(|(motion, number)| {
                    csv_with_steps(self.joints(), motion, self.has_accelerations(), &vec![number; motion.time.len()])
                })
                .collect::<Vec<_>>(),
            Format::Yaml => self.messages()?.1.iter().map(|(motion, _)| ros_yaml(motion)).collect(),
            _ => return None,
        };
        Some(text.into_iter().map(String::into_bytes).collect())
    }
}
