//! The place of a line in the plane of the robot.

use crate::{Curve, Point};
use cplan_text::Unit;

/// The place of a line in the plane: it is scaled about its origin, then turned about it, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Unit of the file's numbers. With `None`, it is the unit that the file states.
    pub unit: Option<Unit>,
    /// Factor by which the line is scaled. Positive. Speeds of the file stay the same.
    pub scale: f64,
    /// Angle by which the line is turned, radians, positive counter-clockwise.
    pub turn: f64,
    /// Displacement of the line's origin, metres.
    pub shift: Point,
}

impl Default for Placement {
    /// Returns the placement that changes nothing, in the unit that the file states.
    fn default() -> Self {
        Self { unit: None, scale: 1.0, turn: 0.0, shift: [0.0; 2] }
    }
}

impl Placement {
    /// Returns the curve at its place. Its lengths are already metres.
    pub fn place(&self, curve: &Curve) -> Curve {
        curve.placed(self.scale, self.turn, self.shift)
    }
}
