//! The certificate file.

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::polygon::Corner;
use serde::Deserialize;

/// What certificates of this form begin with.
pub const FORMAT: &str = "cplan certificate 1";

/// A certificate that there is no motion. Numbers are exact.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "answer")]
    _answer: String,
    /// What was asked, where it was not the world's own.
    pub start: Option<[Decimal; 2]>,
    pub goal: Option<[Decimal; 2]>,
    pub goal_tip: Option<Corner>,
    pub clearance: Option<Decimal>,
    pub shapes: Vec<ShapeName>,
    pub parts: Vec<PartName>,
    pub boxes: Vec<StuckBox>,
}

/// What is certified.
#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    Found,
    Infeasible,
}

/// What all certificates have.
#[derive(Deserialize)]
struct Header {
    format: String,
    answer: Answer,
}

/// Reads a certificate's text.
///
/// # Errors
/// What is none of this kind.
pub fn read<'t, T: Deserialize<'t>>(text: &'t str) -> Result<T, CheckError> {
    serde_json::from_str(text).map_err(|error| {
        let message = format!("this is no certificate: {error}");
        CheckError::Input { input: Input::Certificate, line: Some(error.line()), message }
    })
}

/// Which answer a text certifies.
///
/// # Errors
/// What is no certificate, or of another form.
pub fn answer(text: &str) -> Result<Answer, CheckError> {
    let Header { format, answer } = read(text)?;
    if format != FORMAT {
        let message = format!("its format is \"{format}\": the checker knows \"{FORMAT}\"");
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    Ok(answer)
}

/// A shape of the URDF: its number among those of its kind that the link has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShapeName {
    pub link: String,
    pub collision: Option<usize>,
    pub visual: Option<usize>,
    pub bar: Option<usize>,
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
