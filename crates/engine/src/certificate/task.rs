//! Evidence for a task: the motion, the part of it that performs each step, and the turns of the wrist with the
//! payload. The positions of all objects then follow from the world.

use super::{NoCertificate, lines};
use crate::result::StepReport;
use cplan_geometry::can_inset_union;
use cplan_handling::{Action, Object, Payload, RecordedStep, Step, Task};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Returns the steps of a planned task as a member of the certificate's JSON. The motion of such a task is part of the
/// result.
pub(super) fn steps(steps: &[StepReport]) -> (&'static str, String) {
    let step = |step: &StepReport| {
        let turn = step.turn.as_ref().map(|turn| turn.to - turn.from);
        done(step.step, [step.first_sample, step.last_sample].map(Option::unwrap_or_default), turn)
    };
    ("steps", lines(&steps.iter().map(step).collect::<Vec<_>>()))
}

/// Returns the steps of a recorded task as a member of the certificate's JSON.
pub(super) fn steps_of_recording(steps: &[RecordedStep]) -> (&'static str, String) {
    let step = |step: &RecordedStep| {
        let knots = [*step.samples.start(), *step.samples.end()];
        done(step.number, knots, step.turn.map(|turn| turn.to - turn.from))
    };
    ("steps", lines(&steps.iter().map(step).collect::<Vec<_>>()))
}

fn done(step: usize, knots: [usize; 2], turn: Option<f64>) -> Value {
    match turn {
        None => json!({ "step": step, "knots": knots }),
        Some(turn) => json!({ "step": step, "knots": knots, "turn": turn }),
    }
}

/// Returns the indices of the objects that rest on supports when a step picks or places them.
fn pressed_objects(task: &Task) -> BTreeSet<usize> {
    let mut picked = None;
    let rests = |step: &Step| {
        picked = step.action.picked().or(picked);
        let (Action::Pick { supports, .. } | Action::Place { supports, .. }) = &step.action else { return None };
        picked.filter(|_| !supports.is_empty())
    };
    task.steps().filter_map(rests).collect()
}

/// Checks that the corners of all objects that rest on supports can be moved inwards, as a checker of the certificate
/// must do.
///
/// # Errors
/// [`NoCertificate::Outline`].
pub(super) fn checkable(task: &Task) -> Result<(), NoCertificate> {
    let allowance = Payload::penetration_allowance(&task.arm);
    for object in pressed_objects(task) {
        let Object { name, pieces, .. } = &task.objects[object];
        if !can_inset_union(pieces, allowance) {
            return Err(NoCertificate::Outline(name.clone()));
        }
    }
    Ok(())
}
