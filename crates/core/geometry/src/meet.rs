//! The exact test whether two shapes meet.

use super::predicates::{Orientation, orientation, segments_meet};
use super::{Convex, Point, separation};

/// Returns true if two shapes have a point in common. Touching counts. `O(n m)`.
///
/// Without radii, the test is exact for points, segments and polygons, because it uses exact predicates on the stored
/// corners. With radii, the answer is the sign of the distance from [`separation`]. Its rounding error is a few units
/// in the last place of the largest coordinate, so only pairs that nearly touch can be misjudged.
pub fn shapes_meet(a: &Convex, b: &Convex) -> bool {
    if a.radius() == 0.0 && b.radius() == 0.0 {
        cores_meet(a.core(), b.core())
    } else {
        separation(a, b).distance <= 0.0
    }
}

/// Returns true if two convex cores (points, segments, counter-clockwise polygons) have a point in common; exact.
pub(super) fn cores_meet(a: &[Point], b: &[Point]) -> bool {
    // Either the boundaries meet, or one core lies inside the other. Then testing one of its corners suffices.
    sides(a).any(|(p, q)| sides(b).any(|(r, s)| segments_meet(p, q, r, s)))
        || a.first().is_some_and(|&p| polygon_contains(b, p))
        || b.first().is_some_and(|&p| polygon_contains(a, p))
}

/// Iterates over the sides of a core. A segment has one side. The side of a point is the point itself.
pub(super) fn sides(core: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    let n = core.len();
    let count = if n == 2 { 1 } else { n };
    (0..count).map(move |i| (core[i], core[(i + 1) % n]))
}

/// Returns true if a convex counter-clockwise polygon contains `p`, including its boundary. A polygon without area
/// contains nothing.
fn polygon_contains(polygon: &[Point], p: Point) -> bool {
    let mut strictly = false;
    let left_of_all = sides(polygon).all(|(a, b)| {
        let side = orientation(a, b, p);
        strictly |= side == Orientation::CounterClockwise;
        side != Orientation::Clockwise
    });
    polygon.len() > 2 && left_of_all && strictly
}
