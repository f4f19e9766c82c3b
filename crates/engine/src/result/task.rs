//! What is said of a task besides what is said of any motion.

use super::{Report, finite};
use crate::task::{EventReport, FailedStep, Impossible, MessageError, Messages, Sequence, StepReport, TaskAnswer};
use cplan_core::model::Status;
use cplan_handling::{RobotJoints, Task};
use cplan_motion::Timed;
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

/// What is said of a task alone.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskFigures {
    /// The first step that cannot be done after as many as possible before it.
    pub failed: Option<FailedStep>,
    /// No sequence of motions that does all steps, from rest to rest at each, takes less: proven, seconds. None if nothing
    /// does.
    pub lower_bound: Option<f64>,
    /// `duration / lower_bound - 1`; none where the bound is 0 and the duration is not.
    pub gap: Option<f64>,
    /// How good the choice of IK solutions, turns and order is.
    pub choice: Option<Choice>,
    /// Motions that were planned, those that were not needed in the end included.
    pub motions: usize,
    /// The steps in the order in which they are done: all, or those before the one that fails.
    pub steps: Vec<StepReport>,
    /// What the gripper does in them.
    pub events: Vec<EventReport>,
    /// Of each sample of the whole motion, the step that it belongs to, as [`Sequence::steps`] has it.
    pub step_of_sample: Vec<usize>,
    /// The motions of the steps, for files of their own.
    pub(super) timed: Vec<Arc<Timed>>,
    /// What messages hold, where all steps can be done.
    pub(super) messages: Option<Messages>,
}

impl Report {
    /// What is to be said of an answer to a task. Messages name the two planned joints. How a grid was searched and timings are left
    /// for the caller to fill.
    #[must_use]
    pub fn of_task(planner: &str, task: &Task, answer: &TaskAnswer) -> Self {
        let joints = &task.arm.joints;
        let failed = answer.impossible();
        let status = answer.verdict.status();
        let sequence = Sequence::of(&answer.legs);
        let legs =
            || sequence.iter().flat_map(|sequence| answer.legs.iter().enumerate().map(move |leg| (sequence, leg)));
        let steps: Vec<StepReport> = legs()
            .map(|(sequence, (index, leg))| StepReport::new(task, leg, sequence, index, failed.is_none()))
            .collect();
        let events =
            legs().filter_map(|(sequence, (index, leg))| EventReport::new(task, leg, sequence, index)).collect();
        let duration = sequence.as_ref().map_or(0.0, |sequence| sequence.trajectory.duration());
        // Both are sums of the same times where nothing is in the way, in different order.
        let lower_bound = if failed.is_none() { answer.lower_bound.min(duration) } else { answer.lower_bound };
        let gap = if duration == lower_bound { 0.0 } else { duration / lower_bound - 1.0 };
        let mut figures = TaskFigures {
            failed: failed.map(|why| FailedStep::new(task, why)),
            lower_bound: finite(lower_bound),
            gap: None,
            choice: None,
            motions: answer.motions,
            steps,
            events,
            step_of_sample: Vec::new(),
            timed: answer.legs.iter().map(|leg| leg.timed.clone()).collect(),
            messages: None,
        };
        let mut report = match sequence.filter(|_| failed.is_none()) {
            Some(sequence) => {
                figures.gap = finite(gap);
                figures.choice = Some(if answer.exact { Choice::Fastest } else { Choice::Good });
                figures.step_of_sample = sequence.steps();
                Self {
                    path: Some(concatenated(&figures.steps)),
                    length: Some(figures.steps.iter().map(|step| step.length).sum()),
                    clearance: finite(answer.clearance()),
                    moving: answer.timing.clone(),
                    ..Self::moving(planner, joints, sequence.trajectory)
                }
            }
            None => Self::bare(status, planner, joints),
        };
        report.reason = failed.map(|why| reason(task, why, status));
        report.name = Some(task.workspace.name.clone()).filter(|name| !name.is_empty());
        report.task = Some(Box::new(figures));
        let planned = RobotJoints::planned(&report.joints);
        // Without a wrist there is nothing that could fail.
        let _ = report.name_all(&planned, task, answer, false);
        report
    }

    /// As [`Report::name_joints`], with the strokes of the tool and the turns of the wrist.
    ///
    /// # Errors
    /// A wrist that cannot keep level what is carried; accelerations that jump, of the arm or of the tool.
    pub fn name_all(
        &mut self,
        robot: &RobotJoints,
        task: &Task,
        answer: &TaskAnswer,
        accelerations: bool,
    ) -> Result<(), MessageError> {
        if let (Some(figures), Some(_), Some(sequence)) = (&mut self.task, &self.trajectory, Sequence::of(&answer.legs))
        {
            figures.messages = Some(Messages::new(robot, task, &answer.legs, &sequence)?);
        }
        self.name_joints(robot, accelerations)
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
