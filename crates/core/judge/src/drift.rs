//! The motion of a loose obstacle while the configuration deviates.

use cplan_geometry::{Point, Pose, Vector, perpendicular};

/// The motion of a loose obstacle while a parameter, such as the time, goes through a span. It is relative to the pose
/// in the middle of the span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// Pose of the obstacle's frame in the middle of the span.
    pub middle: Pose,
    /// Velocity of the frame's origin, metres per unit of the parameter. Zero if the velocity changes within the span,
    /// see `any`.
    pub velocity: Vector,
    /// Angular velocity, radians per unit of the parameter. Zero if it changes within the span, see `any`.
    pub turn: f64,
    /// Half the length of the span, in units of the parameter.
    pub half: f64,
    /// Bounds on the speed of the origin (metres per unit) and on the angular speed (radians per unit), for a span in
    /// which the velocity changes. Zero if it is constant.
    pub any: [f64; 2],
}

impl Drift {
    /// Returns the displacement, to first order, during half of the span. The point is at `p` in the middle of the span.
    pub fn of(&self, p: Point) -> Vector {
        (self.velocity + perpendicular(p - self.origin()) * self.turn) * self.half
    }

    /// Returns a bound, in metres, on the difference between the actual displacement of the point at `p` and
    /// [`Drift::of`].
    pub fn error_bound(&self, p: Point) -> f64 {
        let reach = (p - self.origin()).norm();
        let turned = self.turn * self.half;
        turned * turned * reach / 2.0 + (self.any[0] + self.any[1] * reach) * self.half
    }

    /// Returns an upper bound, in metres, on the motion during half of the span of all points within `reach` of the
    /// frame's origin.
    pub fn farthest(&self, reach: f64) -> f64 {
        (self.velocity.norm() + self.any[0] + (self.turn.abs() + self.any[1]) * reach) * self.half
    }

    fn origin(&self) -> Point {
        self.middle.translation
    }
}
