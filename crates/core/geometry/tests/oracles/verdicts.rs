//! Exact verdicts: whether shapes meet, and the location of points.

use cplan_geometry::{Location, Point, point_penetration, shapes_meet};
use cplan_testkit::shapes::{convex, disc, wall};
use proptest::prelude::*;

use crate::lattice::{core, cross, meet, point, points};

proptest! {
    #![proptest_config(cplan_cases::cases(4000))]

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
}

#[test]
fn discs_meet_up_to_their_radii() {
    let disc = |x: f64| disc(Point::new(x, 0.0), 1.0);
    assert!(shapes_meet(&disc(0.0), &disc(2.0)));
    assert!(!shapes_meet(&disc(0.0), &disc(2.0 + 1e-12)));
    assert!(shapes_meet(&disc(0.0), &wall(Point::new(-5.0, 1.0), Point::new(5.0, 1.0))));
}
