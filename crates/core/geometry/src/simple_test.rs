//! The penetration test for simple polygons, which need not be convex, and the parts of their Minkowski difference.

use super::meet::sides;
use super::penetration::{CornerInside, PolygonTest, distance_to_segment};
use super::{Convex, Point, SimplePolygon, minkowski_difference, penetration_depth};

/// Runs the polygon penetration test on two simple polygons. Finds the corners of each in the other, and the sides that
/// cross. `O(n m)`.
///
/// Signs are exact. The depth of a corner is its distance from the nearest side. The test is complete: if two polygons
/// meet and no corner of either lies in the other, then their boundaries cross at points that are not corners.
pub fn simple_polygon_test(a: &SimplePolygon, b: &SimplePolygon) -> PolygonTest {
    PolygonTest::of(a.corners(), b.corners(), [corners_inside(a, b), corners_inside(b, a)])
}

fn corners_inside(corners: &SimplePolygon, polygon: &SimplePolygon) -> Vec<CornerInside> {
    let to_side = |p: Point| sides(polygon.corners()).map(move |(a, b)| distance_to_segment(p, a, b));
    let inside = corners.corners().iter().enumerate().filter(|(_, p)| polygon.contains(**p));
    inside.map(|(corner, &p)| CornerInside { corner, depth: to_side(p).fold(f64::INFINITY, f64::min) }).collect()
}

/// The Minkowski difference `b - a` of two simple polygons, and the depth of the origin in it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimpleDifference {
    /// Convex polygons whose union is the difference: one for each pair of a convex piece of `b` and one of `a`.
    pub parts: Vec<Vec<Point>>,
    /// Greatest depth of the origin in one of the parts, metres. If the origin is in no part, it is minus the distance
    /// of the polygons. If there is a single part, it is the penetration depth: the length of the shortest translation
    /// that separates the polygons. Otherwise it is a lower bound on that length.
    pub depth: f64,
}

/// Computes the Minkowski difference `b - a` of two simple polygons: the translations that make `a` meet `b`.
///
/// The polygons are cut into convex pieces. Each pair of pieces has a difference, found by [`minkowski_difference`].
pub fn simple_difference(b: &SimplePolygon, a: &SimplePolygon) -> SimpleDifference {
    let (b, a) = (b.convex_pieces(), a.convex_pieces());
    let pairs = || b.iter().flat_map(|q| a.iter().map(move |p| (q, p)));
    let parts = pairs().map(|(q, p): (&Convex, &Convex)| minkowski_difference(q.core(), p.core())).collect();
    let depth = pairs().map(|(q, p)| penetration_depth(p, q)).fold(f64::NEG_INFINITY, f64::max);
    SimpleDifference { parts, depth }
}
