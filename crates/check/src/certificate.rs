//! The certificate file.

mod tasks;

pub use tasks::{Case, Done};

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::polygon::Corner;
use crate::sweep::Rectangle;
use crate::world::World;
use serde::Deserialize;
use serde_json::value::RawValue;

/// What certificates of this form begin with.
pub const FORMAT: &str = "cplan certificate 1";

/// A certificate: what was asked, and the evidence for the answer. Numbers are exact.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    format: String,
    pub answer: Answer,
    /// The SHA-256 of the two files that it is about, in hex, and of those that they name.
    pub urdf: Option<String>,
    pub world: Option<String>,
    pub others: Option<Vec<String>>,
    /// The two joints, if the world does not say them.
    pub joints: Option<[String; 2]>,
    /// What was asked, where it was not the world's own.
    pub start: Option<[Decimal; 2]>,
    pub goal: Option<[Decimal; 2]>,
    pub goal_tip: Option<Corner>,
    pub clearance: Option<Decimal>,
    /// That there is a motion.
    pub motion: Option<Motion>,
    /// Of a task: which part of it does which step.
    pub steps: Option<Vec<Done>>,
    /// What evidence names.
    #[serde(default)]
    pub shapes: Vec<ShapeName>,
    #[serde(default)]
    pub parts: Vec<PartName>,
    /// That there is no motion; or what is no goal of a bound, because it is not free.
    pub boxes: Option<Vec<StuckBox>>,
    /// That a task cannot be done.
    pub cases: Option<Vec<Case>>,
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
    Found,
    Infeasible,
    NoShorter,
}

/// A result of cplan, as far as it matters here.
#[derive(Deserialize)]
struct Containing<'a> {
    #[serde(borrow)]
    certificate: &'a RawValue,
}

/// Reads a certificate, or the one in a result of cplan.
///
/// # Errors
/// What is none, or of another form.
pub fn read(text: &str) -> Result<Certificate, CheckError> {
    let text = serde_json::from_str::<Containing>(text).map_or(text, |result| result.certificate.get());
    let read: Result<Certificate, _> = serde_json::from_str(text);
    let certificate = read.map_err(|error| {
        let message = format!("this is no certificate: {error}");
        CheckError::Input { input: Input::Certificate, line: Some(error.line()), message }
    })?;
    if certificate.format != FORMAT {
        let message = format!("its format is \"{}\": the checker knows \"{FORMAT}\"", certificate.format);
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    let Certificate { answer, motion, steps, boxes, cases, bound, .. } = &certificate;
    let evidence = [motion.is_some(), boxes.is_some(), bound.is_some()];
    let has_cases = cases.is_some();
    let is_to_the_goal = bound.as_ref().is_some_and(|bound| bound.to.is_none());
    let fits = match answer {
        Answer::Found => !has_cases && evidence[0] && (is_to_the_goal || !evidence[1]),
        Answer::Infeasible => steps.is_none() && evidence == [false, !has_cases, false],
        Answer::NoShorter => {
            steps.is_none() && !has_cases && !evidence[0] && evidence[2] && (is_to_the_goal || !evidence[1])
        }
    };
    if !fits {
        let message = "\"found\" has a motion, and may have steps or a bound; \"infeasible\" has boxes, of a task cases; \"no_shorter\" a bound; \
                       with a bound there are boxes only if it does not say \"to\" where";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    Ok(certificate)
}

/// What is played.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// The ways in which it can be read: it is free in each.
    pub interpolation: Vec<Interpolation>,
    /// Time, both joints' values, and as far as an interpolation needs them their velocities and accelerations.
    pub knots: Vec<Vec<Decimal>>,
}

/// How knots are joined.
#[derive(Deserialize, Clone, Copy, PartialEq, PartialOrd)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight.
    Linear,
    /// By the cubic with the values and velocities of both.
    Cubic,
    /// By the polynomial of the fourth degree with value, velocity and acceleration of the first, value and velocity of the second.
    Quartic,
    /// By the polynomial of the fifth degree with the values, velocities and accelerations of both.
    Quintic,
}

/// A shape of the URDF, by its number among those of its kind that the link has, or of what is carried.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShapeName {
    pub link: Option<String>,
    pub collision: Option<usize>,
    pub visual: Option<usize>,
    pub bar: Option<usize>,
    /// Corners of a convex part of what is carried, in its own frame; none of a disc.
    pub carried: Option<Vec<Corner>>,
}

/// A convex part of an obstacle.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartName {
    /// The obstacle's number in the world file.
    pub obstacle: usize,
    /// Corners of the obstacle; none of a circle.
    #[serde(default)]
    pub corners: Vec<Corner>,
}

/// Configurations in all of which a shape and a part overlap.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StuckBox {
    pub lower: [Decimal; 2],
    pub upper: [Decimal; 2],
    /// Into the shapes.
    pub shape: usize,
    /// Into the parts.
    pub part: usize,
}

/// Boxes as they are.
///
/// # Errors
/// One that is turned inside out.
pub fn rectangles(boxes: &[StuckBox]) -> Result<Vec<Rectangle>, CheckError> {
    let ranges = |stuck: &StuckBox| [0, 1].map(|k| [stuck.lower[k].clone(), stuck.upper[k].clone()]);
    let boxes: Vec<Rectangle> = boxes.iter().map(ranges).collect();
    match boxes.iter().position(|ranges| ranges.iter().any(|[low, high]| low > high)) {
        Some(empty) => CheckError::fails(format!("box {empty}: an upper end is below the lower one")),
        None => Ok(boxes),
    }
}

/// That no motion is shorter than a length.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// Where to; by default to the goal.
    pub to: Option<[Decimal; 2]>,
    pub length: Decimal,
    #[serde(default)]
    pub metric: Metric,
    pub walls: Vec<Wall>,
    pub potentials: Vec<Potential>,
}

/// How lengths of displacements are measured.
#[derive(Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// The root of the sum of squares, ...
    #[default]
    Euclidean,
    /// ... each entry times a factor before, ...
    Weights([Decimal; 2]),
    /// ... or the greater of the quotients by two speeds.
    Speeds([Decimal; 2]),
}

/// A straight segment of configurations in all of which a shape and a part overlap.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    pub from: [Decimal; 2],
    pub to: [Decimal; 2],
    /// Into the shapes.
    pub shape: usize,
    /// Into the parts.
    pub part: usize,
}

/// A length that no way from the start to an end of a wall falls short of.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Potential {
    /// Into the walls.
    pub wall: usize,
    /// 0 where it begins, 1 where it ends.
    pub end: usize,
    /// Whole turns of each joint from where the wall is written to where it is meant.
    #[serde(default)]
    pub turns: [i64; 2],
    pub value: Decimal,
}
