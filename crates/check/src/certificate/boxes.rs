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
    /// The link.
    pub link: String,
    /// Its number, if it is a collision shape, ...
    pub collision: Option<usize>,
    /// ... a visual shape, ...
    pub visual: Option<usize>,
    /// ... or the bar of the world: then 0.
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
    /// The number of the link's shape, if it is a collision shape, ...
    pub collision: Option<usize>,
    /// ... or a visual shape.
    pub visual: Option<usize>,
    /// A height in the layer, if the shape has several.
    pub height: Option<Decimal>,
}

/// Configurations in all of which a shape and a part overlap.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StuckBox {
    /// The least value of each joint.
    pub lower: [Decimal; 2],
    /// The greatest.
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
