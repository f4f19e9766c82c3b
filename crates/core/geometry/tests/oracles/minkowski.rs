//! Minkowski differences against brute force and against identities of convex geometry.

use cplan_geometry::{Point, Vector, hull};
use cplan_testkit::shapes::{convex, disc, wall};
use proptest::prelude::*;

use crate::lattice::points;

/// Returns the difference of two polygons.
fn difference(b: Vec<Point>, a: Vec<Point>) -> Vec<Point> {
    convex(b, 0.0).minkowski_difference(&convex(a, 0.0)).core().to_vec()
}

fn sides(polygon: &[Point]) -> impl Iterator<Item = Vector> {
    (0..polygon.len()).map(|i| polygon[(i + 1) % polygon.len()] - polygon[i])
}

/// Returns the greatest value of `n . p` over the polygon.
fn support(polygon: &[Point], n: Vector) -> f64 {
    polygon.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max)
}

/// Generates polygons from points on a circle of random radius, at a random position.
fn polygon() -> impl Strategy<Value = Vec<Point>> {
    let angles = prop::collection::vec(0.0..std::f64::consts::TAU, 1..20);
    (angles, 0.01..10.0f64, -10.0..10.0f64, -10.0..10.0f64).prop_map(|(angles, r, x, y)| {
        let on_circle = |t: f64| Point::new(x + r * t.cos(), y + r * t.sin());
        hull(&angles.into_iter().map(on_circle).collect::<Vec<_>>())
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(2000))]

    #[test]
    fn support_area_and_perimeter_add_up(a in polygon(), b in polygon(), direction in 0.0..std::f64::consts::TAU) {
        let difference = difference(b.clone(), a.clone());
        let minus_a: Vec<Point> = a.iter().map(|p| -p).collect();
        let n = Vector::new(direction.cos(), direction.sin());
        let tolerance = 1e-12;
        prop_assert!((support(&difference, n) - support(&b, n) - support(&minus_a, n)).abs() < 100.0 * tolerance);
        prop_assert!(difference.len() <= a.len() + b.len());

        let length = |polygon: &[Point]| sides(polygon).map(|s| s.norm()).sum::<f64>();
        prop_assert!((length(&difference) - length(&a) - length(&b)).abs() < 1000.0 * tolerance);

        // area(B + K) = area(B) + sum over the sides of B of (length times support of K) + area(K).
        let mixed: f64 = sides(&b).map(|s| support(&minus_a, Vector::new(s.y, -s.x))).sum();
        let area = |polygon: &[Point]| convex(polygon.to_vec(), 0.0).area();
        prop_assert!((area(&difference) - area(&b) - mixed - area(&a)).abs() < 1e4 * tolerance);
    }
}

#[test]
fn radii_add_up() {
    let (a, b) = (disc(Point::new(1.0, 2.0), 0.25), wall(Point::new(0.0, 0.0), Point::new(1.0, 0.0)));
    let difference = b.grown(0.5).minkowski_difference(&a);
    assert_eq!(difference.radius(), 0.75);
    assert_eq!(difference.core(), [Point::new(-1.0, -2.0), Point::new(0.0, -2.0)]);
    // Cores without length are allowed.
    assert_eq!(wall(Point::zeros(), Point::zeros()).core().len(), 1);
}

#[test]
fn negative_zero_does_not_mislead_the_sweep() {
    let square = [(0.0, 0.0), (1.0, -0.0), (1.0, 1.0), (-0.0, 1.0)].map(|(x, y)| Point::new(x, y));
    let expected = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Point::new(x, y));
    assert_eq!(difference(square.to_vec(), square.to_vec()), expected);
}

#[test]
fn straight_corners_of_the_operands_are_dropped() {
    let square = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (0, 2), (0, 1)];
    let wall = [(0, 0), (3, 0)];
    assert_eq!(difference(points(&square), points(&wall)), points(&[(-3, 0), (2, 0), (2, 2), (-3, 2)]));
}
