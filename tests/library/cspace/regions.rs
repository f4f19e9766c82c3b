//! Polygonal regions, compared with distances of sampled configurations.

use cplan::cspace::{PolygonWithHoles, Proves, Regions, c_obstacles, inner_regions, regions};
use cplan::geometry::{Convex, Point, Vector, cross};
use cplan::model::{Arm, Joint, JointType, Scene, Workspace};
use cplan::space::{Configuration, JointRange};
use cplan_testkit::arms::{arm, joint, link};
use cplan_testkit::problems::{Benchmark, benchmark};
use cplan_testkit::scenes::{self, placed};
use cplan_testkit::shapes::convex;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn scene(joints: [Joint; 2], offset: Vector, links: [Vec<Convex>; 2], pieces: Vec<Convex>, clearance: f64) -> Scene {
    let arm = arm(joints, links.map(|shapes| link("link", shapes)), offset, Point::new(0.8, 0.0));
    let arm = Arm { base: Point::new(0.02, -0.01), ..arm };
    scenes::scene(arm, pieces).with_clearance(clearance).expect("a clearance")
}

fn polygon(corners: &[(f64, f64)]) -> Convex {
    convex(corners.iter().map(|&(x, y)| Point::new(x, y)).collect(), 0.0)
}

/// Returns the scene of a benchmark: two continuous joints, and four convex obstacles.
fn torus(which: Benchmark) -> Scene {
    benchmark(which).0
}

/// Generates corners of a regular polygon, a disc, a thin wall or a point.
fn shape(size: f64) -> impl Strategy<Value = Convex> {
    (1usize..7, 0.2..1.0f64, 0.0..TAU, (-1.0..1.0f64, -1.0..1.0f64), prop_oneof![Just(0.0), 0.0..0.2f64]).prop_map(
        move |(n, scale, turn, (x, y), radius)| {
            let at = |i: usize| {
                let angle = turn + TAU * i as f64 / n as f64;
                Point::new(size * (x + scale * angle.cos()), size * (y + scale * angle.sin()))
            };
            convex((0..n).map(at).collect(), radius * size)
        },
    )
}

fn any_joint(name: &'static str) -> impl Strategy<Value = Joint> {
    let turning = (
        prop_oneof![Just(1.0), Just(-1.0)],
        prop_oneof![
            Just(JointRange::Circle),
            Just(JointRange::Interval { lower: -3.0, upper: 3.0 }),
            Just(JointRange::Interval { lower: -4.0, upper: 5.5 }),
        ],
    )
        .prop_map(|(sign, axis)| (JointType::Revolute { sign }, axis));
    let sliding = (0.0..TAU).prop_map(|angle: f64| {
        let direction = Vector::new(angle.cos(), angle.sin());
        (JointType::Prismatic { direction }, JointRange::Interval { lower: -0.7, upper: 1.1 })
    });
    prop_oneof![turning, sliding].prop_map(move |(motion, axis)| joint(name, motion, axis))
}

fn any_obstacle() -> impl Strategy<Value = Convex> {
    (shape(0.25), -1.5..1.5f64, -1.5..1.5f64).prop_map(|(shape, x, y)| {
        let core = shape.core().iter().map(|p| p + Vector::new(x, y)).collect();
        convex(core, shape.radius())
    })
}

fn any_scene() -> impl Strategy<Value = Scene> {
    (
        [any_joint("first"), any_joint("second")],
        (-0.2..1.0f64, -0.2..0.2f64),
        [prop::collection::vec(shape(0.3), 0..2), prop::collection::vec(shape(0.5), 1..3)],
        prop::collection::vec(any_obstacle(), 1..4),
        prop_oneof![Just(0.0), 0.0..0.05f64],
    )
        .prop_map(|(joints, (x, y), links, pieces, clearance)| {
            scene(joints, Vector::new(x, y), links, pieces, clearance)
        })
}

fn is_free(regions: &Regions, q: Configuration) -> bool {
    regions.component(q).is_some()
}

fn points(polygon: &PolygonWithHoles) -> impl Iterator<Item = (Point, Point)> + '_ {
    std::iter::once(&polygon.outer)
        .chain(&polygon.holes)
        .flat_map(|contour| (0..contour.len()).map(move |i| (contour[i], contour[(i + 1) % contour.len()])))
}

fn area(contour: &[Point]) -> f64 {
    let n = contour.len();
    (0..n).map(|i| cross(contour[i], contour[(i + 1) % n])).sum::<f64>() / 2.0
}

/// Returns true if no two sides cross, except neighbours.
fn is_simple(contour: &[Point]) -> bool {
    let n = contour.len();
    let side = |a: Point, b: Point, c: Point| cross(b - a, c - a);
    (0..n).all(|i| {
        (i + 2..n).all(|j| {
            let (a, b, c, d) = (contour[i], contour[i + 1], contour[j], contour[(j + 1) % n]);
            (j + 1) % n == i || side(a, b, c) * side(a, b, d) >= 0.0 || side(c, d, a) * side(c, d, b) >= 0.0
        })
    })
}

/// Returns evenly spread points of the window.
fn lattice(window: [(f64, f64); 2], n: usize) -> impl Iterator<Item = Configuration> {
    let at = move |k: usize, t: f64| window[k].0 + (window[k].1 - window[k].0) * t;
    (0..n).flat_map(move |i| {
        (0..n).map(move |j| Configuration::new(at(0, (i as f64 + 0.5) / n as f64), at(1, (j as f64 + 0.43) / n as f64)))
    })
}

/// Checks the margin of the regions. Places that are free in the regions must be free. Places with three times the
/// margin must be free in the regions.
fn check_margin_is_kept(scene: &Scene, margin: f64) -> Result<(), TestCaseError> {
    let keep = scene.workspace().clearance;
    let regions = regions(scene, margin, Configuration::new(0.3, -0.8), 1);
    prop_assert_eq!(regions.proves, Proves::Outer { margin });
    for q in lattice(regions.window, 60) {
        let clearance = scene.clearance(q);
        let free = is_free(&regions, q);
        prop_assert!(!free || clearance > keep, "{q} is free at {clearance}");
        prop_assert!(free || clearance <= keep + 3.0 * margin, "{q} is blocked at {clearance}");
    }
    // A mistake would show first on the boundary. There, too, the proven distance is kept.
    for (a, b) in regions.free.iter().flat_map(points) {
        for t in [0.0, 0.21, 0.5, 0.83] {
            let q = a + (b - a) * t;
            prop_assert!(scene.clearance(q) >= keep + 0.25 * margin - 1e-9, "{} at {q}", scene.clearance(q));
        }
    }
    Ok(())
}

/// Checks regions that overestimate free space. Places that are blocked in the regions must be blocked. Places that are
/// too near to an obstacle by more than the margin must be blocked in the regions.
fn check_loss_within_margin(scene: &Scene, regions: &Regions, margin: f64) -> Result<(), TestCaseError> {
    let keep = scene.workspace().clearance;
    prop_assert_eq!(regions.proves, Proves::Inner { margin });
    for q in lattice(regions.window, 60) {
        let clearance = scene.clearance(q);
        let free = is_free(regions, q);
        prop_assert!(free || clearance < keep, "{q} is blocked at {clearance}");
        prop_assert!(!free || clearance >= keep - margin - 1e-9, "{q} is free at {clearance}");
    }
    for (a, b) in regions.free.iter().flat_map(points) {
        for t in [0.0, 0.21, 0.5, 0.83] {
            let q = a + (b - a) * t;
            let is_limit =
                |k: usize| <[f64; 2]>::from(regions.window[k]).iter().any(|limit| (q[k] - limit).abs() < 1e-9);
            let clearance = scene.clearance(q);
            prop_assert!(clearance >= keep - margin - 1e-9, "{clearance} at {q}");
            prop_assert!(is_limit(0) || is_limit(1) || clearance < keep - 0.25 * margin, "{clearance} at {q}");
        }
    }
    Ok(())
}

/// Generates gantries: two slides, of which the second carries a shape.
fn any_gantry() -> impl Strategy<Value = Scene> {
    let slide = |name, angle: f64| {
        let direction = Vector::new(angle.cos(), angle.sin());
        joint(name, JointType::Prismatic { direction }, JointRange::Interval { lower: -1.0, upper: 1.2 })
    };
    let clearance = prop_oneof![Just(0.0), 0.0..0.05f64];
    (shape(0.3), prop::collection::vec(any_obstacle(), 1..6), 0.3..2.8f64, clearance).prop_map(
        move |(tool, pieces, angle, clearance)| {
            let joints = [slide("first", 0.2), slide("second", 0.2 + angle)];
            scene(joints, Vector::new(0.1, 0.2), [vec![], vec![tool]], pieces, clearance)
        },
    )
}

proptest! {
    #![proptest_config(cplan_cases::cases(96))]

    #[test]
    fn gantry_polygons_lose_at_most_the_margin(scene in any_gantry(), margin in prop_oneof![Just(1e-4), 0.001..0.02f64]) {
        // Pieces and tools that are thinner than the margin vanish.
        if let Some(regions) = inner_regions(&scene, margin) {
            check_loss_within_margin(&scene, &regions, margin)?;
        }
    }

    #[test]
    fn free_regions_are_free_and_clear_places_are_in_them(scene in any_scene(), margin in prop_oneof![Just(0.01), 0.002..0.03f64]) {
        check_margin_is_kept(&scene, margin)?;
    }

    #[test]
    fn contours_are_simple_and_oriented(scene in any_scene()) {
        let regions = regions(&scene, 0.01, Configuration::zeros(), 1);
        for polygon in &regions.free {
            prop_assert!(area(&polygon.outer) > 0.0 && is_simple(&polygon.outer));
            prop_assert!(polygon.holes.iter().all(|hole| area(hole) < 0.0 && is_simple(hole)));
        }
        for obstacle in &regions.obstacles {
            prop_assert!(area(&obstacle.contour) > 0.0 && is_simple(&obstacle.contour), "{:?}", obstacle.contour);
        }
    }
}

/// Checks a case that the property tests found. The only shapes are a thin wall across link 2, and a point. At one
/// place, one end of the wall begins to touch the point, and the other stops touching it.
#[test]
fn a_wall_that_meets_a_point_keeps_its_margin() {
    let turning = |name| joint(name, JointType::Revolute { sign: 1.0 }, JointRange::Circle);
    let wall = polygon(&[(0.4081276797182928, 0.3016264095245186), (-0.4081276797182928, 0.30162640952451863)]);
    let point = polygon(&[(0.05, 0.4365861856598767)]);
    let offset = Vector::new(0.0, 0.044567284175443776);
    let joints = [turning("first"), turning("second")];
    let scene = scene(joints, offset, [vec![], vec![wall]], vec![point], 0.023837485419749088);
    check_margin_is_kept(&scene, 0.01).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn copies_on_the_torus_agree() {
    let regions = regions(&torus(Benchmark::A), 1e-3, Configuration::new(-0.7, 0.0), 1);
    let half = [0, 1].map(|k| (regions.window[k].0, regions.window[k].0 + TAU));
    for q in lattice(half, 80) {
        for shift in [(TAU, 0.0), (0.0, TAU), (TAU, TAU)] {
            let copy = q + Configuration::new(shift.0, shift.1);
            assert_eq!(is_free(&regions, q), is_free(&regions, copy), "{q}");
        }
    }
}

#[test]
fn free_area_converges_from_below() {
    let scene = torus(Benchmark::A);
    let areas: Vec<f64> = [4e-3, 2e-3, 1e-3, 5e-4]
        .iter()
        .map(|&margin| regions(&scene, margin, Configuration::zeros(), 1).free.iter().map(PolygonWithHoles::area).sum())
        .collect();
    let gains: Vec<f64> = areas.windows(2).map(|w| w[1] - w[0]).collect();
    // The error is linear in the margin. So half the margin gives roughly half the gain.
    assert!(gains.iter().all(|&g| g > 0.0), "{areas:?}");
    assert!(gains.windows(2).all(|w| w[1] < 0.75 * w[0]), "{areas:?}");
}

/// Returns true if one component of free space contains the start and a copy of the goal.
fn connects_start_and_goal(scene: &Scene, margin: f64, goal: Configuration) -> bool {
    let start = Configuration::new(-0.7, 0.0);
    let regions = regions(scene, margin, start, 1);
    let from = Some(regions.component(start).expect("the start is free"));
    (-2..=2).any(|i| {
        (-2..=2).any(|j| {
            let copy = goal + TAU * Configuration::new(f64::from(i), f64::from(j));
            let inside = (0..2).all(|k| regions.window[k].0 <= copy[k] && copy[k] <= regions.window[k].1);
            inside && regions.component(copy) == from
        })
    })
}

#[test]
fn narrow_passages_stay_open_and_walls_closed() {
    for (which, margins, connects) in [
        (Benchmark::A, &[1e-3][..], true),
        (Benchmark::B, &[1e-3], true),
        (Benchmark::Inf, &[1e-3], false),
        (Benchmark::T, &[1e-3, 1e-4, 1e-5], false),
    ] {
        let (scene, _, goal) = benchmark(which);
        for margin in margins {
            assert_eq!(connects_start_and_goal(&scene, *margin, goal), connects, "{which:?}, margin {margin}");
        }
    }
}

#[test]
fn a_gantry_without_margin_is_exact() {
    let slide = |name, direction| {
        joint(name, JointType::Prismatic { direction }, JointRange::Interval { lower: -2.0, upper: 2.0 })
    };
    // Slides 60 degrees apart. The second one is turned clockwise, so that the map to joint values is a reflection.
    let joints = [slide("x", Vector::x()), slide("y", Vector::new(0.5, -0.75f64.sqrt()))];
    let tool = polygon(&[(-0.1, -0.1), (0.2, -0.1), (0.0, 0.15)]);
    let block = polygon(&[(0.5, 0.2), (0.9, 0.1), (1.0, 0.6), (0.6, 0.7)]);
    let scene = scene(joints, Vector::zeros(), [vec![], vec![tool]], vec![block], 0.0);
    let contours = c_obstacles(&scene, 0.0, 1e-3);
    assert_eq!(contours.len(), 1);
    let exact = PolygonWithHoles { outer: contours[0].contour.clone(), holes: vec![] };
    assert_eq!(exact.outer.len(), 7);
    assert!(exact.area() > 0.0);
    for q in lattice([(-2.0, 2.0), (-2.0, 2.0)], 150) {
        let distance = scene.clearance(q);
        assert!(distance.abs() < 1e-9 || exact.contains(q) == (distance < 0.0), "{q}: {distance}");
    }
}

#[test]
fn windows_follow_axes() {
    let (mut arm, workspace) = torus(Benchmark::A).into_parts();
    arm.joints[1].range = JointRange::Interval { lower: -2.0, upper: 2.5 };
    let scene = placed(arm, workspace);
    let regions = regions(&scene, 1e-2, Configuration::new(1.0, 0.0), 2);
    assert_eq!(regions.window, [(1.0 - 2.0 * TAU, 1.0 + 2.0 * TAU), (-2.0, 2.5)]);
    for point in regions.free.iter().flat_map(points).map(|(a, _)| a) {
        assert!((0..2).all(|k| regions.window[k].0 <= point[k] && point[k] <= regions.window[k].1));
    }
}

#[test]
fn without_obstacles_the_window_is_free() {
    let (arm, workspace) = torus(Benchmark::A).into_parts();
    let scene = placed(arm, Workspace { obstacles: Vec::new(), ..workspace });
    let regions = regions(&scene, 1e-3, Configuration::zeros(), 1);
    assert_eq!(regions.free.len(), 1);
    assert!((regions.free[0].area() - (4.0 * PI).powi(2)).abs() < 1e-9);
}
