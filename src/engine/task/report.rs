//! What became of a task, as JSON.

use super::answer::{TaskAnswer, TaskVerdict};
use super::failed_step::FailedStep;
use super::impossible::Impossible;
use super::joints::{MessageError, Messages};
use super::sequence::Sequence;
use super::step_report::{EventReport, StepReport, finite};
use crate::model::Status;
use crate::model::{AssumedLimits, Joint, RobotJoints, Task};
use crate::motion::{JointMotion, SearchUsed, Timed, Trajectory, as_map, interpolation, line_a_field};
use serde::Serialize;
use std::sync::Arc;

/// How good the choice of IK solutions, turns and order is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Choice {
    /// No other is faster with the motions that the planner finds.
    Fastest,
    /// Not all were looked at.
    Good,
}

/// The whole motion with the step that each of its samples belongs to.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct SteppedTrajectory {
    #[serde(flatten)]
    trajectory: Trajectory,
    /// As [`Sequence::steps`] has it.
    step: Vec<usize>,
}

/// The result of planning a task. [`TaskReport::json`] writes the fields in this order. `path`, `length`, `clearance` and
/// `trajectory` are null if not all steps can be done; what is optional is left out when `None` or empty.
///
/// Numbers are finite; radians for a revolute joint and metres for a prismatic one, and seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskReport {
    /// Private, like all that belongs together: it comes from the answer alone.
    status: Status,
    /// Title of the workspace.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Name of the planner of single motions.
    planner: String,
    /// How the wavefront planner searched its grids.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub search: Option<SearchUsed>,
    /// How the cells of the planner's grids were decided, if not by exact slices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub space: Option<&'static str>,
    /// Names of the joints in the URDF, base to tip.
    joints: [String; 2],
    /// Unit of each joint's value: `rad` or `m`.
    units: [&'static str; 2],
    /// Limits that the timing takes for want of given ones.
    #[serde(skip_serializing_if = "AssumedLimits::is_empty")]
    pub assumed: AssumedLimits,
    /// Why not all steps can be done, or are not known to be possible.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// The first step that cannot be done after as many as possible before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    failed: Option<FailedStep>,
    /// Whether all of the continuous motion and all turns were shown free of collision; false if not all steps can be done.
    certified: bool,
    /// Proven lower bound on the distance to obstacles all the time, metres. None if not all steps can be done, and where
    /// nothing can be hit: then it is infinite.
    clearance: Option<f64>,
    /// Seconds from the beginning to the end of the last step.
    #[serde(skip_serializing_if = "Option::is_none")]
    duration: Option<f64>,
    /// No sequence of motions that does all steps, from rest to rest at each, takes less: proven, seconds. None if nothing
    /// does.
    #[serde(skip_serializing_if = "Option::is_none")]
    lower_bound: Option<f64>,
    /// `duration / lower_bound - 1`; none where the bound is 0 and the duration is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    gap: Option<f64>,
    /// How good the choice of IK solutions, turns and order is.
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<Choice>,
    /// Motions that were planned, those that were not needed in the end included.
    motions: usize,
    /// The steps in the order in which they are done: all, or those before the one that fails.
    steps: Vec<StepReport>,
    /// What the gripper does in them.
    events: Vec<EventReport>,
    /// Waypoints of all motions, straight segments between them.
    path: Option<Vec<[f64; 2]>>,
    /// Euclidean length of the path in joint space.
    length: Option<f64>,
    /// Stages in the order in which they ran, with the milliseconds that each took; empty unless asked for, because they
    /// differ from run to run and nothing else in a result does.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "as_map")]
    pub timings: Vec<(String, f64)>,
    /// How to read the trajectory between its samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    interpolation: Option<&'static str>,
    /// The whole motion.
    trajectory: Option<SteppedTrajectory>,
    /// The motions of the steps, for files of their own.
    #[serde(skip)]
    timed: Vec<Arc<Timed>>,
    /// The same as messages have it: at first of the two planned joints.
    #[serde(skip)]
    messages: Option<Messages>,
    /// Whether tables and messages have accelerations.
    #[serde(skip)]
    accelerations: bool,
}

impl TaskReport {
    /// What is to be said of an answer to a task. How a grid was searched and timings are left for the caller to fill.
    #[must_use]
    pub fn new(planner: &str, task: &Task, answer: &TaskAnswer) -> Self {
        let (status, failed) = match &answer.verdict {
            TaskVerdict::Found(()) => (Status::Found, None),
            TaskVerdict::Infeasible(why) => (Status::Infeasible, Some(why)),
            TaskVerdict::Unknown(why) => (Status::Unknown, Some(why)),
        };
        let is_whole = failed.is_none();
        let sequence = Sequence::of(&answer.legs);
        let legs =
            || sequence.iter().flat_map(|sequence| answer.legs.iter().enumerate().map(move |leg| (sequence, leg)));
        let steps: Vec<StepReport> =
            legs().map(|(sequence, (index, leg))| StepReport::new(task, leg, sequence, index, is_whole)).collect();
        let events =
            legs().filter_map(|(sequence, (index, leg))| EventReport::new(task, leg, sequence, index)).collect();
        let duration = sequence.as_ref().map_or(0.0, |sequence| sequence.trajectory.duration());
        // Both are sums of the same times where nothing is in the way, in different order.
        let lower_bound = if is_whole { answer.lower_bound.min(duration) } else { answer.lower_bound };
        let gap = if duration == lower_bound { 0.0 } else { duration / lower_bound - 1.0 };
        let joints: &[Joint; 2] = &task.arm.joints;
        let planned = RobotJoints::planned(&joints.each_ref().map(|joint| joint.name.clone()));
        let messages = sequence.as_ref().filter(|_| is_whole).and_then(|sequence| {
            // Without a wrist there is nothing that could fail.
            Messages::new(&planned, task, &answer.legs, sequence).ok()
        });
        Self {
            status,
            name: Some(task.workspace.name.clone()).filter(|name| !name.is_empty()),
            planner: planner.to_owned(),
            search: None,
            space: None,
            joints: joints.each_ref().map(|joint| joint.name.clone()),
            units: joints.each_ref().map(Joint::unit),
            assumed: AssumedLimits::default(),
            reason: failed.map(|why| reason(task, why, status)),
            failed: failed.map(|why| FailedStep::new(task, why)),
            certified: is_whole,
            clearance: finite(answer.clearance()).filter(|_| is_whole),
            duration: is_whole.then_some(duration),
            lower_bound: finite(lower_bound),
            gap: finite(gap).filter(|_| is_whole),
            choice: is_whole.then_some(if answer.exact { Choice::Fastest } else { Choice::Good }),
            motions: answer.motions,
            path: is_whole.then(|| concatenated(&steps)),
            length: is_whole.then(|| steps.iter().map(|step| step.length).sum()),
            steps,
            events,
            timings: Vec::new(),
            interpolation: is_whole.then(|| interpolation(joints)),
            trajectory: sequence
                .filter(|_| is_whole)
                .map(|sequence| SteppedTrajectory { step: sequence.steps(), trajectory: sequence.trajectory }),
            timed: answer.legs.iter().map(|leg| leg.timed.clone()).collect(),
            messages,
            accelerations: false,
        }
    }

    /// Lets messages name these joints, and tables and messages have accelerations or not.
    ///
    /// # Errors
    /// A wrist that cannot keep level what is carried; accelerations that jump, of the arm or of the tool.
    pub fn name_joints(
        &mut self,
        robot: &RobotJoints,
        task: &Task,
        answer: &TaskAnswer,
        accelerations: bool,
    ) -> Result<(), MessageError> {
        self.accelerations = accelerations;
        let (Some(trajectory), Some(sequence)) = (self.trajectory(), Sequence::of(&answer.legs)) else { return Ok(()) };
        let messages = Messages::new(robot, task, &answer.legs, &sequence)?;
        if accelerations {
            trajectory.check_accelerations()?;
            messages.check_accelerations(robot)?;
        }
        self.messages = Some(messages);
        Ok(())
    }

    /// What messages hold of a task that is done: the whole motion, and that of each step with the time at which it begins.
    pub(super) fn messages(&self) -> Option<(JointMotion, Vec<(JointMotion, f64)>)> {
        let Messages { whole, steps } = self.messages.clone()?;
        let of = |motion: JointMotion| if self.accelerations { motion } else { motion.without_accelerations() };
        Some((of(whole), steps.into_iter().map(|(begin, motion)| (of(motion), begin)).collect()))
    }

    /// Whether tables and messages have accelerations.
    #[must_use]
    pub fn has_accelerations(&self) -> bool {
        self.accelerations
    }

    /// How the run ended.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }

    /// Names of the joints in the URDF, base to tip.
    #[must_use]
    pub fn joints(&self) -> &[String; 2] {
        &self.joints
    }

    /// Name of the planner of single motions.
    #[must_use]
    pub fn planner(&self) -> &str {
        &self.planner
    }

    /// Why not all steps can be done, or are not known to be possible.
    #[must_use]
    pub fn reason(&self) -> Option<&str> {
        self.reason.as_deref()
    }

    /// The first step that cannot be done after as many as possible before it.
    #[must_use]
    pub fn failed(&self) -> Option<&FailedStep> {
        self.failed.as_ref()
    }

    /// Seconds that the whole takes, and seconds that nothing undercuts; the latter none if nothing does all steps.
    #[must_use]
    pub fn seconds(&self) -> (Option<f64>, Option<f64>) {
        (self.duration, self.lower_bound)
    }

    /// `duration / lower_bound - 1` of a task that is done, unless the bound is 0.
    #[must_use]
    pub fn gap(&self) -> Option<f64> {
        self.gap
    }

    /// Proven lower bound on the distance to obstacles all the time, metres; none if not all steps can be done, and where
    /// nothing can be hit.
    #[must_use]
    pub fn clearance(&self) -> Option<f64> {
        self.clearance
    }

    /// The steps that are done, in order.
    #[must_use]
    pub fn steps(&self) -> &[StepReport] {
        &self.steps
    }

    /// What the gripper does, in order.
    #[must_use]
    pub fn events(&self) -> &[EventReport] {
        &self.events
    }

    /// The whole motion, if all steps can be done.
    #[must_use]
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.trajectory.as_ref().map(|whole| &whole.trajectory)
    }

    /// The motion of each step, on a clock of its own.
    pub fn motions(&self) -> impl Iterator<Item = &Trajectory> {
        self.timed.iter().map(|timed| &timed.trajectory)
    }

    /// Of each sample of the whole motion, the step that it belongs to, as [`Sequence::steps`] has it.
    #[must_use]
    pub fn steps_of_samples(&self) -> &[usize] {
        self.trajectory.as_ref().map_or(&[], |whole| &whole.step)
    }

    /// The result as a JSON object, a line a field. Numbers have as many digits as it takes to read the same `f64` back.
    #[must_use]
    pub fn json(&self) -> String {
        line_a_field(self)
    }
}

/// Which step fails, in a sentence.
fn reason(task: &Task, Impossible { step, .. }: &Impossible, status: Status) -> String {
    let cycle = if step.cycle > 1 { format!(" of cycle {}", step.cycle) } else { String::new() };
    let which = format!("step {}{cycle}, {} ({})", step.number, step.action.describe(&task.objects), step.place);
    match status {
        Status::Infeasible => format!("proven: {which} cannot be done, nor can the task in any other way"),
        _ => format!("unknown: no way to do {which} was found, and none ruled out"),
    }
}

/// Waypoints of all steps. Each begins where the one before ends.
fn concatenated(steps: &[StepReport]) -> Vec<[f64; 2]> {
    let mut path: Vec<[f64; 2]> = Vec::new();
    for step in steps {
        let shared = usize::from(path.last() == step.path.first());
        path.extend(&step.path[shared..]);
    }
    path
}
