//! The motion of a loose obstacle while the configuration deviates.

use cplan_geometry::{Point, Pose, Vector, perpendicular};

/// The motion of a loose obstacle while a curve's parameter, such as the time, goes through a span, relative to the pose
/// in the middle of the span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// Pose of the obstacle's frame in the middle.
    pub middle: Pose,
    /// Velocity of its origin then, metres per unit of the parameter, ...
    pub velocity: Vector,
    /// ... and angular velocity, radians per unit, ...
    pub turn: f64,
    /// ... for this change of the parameter to either side.
    pub half: f64,
    /// Bounds on velocities in unknown directions: metres per unit, and radians per unit. For spans in which the
    /// velocity changes.
    pub any: [f64; 2],
}

impl Drift {
    /// Returns the displacement, per half of the span, of the point that is at `p` in the middle, to first order.
    #[must_use]
    pub fn of(&self, p: Point) -> Vector {
        (self.velocity + perpendicular(p - self.origin()) * self.turn) * self.half
    }

    /// Returns a bound on the difference between the displacement of that point and [`Drift::of`], metres.
    #[must_use]
    pub fn beyond(&self, p: Point) -> f64 {
        let reach = (p - self.origin()).norm();
        let turned = self.turn * self.half;
        turned * turned * reach / 2.0 + (self.any[0] + self.any[1] * reach) * self.half
    }

    /// Returns the farthest that a point within `reach` of the frame's origin moves, metres.
    #[must_use]
    pub fn farthest(&self, reach: f64) -> f64 {
        (self.velocity.norm() + self.any[0] + (self.turn.abs() + self.any[1]) * reach) * self.half
    }

    fn origin(&self) -> Point {
        self.middle.translation
    }
}
