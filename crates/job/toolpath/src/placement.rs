//! The place of a line in the plane of the robot.

use crate::{Curve, Point};
use cplan_text::Unit;

/// The place of a line in the plane. The line is first scaled about its origin, then turned about it, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Unit of the file's numbers. `None` for the unit that the file states.
    pub unit: Option<Unit>,
    /// Positive factor by which the line is scaled. It does not change speeds.
    pub scale: f64,
    /// Angle by which the line is turned, radians, positive counter-clockwise.
    pub turn: f64,
    /// Displacement of the line's origin, metres.
    pub shift: Point,
}

impl Default for Placement {
    /// Leaves the line as it is, in the unit that the file states.
    fn default() -> Self {
        Self { unit: None, scale: 1.0, turn: 0.0, shift: [0.0; 2] }
    }
}

impl Placement {
    /// Returns the curve, placed in the plane. Its lengths are already in metres.
    pub fn place(&self, curve: &Curve) -> Curve {
        curve.placed(self.scale, self.turn, self.shift)
    }
}
