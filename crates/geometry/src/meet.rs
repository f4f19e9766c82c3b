//! Whether two shapes meet.

use super::predicates::{Orientation, orientation, segments_meet};
use super::{Convex, Point, separation};

/// Whether two shapes have a point in common. Touching counts.
///
/// Without radii exact: points, segments and polygons alike, by exact predicates on the corners as they are stored.
/// With radii the answer is the sign of [`separation`]'s distance, whose rounding error (a few units in the last
/// place of the largest coordinate) it shares: only pairs that close to touching can be misjudged. `O(n m)`.
#[must_use]
pub fn shapes_meet(a: &Convex, b: &Convex) -> bool {
    if a.radius() == 0.0 && b.radius() == 0.0 {
        cores_meet(a.core(), b.core())
    } else {
        separation(a, b).distance <= 0.0
    }
}

/// Whether two convex cores (points, segments, counter-clockwise polygons) have a point in common; exact.
pub(super) fn cores_meet(a: &[Point], b: &[Point]) -> bool {
    // Either the boundaries meet, or one core lies wholly inside the other and any corner of it tells.
    sides(a).any(|(p, q)| sides(b).any(|(r, s)| segments_meet(p, q, r, s)))
        || a.first().is_some_and(|&p| polygon_contains(b, p))
        || b.first().is_some_and(|&p| polygon_contains(a, p))
}

/// The sides of a core; those of a segment are one, that of a point is the point.
pub(super) fn sides(core: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    let n = core.len();
    let count = if n == 2 { 1 } else { n };
    (0..count).map(move |i| (core[i], core[(i + 1) % n]))
}

/// Whether a convex counter-clockwise polygon contains `p`, in its interior or on its boundary; never if it has no area.
fn polygon_contains(polygon: &[Point], p: Point) -> bool {
    let mut strictly = false;
    let left_of_all = sides(polygon).all(|(a, b)| {
        let side = orientation(a, b, p);
        strictly |= side == Orientation::CounterClockwise;
        side != Orientation::Clockwise
    });
    polygon.len() > 2 && left_of_all && strictly
}
