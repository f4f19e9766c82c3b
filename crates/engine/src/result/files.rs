//! The result in the formats of files.

use super::Messages;
use crate::plan::{Detail, Plan, named};
use cplan_motion::{Format, JointMotion, Trajectory, csv, ros_yaml};
#[cfg(feature = "mcap")]
use cplan_motion::{Stage, mcap};

impl Plan {
    /// Returns the result as a file in this format holds it; none if the format holds nothing but a trajectory and there is none. All but
    /// MCAP are text in UTF-8.
    ///
    /// Tables of tasks have a column with the number of each sample's step among those that are done, from 1. ROS 2 messages hold the
    /// motion as one, recordings, which show nothing here (see `PlanOutput::bytes` of the crate `view`), a message for each step: its motion, and the turns of the wrist and strokes of the tool after it.
    #[must_use]
    pub fn encoded(&self, format: Format) -> Option<Vec<u8>> {
        Some(match format {
            Format::Json => self.to_json().into_bytes(),
            Format::Csv => {
                let motion = self.task().and_then(|(_, answer)| answer.outcome.found());
                let steps: Option<Vec<usize>> =
                    motion.map(|motion| motion.sequence.steps().into_iter().map(|step| step + 1).collect());
                self.table(self.trajectory()?, steps.as_deref()).into_bytes()
            }
            Format::Yaml => ros_yaml(&self.messages()?.whole).into_bytes(),
            #[cfg(feature = "mcap")]
            Format::Mcap => self.recording(None)?,
        })
    }

    /// Returns the result as a recording, with what there is to see if that is given.
    #[cfg(feature = "mcap")]
    #[must_use]
    pub fn recording(&self, stage: Option<&Stage>) -> Option<Vec<u8>> {
        let steps = self.messages()?.steps;
        Some(mcap(&steps.iter().map(|(begin, motion)| (motion, *begin)).collect::<Vec<_>>(), stage))
    }

    /// Returns the same for the motion of each step of a task alone, on a clock of its own and without standing still. None of a single
    /// motion, and if that format is not for single trajectories.
    #[must_use]
    pub fn encoded_per_step(&self, format: Format) -> Option<Vec<Vec<u8>>> {
        let (_, answer) = self.task()?;
        let text: Vec<String> = match format {
            Format::Csv => {
                let motions = answer.legs.iter().map(|leg| &leg.timed.trajectory).zip(1..);
                motions.map(|(motion, number)| self.table(motion, Some(&vec![number; motion.time.len()]))).collect()
            }
            Format::Yaml => self.messages()?.steps.iter().map(|(_, motion)| ros_yaml(motion)).collect(),
            _ => return None,
        };
        Some(text.into_iter().map(String::into_bytes).collect())
    }

    /// A motion as a table; `steps` has the number of each sample's step.
    fn table(&self, motion: &Trajectory, steps: Option<&[usize]>) -> String {
        let joints = self.arm().joints.each_ref().map(|joint| joint.name.clone());
        csv(&joints, motion, self.options().accelerations, steps)
    }

    /// What messages hold; a single motion is one step.
    fn messages(&self) -> Option<Messages> {
        let robot = named(self.problem(), self.options());
        let messages = match self.detail() {
            Detail::Motion { answer, .. } => {
                let whole = JointMotion::new(&robot, &answer.outcome.found()?.timed.trajectory, true);
                Messages { steps: vec![(0.0, whole.clone())], whole }
            }
            // Planning has refused what messages cannot name.
            Detail::Task { task, answer } => {
                Messages::new(&robot, task, &answer.legs, &answer.outcome.found()?.sequence).ok()?
            }
        };
        Some(if self.options().accelerations { messages } else { messages.without_accelerations() })
    }
}
