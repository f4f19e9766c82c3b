//! Distance and penetration depth: two methods of the library against each other, against their definition, and against
//! parry2d.

use cplan_geometry::{Convex, Point, Separation, Vector, hull, penetration_depth, separation, shapes_meet};
use cplan_testkit::shapes::{convex, disc, wall};
use proptest::prelude::*;

use crate::lattice::{core, points};
use cplan_testkit::parry;

/// Bound on the rounding errors of the library's distances, for coordinates up to some tens.
const ROUNDING: f64 = 1e-13;
/// Relative tolerance for distances of parry. parry iterates (GJK) and stops at a relative error of about the square
/// root of epsilon. Its penetration depths (EPA) are not compared: for some overlapping lattice polygons version 0.31
/// answers 2/3, although every direction needs 1 or more.
const PARRY: f64 = 1e-6;

/// Generates lattice shapes with a scale that is not a binary fraction. So sides are collinear, or touch, only up to
/// rounding.
fn lattice_shape() -> impl Strategy<Value = Convex> {
    let scale = prop::sample::select(vec![1.0, 0.1, 1.0 / 3.0]);
    let radius = prop::sample::select(vec![0.0, 0.0, 0.05, 1.0]);
    (core(), scale, radius).prop_map(|(core, scale, radius)| {
        let corners: Vec<Point> = points(&core).iter().map(|p| p * scale).collect();
        convex(hull(&corners), radius)
    })
}

fn random_shape() -> impl Strategy<Value = Convex> {
    let corner = (-3.0..3.0f64, -3.0..3.0f64).prop_map(|(x, y)| Point::new(x, y));
    (prop::collection::vec(corner, 1..8), -3.0..3.0f64, prop::sample::select(vec![0.0, 0.1])).prop_map(
        |(corners, x, radius)| {
            let moved: Vec<Point> = corners.iter().map(|p| p + Vector::new(x, 0.0)).collect();
            convex(hull(&moved), radius)
        },
    )
}

/// Returns the gap between two shapes along a unit direction: positive if a line across it separates them.
fn gap(a: &Convex, b: &Convex, direction: Vector) -> f64 {
    let along = |p: &Point| direction.dot(p);
    let front = a.core().iter().map(along).fold(f64::NEG_INFINITY, f64::max) + a.radius();
    let back = b.core().iter().map(along).fold(f64::INFINITY, f64::min) - b.radius();
    back - front
}

fn check(a: &Convex, b: &Convex) -> Result<(), TestCaseError> {
    let Separation { distance, direction } = separation(a, b);
    prop_assert!((direction.norm() - 1.0).abs() < ROUNDING);
    prop_assert!((distance + penetration_depth(a, b)).abs() < ROUNDING, "{distance} {}", penetration_depth(a, b));
    // The direction attains the distance, and (by definition of both measures) none has a greater gap.
    prop_assert!((gap(a, b, direction) - distance).abs() < ROUNDING, "gap {}", gap(a, b, direction));
    for k in 0..64 {
        let angle = f64::from(k) / 64.0 * std::f64::consts::TAU;
        prop_assert!(gap(a, b, Vector::new(angle.cos(), angle.sin())) < distance + ROUNDING);
    }
    prop_assert!((separation(b, a).distance - distance).abs() < ROUNDING);
    if distance.abs() > ROUNDING {
        prop_assert_eq!(shapes_meet(a, b), distance < 0.0);
    }
    let cores = distance + a.radius() + b.radius();
    if let Some(expected) = parry::core_distance(a, b) {
        prop_assert!((cores.max(0.0) - expected).abs() < PARRY, "parry: {expected}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(cplan_cases::cases(2000))]

    #[test]
    fn distances_of_lattice_shapes_agree_with_the_oracle(a in lattice_shape(), b in lattice_shape()) {
        check(&a, &b)?;
    }

    #[test]
    fn distances_of_random_shapes_agree_with_the_oracle(a in random_shape(), b in random_shape()) {
        check(&a, &b)?;
    }

    #[test]
    fn collinear_walls_have_their_distance(angle in 0.0..6.3f64, ends in prop::collection::vec(-5.0..5.0f64, 4), radius in 0.0..0.5f64) {
        // Collinear up to rounding: no side normal separates them, yet they may be far apart.
        let at = |t: f64| Point::new(0.3 + t * angle.cos(), -0.7 + t * angle.sin());
        let wall = |s: f64, t: f64| wall(at(s), at(t)).grown(radius);
        let (a, b) = (wall(ends[0], ends[1]), wall(ends[2], ends[3]));
        let gap = ends[2].min(ends[3]) - ends[0].max(ends[1]);
        let expected = gap.max(ends[0].min(ends[1]) - ends[2].max(ends[3])).max(0.0) - 2.0 * radius;
        prop_assert!((separation(&a, &b).distance - expected).abs() < ROUNDING);
        check(&a, &b)?;
    }
}

#[test]
fn capsules_on_one_line_part_sideways() {
    let capsule = |s: f64, t: f64| wall(Point::new(s, 0.0), Point::new(t, 0.0)).grown(0.5);
    let found = separation(&capsule(0.0, 3.0), &capsule(1.0, 4.0));
    assert_eq!(found.distance, -1.0);
    assert_eq!(found.direction.x, 0.0);
}

#[test]
fn points_and_discs_have_their_distances_and_depths() {
    let point = disc(Point::new(1.0, 2.0), 0.0);
    assert_eq!(separation(&point, &point).distance, 0.0);
    assert_eq!(separation(&point.grown(0.25), &point.grown(0.5)).distance, -0.75);
    assert_eq!(penetration_depth(&point.grown(0.25), &point.grown(0.5)), 0.75);
    assert_eq!(separation(&point, &disc(Point::new(4.0, 6.0), 1.0)).distance, 4.0);
}
