//! The lines that steps of a task follow.

use super::order::MatchedStep;
use crate::world::task::{Action, Step};
use cplan_check::certificate::ExecutedStep;
use cplan_check::{CheckError, Input};
use cplan_check_line::StepLine;
use std::collections::BTreeMap;

/// Reads the line of an executed step. Returns `None` if the step follows no line.
///
/// # Errors
/// If only the step or only its execution has a line, or if the line is not that of the world.
pub(super) fn read(step: &Step, done: &ExecutedStep) -> Result<Option<StepLine>, CheckError> {
    let number = step.number;
    let wrong = |message| Err(CheckError::in_file(Input::Certificate, message));
    match (&step.action, &done.line) {
        (Action::Follow(asked), Some(text)) => {
            let line = StepLine::read(text.get(), &asked.tolerance, asked.elbow)?;
            match asked.allows(&line) {
                true => Ok(Some(line)),
                false => {
                    CheckError::fails(format!("the certificate and the world have different lines for step {number}"))
                }
            }
        }
        (Action::Follow(_), None) => {
            wrong(format!("step {number} follows a line, but the certificate has no \"line\" for it"))
        }
        (_, Some(_)) => wrong(format!("step {number} follows no line, but the certificate has a \"line\" for it")),
        (_, None) => Ok(None),
    }
}

/// Describes the lines of all steps in words.
///
/// # Errors
/// If a step follows different lines in its repetitions.
pub(super) fn in_words(steps: &[MatchedStep]) -> Result<String, CheckError> {
    let (mut words, mut first) = (String::new(), BTreeMap::new());
    for MatchedStep { step, line, .. } in steps {
        let (Some(line), Action::Follow(asked), number) = (line, &step.action, step.number) else { continue };
        if let Some(before) = first.insert(number, line) {
            if !line.has_pieces_of(before) {
                return CheckError::fails(format!("the line of step {number} changes when the step is repeated"));
            }
            continue;
        }
        words += &format!("; in step {number} the tip follows {line}");
        if !asked.is_known() {
            words += ", as the certificate states it";
        }
        if asked.has_tool_angle {
            words += "; the angle of the tool there is not judged";
        }
    }
    Ok(words)
}
