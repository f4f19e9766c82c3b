//! The judge, compared with dense samples and with problems whose answers are known.

use crate::certificates::oracle::reached_past;
use cplan::check::{
    CertifiedPath, CollisionBox, Deviation, Posture, ProofError, Rejection, StraightMotions, certify, certify_at,
};
use cplan::geometry::Point;
use cplan::model::Scene;
use cplan::proofs::{Connectivity, Occupancy, connectivity, explore};
use cplan::space::{Configuration, JointRange, LimitedValue, Path};
use cplan_testkit::arms::{all_kinds, gantry, link, rr};
use cplan_testkit::problems::{Benchmark, benchmark, recheck};
use cplan_testkit::scenes::{clutter, configuration_at_fractions, q, scene};
use cplan_testkit::shapes::{disc, rectangle, wall};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Returns the least distance at `n` evenly spaced configurations of each segment.
fn least_sampled_distance(scene: &Scene, path: &Path, n: u32) -> f64 {
    path.segments()
        .flat_map(|(a, b)| (0..=n).map(move |i| a + (b - a) * (f64::from(i) / f64::from(n))))
        .map(|q| scene.clearance(q))
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(cplan_cases::cases(64))]

    #[test]
    fn verdict_and_clearance_agree_with_dense_sampling(
        kind in 0_usize..5, a in (0.0..1.0_f64, 0.0..1.0_f64), b in (0.0..1.0_f64, 0.0..1.0_f64), t in 0.05..1.0_f64,
    ) {
        let scene = scene(all_kinds().swap_remove(kind), clutter());
        let (from, to) = (configuration_at_fractions(&scene, a), configuration_at_fractions(&scene, b));
        let path = Path::new(vec![from, from + (to - from) * t]);
        let seen = least_sampled_distance(&scene, &path, 4000);
        let keeps = |clearance: f64| StraightMotions::new(&scene, clearance).is_free(path.start(), path.goal());
        prop_assert!(!keeps(0.0) || seen > 0.0);
        prop_assert!(!keeps(0.1) || seen >= 0.1);
        prop_assert!(keeps(0.1) || seen < 0.1 + 8.0 / 4000.0);
        let is_free = keeps(0.0);
        match certify(&scene, path) {
            Ok(certified) => {
                prop_assert!(is_free && certified.clearance() > 0.0);
                prop_assert!(certified.clearance() <= seen + 1e-12);
                // A sample is at most half a step away from the nearest configuration.
                prop_assert!(certified.clearance() >= 0.9 * (seen - 8.0 / 4000.0));
            }
            Err(Rejection::TooClose(nearest)) => {
                prop_assert!(scene.clearance(nearest.at) <= 0.0);
                prop_assert!(seen <= 8.0 / 4000.0);
            }
            Err(other) => prop_assert!(seen < 1e-6, "{other:?} at a sampled clearance of {seen}"),
        }
    }

    #[test]
    fn bounds_hold_for_every_deviation(
        kind in 0_usize..5, at in (0.0..1.0_f64, 0.0..1.0_f64), half in (0.0..0.3_f64, 0.0..0.3_f64),
        deviations in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 64),
    ) {
        let scene = scene(all_kinds().swap_remove(kind), clutter());
        let middle = configuration_at_fractions(&scene, at);
        let posture = Posture::new(&scene, middle);
        let along = q(half.0, -half.1);
        for (i, &pair) in scene.pairs().iter().enumerate() {
            let boxed = Deviation::Box([half.0, half.1]);
            let (least, greatest) = (posture.bound(pair, boxed).least, posture.greatest(pair, boxed));
            let least_along = posture.bound(pair, Deviation::Along(along)).least;
            let tube = posture.bound(pair, Deviation::Tube(along, [half.1 / 4.0, half.0 / 4.0])).least;
            for &(u, v) in &deviations {
                let there = |d: Configuration| scene.separations(middle + d).nth(i).unwrap().separation.distance;
                let distance = there(q(u * half.0, v * half.1));
                // While the shapes overlap, a directional bound covers the distance in one direction only.
                prop_assert!(distance.max(0.0) >= least);
                prop_assert!(distance <= greatest);
                prop_assert!(there(along * u).max(0.0) >= least_along);
                let inside_tube = along * u + q(v * half.1, -u * half.0) / 4.0;
                prop_assert!(there(inside_tube).max(0.0) >= tube);
            }
        }
    }

    #[test]
    fn collision_boxes_hold_no_free_configuration(u in 0.0..1.0_f64, v in 0.0..1.0_f64) {
        let (scene, start, goal) = benchmark(Benchmark::Inf);
        let Connectivity::Disconnected(proof) = connectivity(&scene, start, &goal.into(), 0.0, 100_000) else {
            return Err(TestCaseError::fail("no proof"));
        };
        for stuck in proof.collision_boxes() {
            let at = q(
                stuck.cell.lower[0] + u * (stuck.cell.upper[0] - stuck.cell.lower[0]),
                stuck.cell.lower[1] + v * (stuck.cell.upper[1] - stuck.cell.lower[1]),
            );
            prop_assert!(scene.clearance(at) < 0.0);
        }
    }
}

#[test]
fn a_touching_motion_is_refused() {
    // The upper corner of the outstretched arm passes exactly through the wall's end.
    let arm = rr([JointRange::Circle, JointRange::Circle]);
    let tip = Point::new(1.8, 0.05);
    let scene = scene(arm, vec![wall(tip, Point::new(3.0, 0.05))]);
    let verdict = certify(&scene, Path::new(vec![q(-0.5, 0.0), q(0.0, 0.0)]));
    assert!(matches!(verdict, Err(Rejection::TooClose(_))), "{verdict:?}");
}

#[test]
fn thin_walls_between_samples_are_found() {
    // A wall that only the motion meets, because it is very thin and far from both ends of the segment.
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![disc(Point::new(1.2, 1.2), 1e-9)]);
    let verdict = certify(&scene, Path::new(vec![q(0.0, 0.0), q(1.5, 0.0)]));
    assert!(matches!(verdict, Err(Rejection::TooClose(_))), "{verdict:?}");
}

#[test]
fn requested_clearance_is_certified_or_refused() {
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![rectangle(1.9, 2.0, -1.0, 1.0)]);
    let path = || Path::new(vec![q(-0.3, 0.0), q(0.3, 0.0)]);
    // At q = 0, the tip is 0.1 m from the wall, and later its corners are slightly nearer.
    let reach = (1.8_f64 * 1.8 + 0.05 * 0.05).sqrt();
    let truth = 1.9 - reach;
    let certified = certify_at(&scene, path(), 0.0985).unwrap();
    assert!(certified.clearance() >= 0.0985 && certified.clearance() <= truth);
    assert!(matches!(certify_at(&scene, path(), truth + 1e-6), Err(Rejection::TooClose(_))));
}

#[test]
fn a_path_outside_the_limits_is_refused() {
    let range = JointRange::Interval { lower: -1.0, upper: 1.0 };
    let scene = scene(rr([range, range]), vec![]);
    let verdict = certify(&scene, Path::new(vec![q(0.0, 0.0), q(0.5, 1.5)]));
    assert_eq!(verdict.unwrap_err(), Rejection::OutOfLimits { waypoint: 1, limited: LimitedValue::Joint(1) });
    let free: CertifiedPath = certify(&scene, Path::new(vec![q(0.0, 0.0), q(1.0, 1.0)])).unwrap();
    assert_eq!(free.clearance(), f64::INFINITY);
    assert!(free.nearest().is_none());
}

/// Returns the collision boxes that prove that a problem has no path.
fn proof(scene: &Scene, start: Configuration, goal: Configuration, clearance: f64) -> Vec<CollisionBox> {
    match connectivity(scene, start, &goal.into(), clearance, 200_000) {
        Connectivity::Disconnected(proof) => proof.collision_boxes().to_vec(),
        other => panic!("not proven: {other:?}"),
    }
}

/// Checks that boxes that close a space prove nothing about a smaller clearance.
#[test]
fn proofs_hold_for_their_clearance() {
    let [half, folding] = [[0.0, 3.0], [-3.0, 3.0]].map(|[lower, upper]| JointRange::Interval { lower, upper });
    let pole = scene(rr([half, folding]), vec![disc(Point::new(0.0, 1.4), 0.05)]);
    let (start, goal) = (q(0.5, 0.0), q(2.6, 0.0));
    let boxes = proof(&pole, start, goal, 0.4);
    assert_eq!(recheck(&boxes, &pole, start, &goal.into(), 0.4), Ok(()));
    let refused = recheck(&boxes, &pole, start, &goal.into(), 0.0);
    assert!(matches!(refused, Err(ProofError::NotColliding { .. })), "{refused:?}");
}

#[test]
fn false_proofs_are_refused() {
    let (scene, start, goal) = benchmark(Benchmark::Inf);
    let boxes = proof(&scene, start, goal, 0.0);
    let judge = |boxes: &[CollisionBox]| recheck(boxes, &scene, start, &goal.into(), 0.0);
    assert_eq!(judge(&[]), Err(ProofError::NotSeparated(0)));
    assert_eq!(recheck(&boxes, &scene, start, &start.into(), 0.0), Err(ProofError::NotSeparated(0)));

    // If boxes are removed one after another, a path opens at some point. Further removals do not close it.
    let fewer: Vec<bool> = (0..=20).map(|k| judge(&boxes[boxes.len() * k / 20..]).is_ok()).collect();
    assert!(fewer[0] && !fewer[20]);
    assert!(fewer.windows(2).all(|w| w[0] || !w[1]));

    let wrong = |change: fn(&mut CollisionBox)| {
        let mut boxes = boxes.clone();
        change(&mut boxes[7]);
        judge(&boxes)
    };
    let grown = wrong(|b| (b.cell.lower, b.cell.upper) = ([-3.0, -3.0], [3.0, 3.0]));
    assert!(matches!(grown, Err(ProofError::NotColliding { index: 7, .. })), "{grown:?}");
    assert_eq!(wrong(|b| b.cell.upper[0] = 4.0), Err(ProofError::NotInDomain(7)));
    assert_eq!(wrong(|b| b.cell.upper[1] = f64::NAN), Err(ProofError::NotInDomain(7)));
    assert_eq!(wrong(|b| b.pair.obstacle = 17), Err(ProofError::UnknownPair(7)));
}

#[test]
fn separation_agrees_with_flood_fill() {
    for which in [Benchmark::Inf, Benchmark::T] {
        let (scene, start, goal) = benchmark(which);
        let boxes = proof(&scene, start, goal, 0.0);
        let mut opened = 0;
        let step = boxes.len().div_ceil(64);
        for gone in (0..boxes.len()).step_by(step) {
            let left = [&boxes[..gone], &boxes[gone + 1..]].concat();
            let ends: Vec<_> = left.iter().map(|b| [b.cell.lower, b.cell.upper]).collect();
            let way = reached_past(&ends, [[-PI, PI]; 2], [true; 2], start.into(), &[goal.into()]).is_some();
            let expected = if way { Err(ProofError::NotSeparated(0)) } else { Ok(()) };
            assert_eq!(recheck(&left, &scene, start, &goal.into(), 0.0), expected, "{which:?} without box {gone}");
            opened += usize::from(way);
        }
        assert!(opened > 0, "{which:?}: no box matters");
    }
}

#[test]
fn proofs_leave_out_boxes_that_do_not_matter() {
    for which in [Benchmark::Inf, Benchmark::T] {
        let (scene, start, goal) = benchmark(which);
        let boxes = proof(&scene, start, goal, 0.0);
        let mut known = explore(&scene, start, &goal.into(), 0.0, 200_000).boxes;
        known.retain(|(_, occupancy)| *occupancy == Occupancy::Colliding);
        assert!(boxes.iter().all(|b| known.iter().any(|(cell, _)| *cell == b.cell)));
        assert!(boxes.len() < known.len(), "{} of {}", boxes.len(), known.len());
    }
}

#[test]
fn the_boxes_cover_the_domain_with_true_states() {
    for (kind, arm) in all_kinds().into_iter().enumerate() {
        let scene = scene(arm, clutter());
        let topology = scene.arm().topology();
        let free = |i: u32| {
            let at = configuration_at_fractions(&scene, (f64::from(i % 29) / 28.5, f64::from(i % 31) / 30.5));
            (scene.clearance(at) > 0.01).then_some(at)
        };
        let [start, goal] = [0, 500].map(|from| (from..).find_map(free).unwrap());
        let boxes = explore(&scene, start, &goal.into(), 0.0, 5_000).boxes;
        let area: f64 = boxes.iter().map(|(c, _)| (c.upper[0] - c.lower[0]) * (c.upper[1] - c.lower[1])).sum();
        let whole = topology.ranges[0].extent() * topology.ranges[1].extent();
        assert!((area - whole).abs() < 1e-9 * whole, "kind {kind}: {area} of {whole}");
        for i in 0..4_000_u32 {
            let at = configuration_at_fractions(
                &scene,
                ((f64::from(i % 89) + 0.5) / 89.0, (f64::from(i % 97) + 0.5) / 97.0),
            );
            let holds = |c: &cplan::check::Cell| (0..2).all(|k| c.lower[k] <= at[k] && at[k] <= c.upper[k]);
            let clearance = scene.clearance(at);
            let mut held = false;
            for (_, occupancy) in boxes.iter().filter(|(cell, _)| holds(cell)) {
                held = true;
                assert!(*occupancy != Occupancy::Free || clearance > 0.0, "kind {kind} at {at:?}: {clearance}");
                assert!(*occupancy != Occupancy::Colliding || clearance < 0.0, "kind {kind} at {at:?}: {clearance}");
            }
            assert!(held, "kind {kind}: no box holds {at:?}");
        }
    }
}

/// Checks a gantry whose bridge slides along a wall that it touches everywhere. No column is known to be free or
/// colliding, and halving all columns down to the limit would fill the memory.
#[test]
fn link_1_sliding_along_a_wall_leaves_few_boxes() {
    let mut arm = gantry([0.0, 2.0], vec![rectangle(0.0, 0.25, 0.0, 0.25)]);
    arm.links[0] = link("bridge", vec![rectangle(0.0, 0.25, 0.0, 0.25)]);
    let scene = scene(arm, vec![rectangle(0.0, 4.0, -0.5, 0.0)]);
    let exploration = explore(&scene, q(0.5, 0.5), &q(1.5, 0.5).into(), 0.0, 1000);
    assert!(matches!(exploration.answer, Connectivity::Undecided { .. }));
    assert!(exploration.boxes.len() < 100_000, "{}", exploration.boxes.len());
}
