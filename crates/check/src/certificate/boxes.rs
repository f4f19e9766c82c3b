//! What a certificate says of configurations that are not free.

use crate::decimal::Decimal;
use crate::domain::Rectangle;
use crate::error::CheckError;
use crate::polygon::Corner;
use serde::Deserialize;

/// A shape of the URDF, by its number among those of its kind that the link has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShapeName {
    pub link: String,
    pub collision: Option<usize>,
    pub visual: Option<usize>,
    pub bar: Option<usize>,
    /// A height in the layer, if the shape has several.
    pub height: Option<Decimal>,
}

/// A convex part of an obstacle, or a shape of a link that stands still.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartName {
    /// Number of the obstacle in the world file.
    pub obstacle: Option<usize>,
    /// Corners of the obstacle; none of a circle.
    pub corners: Option<Vec<Corner>>,
    /// Link of the robot that stands still.
    pub own: Option<String>,
    pub collision: Option<usize>,
    pub visual: Option<usize>,
    pub height: Option<Decimal>,
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
