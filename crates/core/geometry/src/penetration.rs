//! The classical penetration tests for convex polygons, by signed distances of corners to sides. Point penetration
//! computes the depth of a point in a polygon, and polygon penetration tests whether two polygons meet.
//!
//! Every sign is exact, so degenerate cases (collinear sides, a side through a corner, touching, polygons without area)
//! need no special treatment.

use super::meet::sides;
use super::predicates::{determinant, point_on_segment, segments_cross};
use super::{Convex, Point, Vector};

/// Returns the signed distance of `p` to the line directed from `a` to `b`, metres: positive on the left. Returns NaN
/// if `a == b`.
///
/// The sign is exact, and 0 only on the line. The value is rounded.
pub fn signed_distance(p: Point, a: Point, b: Point) -> f64 {
    determinant(a, b, p) / (b - a).norm()
}

/// Location of a point relative to a closed set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Location {
    /// In the interior.
    Inside,
    /// On the boundary. All points of a polygon without area are on its boundary.
    Boundary,
    /// Not in the set.
    Outside,
}

/// Penetration of a point in a convex polygon.
#[derive(Debug, Clone, PartialEq)]
pub struct PointPenetration {
    /// Signed distance of the point to the line through each side, metres. It is positive on the polygon's side of the
    /// line. Side `i` starts at corner `i`. A segment has two sides, in both directions. A point has none.
    pub distances: Vec<f64>,
    /// Least of the distances, metres. For a point inside, it is the distance to the nearest side. For a point outside,
    /// its absolute value is a lower bound on the distance to the polygon. If the polygon is a point, it is minus the
    /// distance to that point.
    pub depth: f64,
    /// The side of least distance, or the first of several. `None` if the polygon is a point.
    pub side: Option<usize>,
    /// Location of the point; exact.
    pub location: Location,
}

/// Computes the penetration of `point` in the core of a shape: a convex polygon, a segment or a point. The radius is
/// ignored. `O(n)`.
pub fn point_penetration(point: Point, shape: &Convex) -> PointPenetration {
    core_penetration(point, shape.core())
}

/// Computes the penetration of `point` in a convex counter-clockwise polygon. The polygon may be a segment, a point or
/// empty. Corners may coincide: the distance to a side without length is NaN, and is ignored.
pub(super) fn core_penetration(point: Point, polygon: &[Point]) -> PointPenetration {
    let n = polygon.len();
    if polygon.iter().all(|c| *c == polygon[0]) {
        let distance = polygon.first().map_or(f64::INFINITY, |c| (point - c).norm());
        let location = if polygon.first() == Some(&point) { Location::Boundary } else { Location::Outside };
        return PointPenetration { distances: Vec::new(), depth: -distance, side: None, location };
    }
    let distances: Vec<f64> = (0..n).map(|i| signed_distance(point, polygon[i], polygon[(i + 1) % n])).collect();
    let (side, depth) =
        distances.iter().copied().enumerate().fold((0, f64::INFINITY), |best, d| if d.1 < best.1 { d } else { best });
    // A point on the line of a side, and right of no side, is on the boundary. The exception is a point on the lines of
    // all sides. Then the polygon has no area, and may not extend to the point.
    let on_boundary =
        || distances.iter().any(|&d| d > 0.0) || sides(polygon).any(|(a, b)| point_on_segment(point, a, b));
    let location = if depth > 0.0 {
        Location::Inside
    } else if depth == 0.0 && on_boundary() {
        Location::Boundary
    } else {
        Location::Outside
    };
    PointPenetration { distances, depth, side: Some(side), location }
}

/// A corner of one polygon that lies in the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerInside {
    /// Index of the corner.
    pub corner: usize,
    /// Depth of the corner in the other polygon, metres; 0 on the boundary.
    pub depth: f64,
}

/// Result of the polygon penetration test.
#[derive(Debug, Clone, PartialEq)]
pub struct PolygonTest {
    /// True if the polygons have a point in common. Then one of the lists below is not empty. Touching counts. Exact.
    pub meet: bool,
    /// Corners of the first polygon in the second or on its boundary.
    pub a_inside: Vec<CornerInside>,
    /// Corners of the second polygon in the first or on its boundary.
    pub b_inside: Vec<CornerInside>,
    /// Pairs of a side of the first polygon and a side of the second that cross properly, in one point interior to both.
    pub crossings: Vec<(usize, usize)>,
}

/// Runs the polygon penetration test on the cores of two shapes. Finds the corners of each in the other, and the sides
/// that cross. The radii are ignored. `O(n m)`.
///
/// The cores may be segments or points. The test is complete: if two convex polygons meet and no corner of either lies
/// in the other, then their boundaries cross at points that are not corners.
pub fn polygon_test(a: &Convex, b: &Convex) -> PolygonTest {
    let (a, b) = (a.core(), b.core());
    PolygonTest::of(a, b, [corners_inside(a, b), corners_inside(b, a)])
}

impl PolygonTest {
    /// Completes a test by the pairs of sides that cross.
    pub(super) fn of(a: &[Point], b: &[Point], [a_inside, b_inside]: [Vec<CornerInside>; 2]) -> Self {
        let mut crossings = Vec::new();
        for (i, (p, q)) in sides(a).enumerate() {
            let crossed = sides(b).enumerate().filter(|&(_, (r, s))| segments_cross(p, q, r, s));
            crossings.extend(crossed.map(|(k, _)| (i, k)));
        }
        let meet = !(a_inside.is_empty() && b_inside.is_empty() && crossings.is_empty());
        Self { meet, a_inside, b_inside, crossings }
    }
}

fn corners_inside(corners: &[Point], polygon: &[Point]) -> Vec<CornerInside> {
    let inside = |(corner, &p): (usize, &Point)| {
        let penetration = core_penetration(p, polygon);
        // On a segment both signed distances are 0, and at a point the distance is 0. So neither is negative.
        (penetration.location != Location::Outside).then(|| CornerInside { corner, depth: penetration.depth.abs() })
    };
    corners.iter().enumerate().filter_map(inside).collect()
}

/// Returns the depth of the origin in a convex counter-clockwise polygon, or the negative distance to it, metres.
pub(super) fn origin_depth(polygon: &[Point]) -> f64 {
    let origin = Point::zeros();
    let penetration = core_penetration(origin, polygon);
    if penetration.location == Location::Outside {
        -sides(polygon).map(|(a, b)| distance_to_segment(origin, a, b)).fold(f64::INFINITY, f64::min)
    } else {
        penetration.depth.abs()
    }
}

/// Returns the distance of `p` from the closed segment `ab`.
pub(super) fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let along: Vector = b - a;
    let t = (p - a).dot(&along) / along.norm_squared();
    if t > 0.0 && t < 1.0 { signed_distance(p, a, b).abs() } else { (p - a).norm().min((p - b).norm()) }
}
