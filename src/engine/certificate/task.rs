//! Evidence for a task: besides the motion which part of it does which step, and how the wrist turns what is carried. Where all objects
//! are then follows from the world.

use super::lines;
use crate::engine::task::StepReport;
use crate::model::RecordedStep;
use serde_json::{Value, json};

/// The steps of a planned task, whose motion is among the results.
pub(super) fn steps(steps: &[StepReport]) -> (&'static str, String) {
    let step = |step: &StepReport| {
        let turn = step.turn.as_ref().map(|turn| turn.to - turn.from);
        done(step.step, [step.first_sample, step.last_sample].map(Option::unwrap_or_default), turn)
    };
    ("steps", lines(&steps.iter().map(step).collect::<Vec<_>>()))
}

/// The steps of a recorded task.
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
