//! Sites of the Voronoi diagram of free space: open sides of its boundary, and corners.

use cplan_core::planner::mesh::Corner;
use cplan_core::space::Segment;
use cplan_geometry::{Point, Vector, cross, perpendicular};

/// Nearer than this is contact: rounding of coordinates, radians or metres.
pub(super) const CONTACT_DISTANCE: f64 = 1e-12;

/// A side of the boundary without its ends, or a convex corner of an obstacle.
///
/// The points that are nearer to it than to all else lie on its *rays*: those that leave a side at right angles, or a corner
/// between the normals of its two sides. A parameter tells them apart: the length along the side, or the tangent of half the
/// angle to the middle one, which makes polynomials of waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Site {
    /// The corner, or where the side begins.
    pub at: Point,
    /// The corner, or where the side ends; free space lies to the left.
    pub to: Point,
    /// Direction of the side, or of the corner's middle ray.
    pub along: Vector,
    /// Least and greatest parameter.
    pub range: [f64; 2],
    /// True for a side, even if its ends are rounded to the same place.
    pub is_side: bool,
}

/// Start and direction of a ray.
pub(super) type Ray = (Point, Vector);

impl Site {
    /// Creates a side of positive length, from `at` to `to`.
    pub fn side(at: Point, to: Point) -> Self {
        let length = (to - at).norm();
        Self { at, to, along: (to - at) / length, range: [0.0, length], is_side: true }
    }

    /// Creates a corner of free space with an angle of more than half a turn.
    pub fn corner(corner: &Corner) -> Self {
        let first = perpendicular((corner.right - corner.at).normalize());
        let last = -perpendicular((corner.left - corner.at).normalize());
        let angle = cross(first, last).atan2(first.dot(&last)).abs();
        let (sin, cos) = (angle / 2.0).sin_cos();
        let most = (angle / 4.0).tan();
        Self {
            at: corner.at,
            to: corner.at,
            along: first * cos + perpendicular(first) * sin,
            range: [-most, most],
            is_side: false,
        }
    }

    /// Returns the same site, moved by turns.
    pub fn turned(&self, turns: [f64; 2]) -> Self {
        let [at, to] = Segment::new(self.at, self.to).turned(turns).ends();
        Self { at, to, ..*self }
    }

    /// Returns the normal into free space; for a corner, an arbitrary unit vector.
    pub fn normal(&self) -> Vector {
        perpendicular(self.along)
    }

    /// Returns the ray of a parameter.
    pub fn ray(&self, parameter: f64) -> Ray {
        if self.is_side {
            (self.at + self.along * parameter, self.normal())
        } else {
            let square = parameter * parameter;
            (self.at, (self.along * (1.0 - square) + self.normal() * (2.0 * parameter)) / (1.0 + square))
        }
    }

    /// Returns the end of a side at which a parameter lies up to rounding.
    pub fn end(&self, parameter: f64) -> Option<Point> {
        let ends = [(self.range[0], self.at), (self.range[1], self.to)];
        ends.into_iter().find(|(end, _)| self.is_side && (parameter - end).abs() < CONTACT_DISTANCE).map(|(_, p)| p)
    }

    /// Returns the point of the site that is nearest to `p`.
    pub fn nearest(&self, p: Point) -> Point {
        if self.is_side {
            self.at + self.along * (p - self.at).dot(&self.along).clamp(0.0, self.range[1])
        } else {
            self.at
        }
    }

    /// Returns the distance of a segment that does not cross the site.
    pub fn distance(&self, a: Point, b: Point) -> f64 {
        let displacement = b - a;
        let share = |p: Point| {
            ((p - a).dot(&displacement) / displacement.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
        };
        let of_ends = [a, b].map(|p| (p - self.nearest(p)).norm());
        let of_site = [self.at, self.to].map(|p| (p - (a + displacement * share(p))).norm());
        of_ends.into_iter().chain(of_site).fold(f64::INFINITY, f64::min)
    }

    /// Returns the distance up to which points of a ray are nearer to its start than to this site. It is infinite if
    /// there is no such limit, or if the ray starts on this site.
    pub fn limit(&self, (from, direction): Ray) -> f64 {
        if (from - self.nearest(from)).norm() < CONTACT_DISTANCE {
            return f64::INFINITY;
        }
        let there = from - self.at;
        if !self.is_side {
            let (towards, square) = (-there.dot(&direction), there.norm_squared());
            return if towards > 0.0 { square / (2.0 * towards) } else { f64::INFINITY };
        }
        let apart = (direction - self.normal()).norm_squared() / 2.0;
        let height = there.dot(&self.normal()) / apart;
        let foot = there.dot(&self.along) + height * direction.dot(&self.along);
        let is_met =
            height > 0.0 && height.is_finite() && foot >= -CONTACT_DISTANCE && foot <= self.range[1] + CONTACT_DISTANCE;
        if is_met { height } else { f64::INFINITY }
    }
}
