//! Checks certificates about motions of the tip along a line, in exact arithmetic.
//!
//! [`judge`] takes an arm, a world and a certificate with a line. It decides whether the certificate proves its answer:
//! the tip follows the line within the tolerance, or no motion of the tip does. Like `cplan-check`, on which it is built,
//! this crate shares no code with the planner. In cplan's repository, `docs/certificate_checks.md` lists the conditions
//! and explains why they suffice.
//!
//! | modules | subject |
//! |---|---|
//! | `text`, `bezier`, `curve` | the line |
//! | `tip` | positions of the tip, and their second derivatives |
//! | `near` | the tip stays near the line, in the order of the line |
//! | `step` | lines that steps of a task follow |
//! | `reach`, `chords`, `measure`, `cells`, `barred` | no motion follows the line |
#![forbid(unsafe_code)]

mod barred;
mod bezier;
mod cells;
mod chords;
mod curve;
mod measure;
mod near;
mod reach;
mod step;
mod text;
mod tip;

use cplan_check::arm::Arm;
use cplan_check::certificate::{Answer, Certificate};
use cplan_check::world::World;
use cplan_check::{CheckError, Input};
use text::{Line, LineText};

pub use step::StepLine;

/// Checks a certificate about a line. Returns the proven statement as a sentence.
///
/// # Errors
/// [`CheckError::Fails`] names the first part of the certificate that does not hold. [`CheckError::Input`] reports
/// certificates that are incomplete.
pub fn judge(arm: &Arm, world: &World, certificate: &Certificate, line: &str) -> Result<String, CheckError> {
    let line = Line::new(LineText::read(line)?)?;
    let Certificate { start, goal, goal_tip, steps, bound, .. } = certificate;
    if start.is_some() || goal.is_some() || goal_tip.is_some() || steps.is_some() || bound.is_some() {
        let message = "a certificate about a line cannot have a start, a goal, steps or a bound";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    match certificate.answer {
        Answer::Found => near::follows(arm, world, certificate, &line),
        Answer::Infeasible => barred::no_motion(arm, world, certificate, &line),
        Answer::NoShorter => {
            Err(CheckError::in_file(Input::Certificate, "the answer \"no_shorter\" cannot have a \"line\""))
        }
    }
}
