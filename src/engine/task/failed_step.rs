//! The step of a task that fails, in its result.

use super::impossible::{Impossible, Unreached};
use super::step_report::ActionName;
use crate::check::CheckedProof;
use crate::model::Task;
use serde::Serialize;

/// A posture at a step's target that the arm cannot take, or is not known to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PostureReport {
    /// The values of both joints, radians or metres.
    pub joints: [f64; 2],
    /// Why the arm cannot take it, in words.
    pub reason: String,
    /// Boxes of colliding configurations that separate it from where the arm stands, where that is the reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<CheckedProof>,
}

impl From<&Unreached> for PostureReport {
    fn from(Unreached { posture, reason, proof }: &Unreached) -> Self {
        Self { joints: [posture[0], posture[1]], reason: reason.clone(), proof: proof.clone() }
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
    /// The postures that were tried from there; none if no posture within the joint limits reaches the target.
    pub postures: Vec<PostureReport>,
}

impl FailedStep {
    pub(super) fn new(task: &Task, why: &Impossible) -> Self {
        let Impossible { step, reasons, scene, from, postures } = why;
        Self {
            step: step.number,
            cycle: step.cycle,
            action: (&step.action).into(),
            description: step.action.describe(&task.objects),
            place: step.place.clone(),
            reasons: reasons.clone(),
            carried: scene.payload().map(|payload| payload.object.clone()),
            from: [from[0], from[1]],
            postures: postures.iter().map(PostureReport::from).collect(),
        }
    }
}
