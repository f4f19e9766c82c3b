//! The result in the formats of files.

use super::{Report, TaskFigures};
use crate::task::Messages;
use cplan_motion::{Format, JointMotion, Trajectory, csv, ros_yaml};
#[cfg(feature = "mcap")]
use cplan_motion::{Stage, mcap};

impl Report {
    /// The result as a file in this format holds it; none if the format holds nothing but a trajectory and there is none. All but
    /// MCAP are text in UTF-8.
    ///
    /// Tables of tasks have a column with the number of each sample's step among those that are done, from 1. ROS 2 messages hold the
    /// motion as one, recordings, which show nothing here (see `PlanOutput::bytes` of the crate `view`), a message for each step: its motion, and the turns of the wrist and strokes of the tool after it.
    #[must_use]
    pub fn bytes(&self, format: Format) -> Option<Vec<u8>> {
        Some(match format {
            Format::Json => self.json().into_bytes(),
            Format::Csv => {
                let numbers = |task: &TaskFigures| task.step_of_sample.iter().map(|step| step + 1).collect::<Vec<_>>();
                let numbers = self.task.as_deref().map(numbers);
                csv(&self.joints, self.trajectory.as_ref()?, self.accelerations, numbers.as_deref()).into_bytes()
            }
            Format::Yaml => ros_yaml(&self.messages()?.whole).into_bytes(),
            #[cfg(feature = "mcap")]
            Format::Mcap => self.recording(None)?,
        })
    }

    /// The result as a recording, with what there is to see if that is given.
    #[cfg(feature = "mcap")]
    #[must_use]
    pub fn recording(&self, stage: Option<&Stage>) -> Option<Vec<u8>> {
        let steps = self.messages()?.steps;
        Some(mcap(&steps.iter().map(|(begin, motion)| (motion, *begin)).collect::<Vec<_>>(), stage))
    }

    /// The same for the motion of each step of a task alone, on a clock of its own and without standing still. None of a single
    /// motion, and if that format is not for single trajectories.
    #[must_use]
    pub fn bytes_per_step(&self, format: Format) -> Option<Vec<Vec<u8>>> {
        let task = self.task.as_ref()?;
        let text: Vec<String> = match format {
            Format::Csv => {
                let motions = task.timed.iter().map(|timed| &timed.trajectory).zip(1..);
                let table = |(motion, number): (&Trajectory, usize)| {
                    csv(&self.joints, motion, self.accelerations, Some(&vec![number; motion.time.len()]))
                };
                motions.map(table).collect()
            }
            Format::Yaml => self.messages()?.steps.iter().map(|(_, motion)| ros_yaml(motion)).collect(),
            _ => return None,
        };
        Some(text.into_iter().map(String::into_bytes).collect())
    }

    /// What messages hold; a single motion is one step.
    fn messages(&self) -> Option<Messages> {
        let messages = match &self.task {
            Some(task) => task.messages.clone()?,
            None => {
                let whole = JointMotion::new(&self.robot, self.trajectory.as_ref()?, true);
                Messages { steps: vec![(0.0, whole.clone())], whole }
            }
        };
        Some(if self.accelerations { messages } else { messages.without_accelerations() })
    }
}
