//! Sites of the Voronoi diagram of free space: the open sides of its boundary, and its corners.

use cplan_geometry::{Point, Vector, cross, perpendicular};
use cplan_model::space::Segment;
use cplan_planners::planner::mesh::Corner;

/// Distance below which two points count as in contact, radians or metres. It exceeds the rounding of coordinates.
pub(super) const CONTACT_DISTANCE: f64 = 1e-12;

/// A side of the boundary without its ends, or a convex corner of an obstacle.
///
/// The points that are nearer to a site than to all others lie on the site's *rays*. The rays of a side are perpendicular to it;
/// those of a corner lie between the normals of its two sides. The parameter of a ray is the length along the side, or the
/// tangent of half the angle to the corner's middle ray, which turns sines and cosines into polynomials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Site {
    /// The corner, or the start of the side.
    pub at: Point,
    /// The corner, or the end of the side. Free space lies to the left of the side.
    pub to: Point,
    /// Unit direction of the side, or of the corner's middle ray.
    pub along: Vector,
    /// Least and greatest parameter of the rays.
    pub range: [f64; 2],
    /// True for a side, even if rounding makes its ends coincide.
    pub is_side: bool,
}

/// A ray, given by its start and its unit direction.
pub(super) type Ray = (Point, Vector);

impl Site {
    /// Creates a side of positive length, from `at` to `to`.
    pub fn side(at: Point, to: Point) -> Self {
        let length = (to - at).norm();
        Self { at, to, along: (to - at) / length, range: [0.0, length], is_side: true }
    }

    /// Creates the site of a convex corner of an obstacle.
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

    /// Returns the same site, moved by whole turns.
    pub fn turned(&self, turns: [f64; 2]) -> Self {
        let [at, to] = Segment::new(self.at, self.to).turned(turns).ends();
        Self { at, to, ..*self }
    }

    /// Returns the normal into free space. For a corner, returns the unit vector perpendicular to the middle ray.
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

    /// Returns the end of a side at which the ray of a parameter starts, up to rounding. `None` if the ray starts elsewhere.
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

    /// Returns the distance from the site to a segment that does not cross it.
    pub fn distance(&self, a: Point, b: Point) -> f64 {
        let displacement = b - a;
        let share = |p: Point| {
            ((p - a).dot(&displacement) / displacement.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
        };
        let of_ends = [a, b].map(|p| (p - self.nearest(p)).norm());
        let of_site = [self.at, self.to].map(|p| (p - (a + displacement * share(p))).norm());
        of_ends.into_iter().chain(of_site).fold(f64::INFINITY, f64::min)
    }

    /// Returns the length up to which the points of a ray are nearer to the ray's start than to this site. Infinite if all its
    /// points are, or if the ray starts on this site.
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
