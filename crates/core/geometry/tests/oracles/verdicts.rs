//! Exact verdicts: whether shapes meet, and the location of points.

use cplan_geometry::{Location, Point, hull, point_penetration, polygon_test, shapes_meet};
use cplan_testkit::shapes::{convex, disc, wall};
use proptest::prelude::*;

use crate::lattice::{core, cross, meet, point, points};

/// Moves a coordinate by a few units in the last place, for shapes that almost or barely touch.
fn moved_by_ulps(x: f64, steps: i8) -> f64 {
    (0..steps.unsigned_abs()).fold(x, |x, _| if steps > 0 { x.next_up() } else { x.next_down() })
}

proptest! {
    #![proptest_config(cplan_cases::cases(4000))]

    #[test]
    fn lattice_shapes_meet_as_integers_say(a in core(), b in core()) {
        let expected = meet(&a, &b);
        let (a, b) = (convex(points(&a), 0.0), convex(points(&b), 0.0));
        prop_assert_eq!(polygon_test(&a, &b).meet, expected);
        prop_assert_eq!(polygon_test(&b, &a).meet, expected);
        prop_assert_eq!(shapes_meet(&a, &b), expected);
        prop_assert_eq!(shapes_meet(&b, &a), expected);
    }

    #[test]
    fn point_penetration_agrees_with_integers(polygon in core(), p in (-4..=4i64, -4..=4i64)) {
        let n = polygon.len();
        let found = point_penetration(point(p), &convex(points(&polygon), 0.0));
        let signs: Vec<i64> = (0..n).map(|i| cross(polygon[i], polygon[(i + 1) % n], p).signum()).collect();
        let expected = match (meet(&polygon, &[p]), signs.iter().all(|&s| s > 0)) {
            (false, _) => Location::Outside,
            (true, inside) => if inside { Location::Inside } else { Location::Boundary },
        };
        prop_assert_eq!(found.location, expected);
        if n > 1 {
            // The textbook formula, from the coefficients of the line.
            let distance = |i: usize| {
                let ((x1, y1), (x2, y2)) = (polygon[i], polygon[(i + 1) % n]);
                let (a, b, c) = (y1 - y2, x2 - x1, x1 * y2 - x2 * y1);
                (a * p.0 + b * p.1 + c) as f64 / ((a * a + b * b) as f64).sqrt()
            };
            let distances: Vec<f64> = (0..n).map(distance).collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
            for (x, y) in found.distances.iter().zip(&distances) {
                prop_assert!((x - y).abs() < 1e-14);
            }
            prop_assert!((found.depth - least).abs() < 1e-14);
            prop_assert_eq!(found.depth, found.distances[found.side.unwrap()]);
        }
    }

    #[test]
    fn nudged_shapes_get_one_verdict(
        a in core(), b in core(),
        steps in prop::collection::vec((-2..=2i8, -2..=2i8), 14),
    ) {
        // Tenths are not binary fractions, so nudged corners lie on either side of the sides that they touched. No
        // coordinate is 0, because the neighbours of 0 (5e-324) are below the range that the predicates guarantee.
        let nudge = |corners: &[(i64, i64)], steps: &[(i8, i8)]| {
            let nudged = corners.iter().zip(steps).map(|(p, s)| {
                Point::new(moved_by_ulps((p.0 + 5) as f64 / 10.0, s.0), moved_by_ulps((p.1 + 5) as f64 / 10.0, s.1))
            });
            convex(hull(&nudged.collect::<Vec<_>>()), 0.0)
        };
        let (a, b) = (nudge(&a, &steps[..7]), nudge(&b, &steps[7..]));
        let verdict = polygon_test(&a, &b).meet;
        prop_assert_eq!(verdict, polygon_test(&b, &a).meet);
        prop_assert_eq!(verdict, shapes_meet(&a, &b));
    }
}

#[test]
fn crossing_bars_have_crossings_only() {
    let bar = |x: f64, y: f64| [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| Point::new(x, y));
    let bar = |x: f64, y: f64| convex(bar(x, y).to_vec(), 0.0);
    let found = polygon_test(&bar(3.0, 0.5), &bar(0.5, 3.0));
    assert!(found.meet && found.a_inside.is_empty() && found.b_inside.is_empty());
    assert_eq!(found.crossings, [(0, 1), (0, 3), (2, 1), (2, 3)]);
}

#[test]
fn discs_meet_up_to_their_radii() {
    let disc = |x: f64| disc(Point::new(x, 0.0), 1.0);
    assert!(shapes_meet(&disc(0.0), &disc(2.0)));
    assert!(!shapes_meet(&disc(0.0), &disc(2.0 + 1e-12)));
    assert!(shapes_meet(&disc(0.0), &wall(Point::new(-5.0, 1.0), Point::new(5.0, 1.0))));
}
