//! Certificate content about configurations that are not free.

use crate::decimal::Decimal;
use crate::domain::Rectangle;
use crate::error::CheckError;
use crate::polygon::Corner;
use serde::Deserialize;

/// A shape of the URDF. Its number counts the link's shapes of the same kind.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShapeName {
    /// Name of the link.
    pub link: String,
    /// Index among the link's collision shapes; `None` for other kinds.
    pub collision: Option<usize>,
    /// Index among the link's visual shapes; `None` for other kinds.
    pub visual: Option<usize>,
    /// 0 for the bar that the world defines; `None` for other kinds.
    pub bar: Option<usize>,
    /// A height within the layer, if the shape is cut into several layers.
    pub height: Option<Decimal>,
}

/// A convex part of an obstacle, or a shape of a link that acts as an obstacle.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartName {
    /// Index of the obstacle in the world; `None` if the part belongs to the robot.
    pub obstacle: Option<usize>,
    /// Corners of the part; `None` for a circle.
    pub corners: Option<Vec<Corner>>,
    /// Name of the link, if the part belongs to the robot.
    pub own: Option<String>,
    /// Index of the link's shape, if it is a collision shape.
    pub collision: Option<usize>,
    /// Index of the link's shape, if it is a visual shape.
    pub visual: Option<usize>,
    /// A height within the layer, if the shape is cut into several layers.
    pub height: Option<Decimal>,
}

/// A box of configurations. A shape and a part overlap in all of them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CollisionBox {
    /// Least value of each joint.
    pub lower: [Decimal; 2],
    /// Greatest value of each joint.
    pub upper: [Decimal; 2],
    /// Index into the certificate's shapes.
    pub shape: usize,
    /// Index into the certificate's parts.
    pub part: usize,
}

/// Converts boxes to rectangles, unchanged.
///
/// # Errors
/// If an upper end of a box is below its lower end.
pub fn rectangles(boxes: &[CollisionBox]) -> Result<Vec<Rectangle>, CheckError> {
    let ranges = |stuck: &CollisionBox| [0, 1].map(|k| [stuck.lower[k].clone(), stuck.upper[k].clone()]);
    let boxes: Vec<Rectangle> = boxes.iter().map(ranges).collect();
    match boxes.iter().position(|ranges| ranges.iter().any(|[low, high]| low > high)) {
        Some(empty) => CheckError::fails(format!("box {empty}: an upper end is below the lower end")),
        None => Ok(boxes),
    }
}
