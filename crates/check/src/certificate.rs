//! The certificate file.

mod bound;
mod boxes;
mod motion;
mod tasks;

pub use bound::{Bound, Metric, MotorSpeeds, Wall};
pub use boxes::{CollisionBox, PartName, ShapeName, rectangles};
pub use motion::{Interpolation, Motion};
pub use tasks::ExecutedStep;

use crate::decimal::Decimal;
use crate::elbow::Elbow;
use crate::error::{CheckError, Input};
use crate::polygon::Corner;
use crate::world::World;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::value::RawValue;

/// Value of the key `format` in certificates of the current form.
pub const FORMAT: &str = "cplan certificate 1";

/// A certificate: the query, and the evidence for the answer. Numbers are exact.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    format: String,
    /// The statement that is certified.
    pub answer: Answer,
    /// SHA-256 of the robot's file, in hex.
    pub urdf: Option<String>,
    /// SHA-256 of the world file, in hex.
    pub world: Option<String>,
    /// SHA-256 of the files to which the robot and the world refer, in hex.
    pub others: Option<Vec<String>>,
    /// The two joints, if the world does not name them.
    pub joints: Option<[String; 2]>,
    /// The start, if it differs from the world's.
    pub start: Option<[Decimal; 2]>,
    /// The goal, if it is a configuration that differs from the world's goal.
    pub goal: Option<[Decimal; 2]>,
    /// The goal, if it is a tip position that differs from the world's goal.
    pub goal_tip: Option<Corner>,
    /// The side of the elbow at `goal_tip`.
    pub elbow: Option<Elbow>,
    /// The clearance, if it differs from the world's.
    pub clearance: Option<Decimal>,
    /// Errors of robot and world in the form of `--calibration`. They replace those of the world.
    pub calibration: Option<String>,
    /// Evidence for "found": the motion.
    pub motion: Option<Motion>,
    /// For a task: the part of the motion that executes each step.
    pub steps: Option<Vec<ExecutedStep>>,
    /// Shapes to which the evidence refers by their indices.
    #[serde(default)]
    pub shapes: Vec<ShapeName>,
    /// Parts of obstacles to which the evidence refers by their indices.
    #[serde(default)]
    pub parts: Vec<PartName>,
    /// Evidence for "infeasible": collision boxes that separate start and goal. In a certificate with a bound, the
    /// boxes only show that their configurations are not free, and so are no goals.
    pub boxes: Option<Vec<CollisionBox>>,
    /// Evidence that no motion is shorter than a length.
    pub bound: Option<Bound>,
    /// The line as JSON, for an answer about a motion along a line. The crate `cplan-check-line` reads it.
    pub line: Option<Box<RawValue>>,
}

impl Certificate {
    /// Returns the required clearance.
    ///
    /// # Errors
    /// If it is negative.
    pub fn clearance<'a>(&'a self, world: &'a World) -> Result<&'a Decimal, CheckError> {
        let clearance = self.clearance.as_ref().unwrap_or(&world.clearance);
        if *clearance < Decimal::whole(0) {
            return Err(CheckError::in_file(Input::World, "the clearance is negative"));
        }
        Ok(clearance)
    }
}

/// The statement that is certified.
#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// There is a motion.
    Found,
    /// There is no motion.
    Infeasible,
    /// No motion is shorter than the length in [`Certificate::bound`].
    NoShorter,
}

/// A result of cplan. Only its certificate is read.
#[derive(Deserialize)]
struct EnclosingResult<'a> {
    #[serde(borrow)]
    certificate: &'a RawValue,
}

/// A proof that a task is infeasible, as earlier versions of cplan wrote it.
#[derive(Deserialize)]
struct TaskProof {
    #[serde(rename = "cases")]
    _cases: IgnoredAny,
}

/// Reads a certificate, or the certificate within a result of cplan.
///
/// # Errors
/// If the text is not a certificate, has another format, or is a proof that a task is infeasible.
pub fn read(text: &str) -> Result<Certificate, CheckError> {
    let text = serde_json::from_str::<EnclosingResult>(text).map_or(text, |result| result.certificate.get());
    // Test for old proofs first, because their keys are unknown today.
    if serde_json::from_str::<TaskProof>(text).is_ok() {
        let message = "the checker does not judge proofs that a task is infeasible (\"cases\"); the result of cplan states the reason";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    let read: Result<Certificate, _> = serde_json::from_str(text);
    let certificate = read.map_err(|error| {
        let message = format!("this is not a certificate: {error}");
        CheckError::Input { input: Input::Certificate, line: Some(error.line()), message }
    })?;
    if certificate.format != FORMAT {
        let message = format!("the format is \"{}\", but the checker knows only \"{FORMAT}\"", certificate.format);
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    let Certificate { answer, motion, steps, boxes, bound, .. } = &certificate;
    let evidence = [motion.is_some(), boxes.is_some(), bound.is_some()];
    let is_to_the_goal = bound.as_ref().is_some_and(|bound| bound.to.is_none());
    if certificate.elbow.is_some() && certificate.goal_tip.is_none() {
        return Err(CheckError::in_file(Input::Certificate, "\"elbow\" needs a \"goal_tip\""));
    }
    let fits = match answer {
        Answer::Found => evidence[0] && (is_to_the_goal || !evidence[1]),
        Answer::Infeasible => steps.is_none() && evidence == [false, true, false],
        Answer::NoShorter => steps.is_none() && !evidence[0] && evidence[2] && (is_to_the_goal || !evidence[1]),
    };
    if !fits {
        let message = "the members do not fit the answer: \"found\" needs a motion, and may have steps or a bound; \"infeasible\" needs only boxes; \"no_shorter\" needs a bound; and boxes together with a bound need a bound without \"to\"";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    Ok(certificate)
}
