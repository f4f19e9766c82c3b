//! The certificate file.

mod bound;
mod boxes;
mod motion;
mod tasks;

pub use bound::{Bound, Metric, Wall};
pub use boxes::{PartName, ShapeName, StuckBox, rectangles};
pub use motion::{Interpolation, Motion};
pub use tasks::Done;

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::polygon::Corner;
use crate::world::World;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::value::RawValue;

/// What certificates of this form begin with.
pub const FORMAT: &str = "cplan certificate 1";

/// A certificate: what was asked, and the evidence for the answer. Numbers are exact.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    format: String,
    /// What is certified.
    pub answer: Answer,
    /// The SHA-256 of the robot's file that it is about, in hex, ...
    pub urdf: Option<String>,
    /// ... of the world's, ...
    pub world: Option<String>,
    /// ... and of those that these name.
    pub others: Option<Vec<String>>,
    /// The two joints, if the world does not say them.
    pub joints: Option<[String; 2]>,
    /// The start, where it was not the world's own.
    pub start: Option<[Decimal; 2]>,
    /// The goal, likewise.
    pub goal: Option<[Decimal; 2]>,
    /// The goal as a place of the tip, likewise.
    pub goal_tip: Option<Corner>,
    /// The clearance, likewise.
    pub clearance: Option<Decimal>,
    /// That there is a motion.
    pub motion: Option<Motion>,
    /// Of a task: which part of it does which step.
    pub steps: Option<Vec<Done>>,
    /// Pairs of links that overlap in every configuration.
    #[serde(default)]
    pub ignored: Vec<[String; 2]>,
    /// Shapes that evidence names.
    #[serde(default)]
    pub shapes: Vec<ShapeName>,
    /// Parts that evidence names.
    #[serde(default)]
    pub parts: Vec<PartName>,
    /// That there is no motion; or what is no goal of a bound, because it is not free.
    pub boxes: Option<Vec<StuckBox>>,
    /// That none is shorter.
    pub bound: Option<Bound>,
}

impl Certificate {
    /// The clearance that is asked for.
    ///
    /// # Errors
    /// A negative one.
    pub fn clearance<'a>(&'a self, world: &'a World) -> Result<&'a Decimal, CheckError> {
        let clearance = self.clearance.as_ref().unwrap_or(&world.clearance);
        if *clearance < Decimal::whole(0) {
            return Err(CheckError::in_file(Input::World, "the clearance is negative"));
        }
        Ok(clearance)
    }
}

/// What is certified.
#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// A motion.
    Found,
    /// That there is none.
    Infeasible,
    /// That none is shorter.
    NoShorter,
}

/// A result of cplan, as far as it matters here.
#[derive(Deserialize)]
struct Containing<'a> {
    #[serde(borrow)]
    certificate: &'a RawValue,
}

/// A proof that a task is infeasible, which earlier versions of cplan wrote.
#[derive(Deserialize)]
struct TaskProof {
    #[serde(rename = "cases")]
    _cases: IgnoredAny,
}

/// Reads a certificate, or the one in a result of cplan.
///
/// # Errors
/// What is none, or of another form; a proof that a task is infeasible.
pub fn read(text: &str) -> Result<Certificate, CheckError> {
    let text = serde_json::from_str::<Containing>(text).map_or(text, |result| result.certificate.get());
    // Such a proof has keys elsewhere, too, that are unknown by now.
    if serde_json::from_str::<TaskProof>(text).is_ok() {
        let message = "it has \"cases\" that prove a task infeasible: the checker does not judge proofs about tasks; \
                       the result of cplan states the reason";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    let read: Result<Certificate, _> = serde_json::from_str(text);
    let certificate = read.map_err(|error| {
        let message = format!("this is no certificate: {error}");
        CheckError::Input { input: Input::Certificate, line: Some(error.line()), message }
    })?;
    if certificate.format != FORMAT {
        let message = format!("its format is \"{}\": the checker knows \"{FORMAT}\"", certificate.format);
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    let Certificate { answer, motion, steps, boxes, bound, .. } = &certificate;
    let evidence = [motion.is_some(), boxes.is_some(), bound.is_some()];
    let is_to_the_goal = bound.as_ref().is_some_and(|bound| bound.to.is_none());
    let fits = match answer {
        Answer::Found => evidence[0] && (is_to_the_goal || !evidence[1]),
        Answer::Infeasible => steps.is_none() && evidence == [false, true, false],
        Answer::NoShorter => steps.is_none() && !evidence[0] && evidence[2] && (is_to_the_goal || !evidence[1]),
    };
    if !fits {
        let message = "\"found\" has a motion, and may have steps or a bound; \"infeasible\" has boxes; \"no_shorter\" a bound; \
                       with a bound there are boxes only if it does not say \"to\" where";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    Ok(certificate)
}
