//! The step of a task that fails, in its result.

use super::impossible::{Impossible, Unreached};
use super::step_report::ActionName;
use cplan_core::check::CheckedProof;
use cplan_handling::Task;
use serde::Serialize;

/// An IK solution at a step's target that the arm cannot take, or is not known to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IkSolutionReport {
    /// The values of both joints, radians or metres.
    pub joints: [f64; 2],
    /// Why the arm cannot take it, in words.
    pub reason: String,
    /// Boxes of colliding configurations that separate it from where the arm stands, where that is the reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<CheckedProof>,
}

impl From<&Unreached> for IkSolutionReport {
    fn from(Unreached { ik_solution, reason, proof }: &Unreached) -> Self {
        Self { joints: [ik_solution[0], ik_solution[1]], reason: reason.clone(), proof: proof.clone() }
    }
}

/// A step that cannot be done, or is not known to be possible.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailedStep {
    /// Its number in the world file, from 1.
    pub step: usize,
    /// Which repetition of it this is, from 1.
    pub cycle: usize,
    /// What it does, ...
    pub action: ActionName,
    /// ... and the same in a few words.
    pub description: String,
    /// Where it stands in the world file: file, line and column.
    pub place: String,
    /// Why, with the motions that were tried, as [`Impossible::reasons`] has it.
    pub reasons: Vec<String>,
    /// The object that is carried then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<String>,
    /// Joint values after the steps before.
    pub from: [f64; 2],
    /// The IK solutions that were tried from there; none if no IK solution within the joint limits reaches the target.
    #[serde(rename = "postures")]
    pub ik_solutions: Vec<IkSolutionReport>,
}

impl FailedStep {
    /// The first step of a task that cannot be done, and why.
    #[must_use]
    pub fn new(task: &Task, why: &Impossible) -> Self {
        let Impossible { step, reasons, scene, from, ik_solutions } = why;
        Self {
            step: step.number,
            cycle: step.cycle,
            action: (&step.action).into(),
            description: step.action.describe(&task.objects),
            place: step.place.clone(),
            reasons: reasons.clone(),
            carried: scene.payload().map(|payload| payload.object.clone()),
            from: [from[0], from[1]],
            ik_solutions: ik_solutions.iter().map(IkSolutionReport::from).collect(),
        }
    }
}
