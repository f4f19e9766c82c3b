//! The penetration test and the difference of simple polygons, against integer arithmetic and sampled translations.

use crate::lattice::{self, Corner, cross};
use cplan_geometry::{Point, SimplePolygon, polygon_test, simple_difference, simple_polygon_test};
use proptest::prelude::*;

/// Returns simple polygons of the lattice: random points in the order of a random list, if their boundary is simple.
fn simple() -> impl Strategy<Value = (Vec<Corner>, SimplePolygon)> {
    prop::collection::vec((0..7i64, 0..7i64), 3..8).prop_filter_map("a simple polygon", |corners| {
        let points = corners.iter().map(|&(x, y)| Point::new(x as f64, y as f64)).collect();
        let polygon = SimplePolygon::new(points).ok()?;
        let corners = polygon.corners().iter().map(|p| (p.x as i64, p.y as i64)).collect();
        Some((corners, polygon))
    })
}

fn sides(polygon: &[Corner]) -> impl Iterator<Item = (Corner, Corner)> + '_ {
    (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]))
}

/// Returns 0 outside of the polygon, 1 on its boundary, 2 inside, by the winding number.
fn location(p: Corner, polygon: &[Corner]) -> u8 {
    if sides(polygon).any(|(a, b)| lattice::meet(&[p], &[a, b])) {
        return 1;
    }
    let winding = |(a, b): (Corner, Corner)| match (a.1 <= p.1, b.1 <= p.1) {
        (true, false) if cross(a, b, p) > 0 => 1,
        (false, true) if cross(a, b, p) < 0 => -1,
        _ => 0,
    };
    if sides(polygon).map(winding).sum::<i64>() == 0 { 0 } else { 2 }
}

fn crosses((a, b): (Corner, Corner), (c, d): (Corner, Corner)) -> bool {
    let parts = |a, b, p, q| cross(a, b, p).signum() * cross(a, b, q).signum() < 0;
    parts(a, b, c, d) && parts(c, d, a, b)
}

/// Returns true if two closed polygons have a point in common: their sides meet, or one contains the other.
fn meet(a: &[Corner], b: &[Corner]) -> bool {
    let sides_meet = |(a, b): (Corner, Corner), (c, d): (Corner, Corner)| lattice::meet(&[a, b], &[c, d]);
    sides(a).any(|s| sides(b).any(|t| sides_meet(s, t))) || location(a[0], b) > 0 || location(b[0], a) > 0
}

proptest! {
    #![proptest_config(cplan_cases::cases(1000))]

    #[test]
    fn the_test_of_simple_polygons_agrees_with_integer_arithmetic(a in simple(), b in simple()) {
        let ((a, polygon_a), (b, polygon_b)) = (a, b);
        let test = simple_polygon_test(&polygon_a, &polygon_b);
        let inside = |corners: &[Corner], polygon: &[Corner]| -> Vec<usize> {
            (0..corners.len()).filter(|&i| location(corners[i], polygon) > 0).collect()
        };
        let numbers = |found: &[cplan_geometry::CornerInside]| found.iter().map(|c| c.corner).collect::<Vec<_>>();
        prop_assert_eq!(numbers(&test.a_inside), inside(&a, &b));
        prop_assert_eq!(numbers(&test.b_inside), inside(&b, &a));
        for found in &test.a_inside {
            prop_assert_eq!(found.depth > 0.0, location(a[found.corner], &b) == 2);
        }
        let crossings: Vec<(usize, usize)> = (0..a.len())
            .flat_map(|i| (0..b.len()).map(move |k| (i, k)))
            .filter(|&(i, k)| crosses((a[i], a[(i + 1) % a.len()]), (b[k], b[(k + 1) % b.len()])))
            .collect();
        prop_assert_eq!(&test.crossings, &crossings);
        prop_assert_eq!(test.meet, meet(&a, &b));
        // For convex polygons, the classical test gives the same depths.
        let [convex_a, convex_b] = [&polygon_a, &polygon_b].map(|p| cplan_geometry::Convex::new(p.corners().to_vec(), 0.0));
        if let (Ok(convex_a), Ok(convex_b)) = (convex_a, convex_b) {
            let classical = polygon_test(&convex_a, &convex_b);
            for (one, other) in test.a_inside.iter().zip(&classical.a_inside) {
                prop_assert!((one.depth - other.depth).abs() < 1e-12);
            }
            prop_assert_eq!((test.meet, numbers(&test.b_inside)), (classical.meet, numbers(&classical.b_inside)));
        }
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(60))]

    /// Compares the translations of the lattice that make the polygons meet with the points of the difference.
    #[test]
    fn the_parts_of_the_difference_are_the_translations_that_collide(a in simple(), b in simple()) {
        let ((a, polygon_a), (b, polygon_b)) = (a, b);
        let difference = simple_difference(&polygon_b, &polygon_a);
        let parts: Vec<Vec<Corner>> =
            difference.parts.iter().map(|part| part.iter().map(|p| (p.x as i64, p.y as i64)).collect()).collect();
        for x in -8..=8 {
            for y in -8..=8 {
                let moved: Vec<Corner> = a.iter().map(|p| (p.0 + x, p.1 + y)).collect();
                let contained = parts.iter().any(|part| location((x, y), part) > 0);
                prop_assert_eq!(contained, meet(&moved, &b), "({}, {})", x, y);
            }
        }
        prop_assert_eq!(difference.depth >= -1e-12, meet(&a, &b));
    }
}
