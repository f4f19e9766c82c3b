//! Blends, compared with dense samples.

use crate::curve;
use cplan::check::{CollisionCheck, blend, certify, certify_at, check_collision, limit_violations};
use cplan::model::Scene;
use cplan::motion::{Limits, time};
use cplan::space::{Configuration, Path, Recording};
use cplan_testkit::arms::{self, all_kinds};
use cplan_testkit::scenes::{clutter, q, scene};
use cplan_testkit::shapes::disc;
use proptest::prelude::*;

/// Returns the least distance at `n` places of each blend, by the definition of the curve.
fn least_sampled_distance(scene: &Scene, waypoints: &[Configuration], radii: &[f64], n: u32) -> f64 {
    let mut least = f64::INFINITY;
    for i in 1..waypoints.len() - 1 {
        let corner = waypoints[i];
        let toward = |end: Configuration| corner + (end - corner) * (radii[i] / (end - corner).norm());
        let (from, to) = (toward(waypoints[i - 1]), toward(waypoints[i + 1]));
        for j in 0..=n {
            let u = f64::from(j) / f64::from(n);
            let at = from * ((1.0 - u) * (1.0 - u)) + corner * (2.0 * u * (1.0 - u)) + to * (u * u);
            least = least.min(scene.clearance(at));
        }
    }
    least
}

proptest! {
    #![proptest_config(cplan_cases::cases(96))]

    #[test]
    fn blends_satisfy_the_proven_clearance(
        kind in 0_usize..5, corners in prop::collection::vec(prop::array::uniform2(0.0..1.0_f64), 3..5),
        reach in 0.05..0.7_f64, asked in prop_oneof![Just(0.0), 0.0..0.05_f64],
    ) {
        let scene = scene(all_kinds().swap_remove(kind), clutter());
        let domain = [0, 1].map(|k| scene.arm().topology().ranges[k].domain());
        let place = |k: usize, t: f64| domain[k].0 + t * (domain[k].1 - domain[k].0);
        let near = |k: usize, t: f64| place(k, corners[0][k] + reach * (t - corners[0][k]));
        let waypoints: Vec<_> = corners.iter().map(|c| q(near(0, c[0]), near(1, c[1]))).collect();
        let Ok(path) = certify_at(&scene, Path::new(waypoints.clone()), asked) else { return Ok(()) };
        let curve = blend(&scene, &path, f64::INFINITY, asked);
        let radii = curve.curve().radii();
        prop_assert!(radii[1..radii.len() - 1].iter().all(|radius| *radius > 0.0), "room for some radius: {radii:?}");
        let seen = least_sampled_distance(&scene, &waypoints, radii, 2000);
        prop_assert!(curve.clearance() <= path.clearance() && curve.clearance() <= seen, "{} {seen}", curve.clearance());
        prop_assert!(curve.clearance() >= asked + 0.5 * (path.clearance() - asked));
        let nearest = curve.nearest().expect("there are obstacles");
        prop_assert!((scene.clearance(nearest.at) - nearest.contact.separation.distance).abs() < 1e-12);
        // Smaller radii keep at least this clearance.
        let small = blend(&scene, &path, 0.01, asked);
        prop_assert!(small.curve().radii().iter().all(|radius| *radius <= 0.01));

        // The motion as other programs interpolate it: the cubic through positions and velocities.
        let trajectory = time(curve.clone(), &Limits::from(&scene.arm().joints), 0.02).unwrap().trajectory;
        let rows = |rows: &[[f64; 2]]| rows.iter().map(|row| q(row[0], row[1])).collect();
        let recording =
            Recording::new(rows(&trajectory.position), Some(trajectory.time.clone()), Some(rows(&trajectory.velocity)));
        let recording = recording.unwrap();
        prop_assert_eq!(limit_violations(&scene.arm().joints, &recording), []);
        let verdict = check_collision(&scene, &recording, asked);
        let CollisionCheck::Free { clearance, .. } = verdict else { panic!("{verdict:?}") };
        prop_assert!(clearance >= 0.9 * curve.clearance());
    }
}

/// Checks a post that the straight path passes closely. The blend is as large as the distance from the post allows, and
/// no larger.
#[test]
fn the_clearance_bounds_the_radius() {
    // A tool of radius 0.1 at (x, y), and a post inside the right angle of its path.
    let (mut gantry, _) = crate::empty([1.0, 1.0], [4.0, 4.0]).into_parts();
    gantry.links[1] = arms::link("tool", vec![disc(cplan::geometry::Point::zeros(), 0.1)]);
    let post = disc(cplan::geometry::Point::new(0.8, 0.2), 0.05);
    let scene = scene(gantry, vec![post]);
    let path = certify(&scene, Path::new(vec![q(0.0, 0.0), q(1.0, 0.0), q(1.0, 1.0)])).unwrap();
    // The segments pass the post at 0.2 - 0.15 = 0.05. The middle of a blend of radius r passes it at (0.2 - r / 4)
    // sqrt 2 - 0.15, along the diagonal.
    let curve = blend(&scene, &path, f64::INFINITY, 0.0);
    let radius = curve.curve().radii()[1];
    let middle = |r: f64| (0.2 - r / 4.0) * 2f64.sqrt() - 0.15;
    assert!(curve.clearance() >= 0.5 * path.clearance() && curve.clearance() <= middle(radius));
    assert!(radius > 0.25 && radius < 0.9, "{radius}");
    assert!(middle(1.3 * radius) < 0.5 * path.clearance() / 0.9, "{radius} could be larger");
    // With a clearance that leaves no room, the corner stays sharp.
    let tight = blend(&scene, &path, f64::INFINITY, path.clearance());
    assert_eq!(tight.curve().radii(), [0.0; 3]);
}

#[test]
fn neighbouring_blends_share_the_leg_between_them() {
    let scene = crate::empty([1.0, 1.0], [1.0, 1.0]);
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [3.0, 1.0]];
    assert_eq!(curve(&scene, &points, f64::INFINITY).curve().radii(), [0.0, 0.45, 0.45, 0.0]);
    assert_eq!(curve(&scene, &points, 0.1).curve().radii(), [0.0, 0.1, 0.1, 0.0]);
    assert_eq!(curve(&scene, &points[..3], f64::INFINITY).curve().radii(), [0.0, 0.9, 0.0]);
}
