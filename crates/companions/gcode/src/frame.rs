//! The place of a file's coordinates in the world.

use cplan_geometry::Point;
use cplan_toolpath::Curve;

/// The place of a file's coordinates in the world: a rotation about their origin, followed by a displacement.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Frame {
    /// Angle of the rotation, radians, positive counter-clockwise.
    pub turn: f64,
    /// Position of their origin in the world, metres.
    pub origin: [f64; 2],
}

impl Frame {
    /// Returns a curve of the file in the coordinates of the world.
    pub fn place(&self, curve: &Curve) -> Curve {
        curve.placed(1.0, self.turn, self.origin)
    }

    /// Returns a point of the file in the coordinates of the world.
    pub(crate) fn to_world(self, point: Point) -> Point {
        let (sin, cos) = self.turn.sin_cos();
        Point::new(point.x * cos - point.y * sin, point.x * sin + point.y * cos) + Point::from(self.origin)
    }

    /// Returns the coordinates of a point of the world in the file, metres.
    pub(crate) fn to_file(self, point: Point) -> Point {
        let ((sin, cos), away) = (self.turn.sin_cos(), point - Point::from(self.origin));
        Point::new(away.x * cos + away.y * sin, away.y * cos - away.x * sin)
    }
}
