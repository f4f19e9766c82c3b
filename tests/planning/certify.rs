//! The judge, compared with dense samples and with problems whose answers are known.

use cplan::check::{
    CertifiedPath, CollisionBox, Deviation, Posture, ProofError, Rejection, StraightMotions, certify, certify_at,
};
use cplan::geometry::{Point, Vector};
use cplan::model::{JointType, Scene};
use cplan::proofs::{Connectivity, Occupancy, connectivity, explore};
use cplan::space::{Configuration, JointRange, LimitedValue, Path};
use cplan_testkit::arms::{all_kinds, arm, joint, link, rr};
use cplan_testkit::problems::{Benchmark, benchmark, recheck};
use cplan_testkit::scenes::{clutter, q, scene};
use cplan_testkit::shapes::{disc, rectangle, wall};
use proptest::prelude::*;
use std::f64::consts::PI;

fn configuration_at_fractions(scene: &Scene, u: f64, v: f64) -> Configuration {
    let at = |k: usize, t: f64| {
        let (lower, upper) = scene.arm().topology().ranges[k].domain();
        lower + t * (upper - lower)
    };
    q(at(0, u), at(1, v))
}

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
        let (from, to) = (configuration_at_fractions(&scene, a.0, a.1), configuration_at_fractions(&scene, b.0, b.1));
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
        let middle = configuration_at_fractions(&scene, at.0, at.1);
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

#[test]
fn benchmark_problems_are_decided() {
    for which in [Benchmark::A, Benchmark::B] {
        let (scene, start, goal) = benchmark(which);
        let Connectivity::Connected(channel) = connectivity(&scene, start, &goal.into(), 0.0, 200_000) else {
            panic!("{which:?} has a path");
        };
        let path = channel.path();
        assert_eq!(path.start(), start);
        assert!(scene.arm().topology().distance(path.goal(), goal) < 1e-12);
        certify(&scene, path).expect("a chain of free boxes is free");
    }
    for which in [Benchmark::Inf, Benchmark::T] {
        let (scene, start, goal) = benchmark(which);
        let verdict = connectivity(&scene, start, &goal.into(), 0.0, 200_000);
        assert!(matches!(verdict, Connectivity::Disconnected(_)), "{which:?}");
    }
}

#[test]
fn limits_and_clearance_can_make_a_problem_infeasible() {
    // The only obstacle is a pole: the arm can pass it on the torus, but not within limits that end before it.
    let pole = || vec![disc(Point::new(0.0, 1.4), 0.05)];
    let decide =
        |axes, clearance| connectivity(&scene(rr(axes), pole()), q(0.5, 0.0), &q(2.6, 0.0).into(), clearance, 100_000);
    assert!(matches!(decide([JointRange::Circle, JointRange::Circle], 0.0), Connectivity::Connected(_)));
    let narrow = JointRange::Interval { lower: -0.1, upper: 0.1 };
    let half = JointRange::Interval { lower: 0.0, upper: 3.0 };
    assert!(matches!(decide([half, narrow], 0.0), Connectivity::Disconnected(_)));
    let folding = JointRange::Interval { lower: -3.0, upper: 3.0 };
    assert!(matches!(decide([half, folding], 0.0), Connectivity::Connected(_)));
    // The folded forearm comes within 0.4 m of the pole when the elbow passes under it.
    assert!(matches!(decide([half, folding], 0.4), Connectivity::Disconnected(_)));
}

/// Returns the collision boxes that prove that a problem has no path.
fn proof(scene: &Scene, start: Configuration, goal: Configuration, clearance: f64) -> Vec<CollisionBox> {
    match connectivity(scene, start, &goal.into(), clearance, 200_000) {
        Connectivity::Disconnected(proof) => proof.collision_boxes().to_vec(),
        other => panic!("not proven: {other:?}"),
    }
}

#[test]
fn proofs_are_accepted_by_the_independent_check() {
    for which in [Benchmark::Inf, Benchmark::T] {
        let (scene, start, goal) = benchmark(which);
        assert_eq!(recheck(&proof(&scene, start, goal, 0.0), &scene, start, &goal.into(), 0.0), Ok(()), "{which:?}");
    }
    let half = JointRange::Interval { lower: 0.0, upper: 3.0 };
    let folding = JointRange::Interval { lower: -3.0, upper: 3.0 };
    let pole = scene(rr([half, folding]), vec![disc(Point::new(0.0, 1.4), 0.05)]);
    let (start, goal) = (q(0.5, 0.0), q(2.6, 0.0));
    let boxes = proof(&pole, start, goal, 0.4);
    assert_eq!(recheck(&boxes, &pole, start, &goal.into(), 0.4), Ok(()));
    // The same boxes prove nothing about a smaller clearance.
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

/// Returns true if boxes leave a path from `start` to `goal` on the torus. Uses a flood fill over the grid that
/// consists of all coordinates of the boxes.
fn leave_a_path(boxes: &[CollisionBox], start: Configuration, goal: Configuration) -> bool {
    let ends: [Vec<f64>; 2] = [0, 1].map(|k| {
        let sides = boxes.iter().flat_map(|b| [b.cell.lower[k], b.cell.upper[k]]);
        let mut ends: Vec<f64> = sides.chain([-PI, PI]).collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    });
    let size = [0, 1].map(|k| ends[k].len() - 1);
    let at = |k: usize, value: f64| ends[k].partition_point(|&end| end <= value) - 1;
    let mut closed = vec![vec![false; size[1]]; size[0]];
    for cell in boxes.iter().map(|b| &b.cell) {
        let [across, up] = [0, 1].map(|k| {
            let place = |value: f64| ends[k].partition_point(|&end| end < value);
            place(cell.lower[k])..place(cell.upper[k])
        });
        closed[across].iter_mut().for_each(|column| column[up.clone()].fill(true));
    }
    let mut waiting = vec![[at(0, start[0]), at(1, start[1])]];
    while let Some([i, j]) = waiting.pop() {
        if !std::mem::replace(&mut closed[i][j], true) {
            if [i, j] == [at(0, goal[0]), at(1, goal[1])] {
                return true;
            }
            let [w, h] = size;
            waiting.extend([[(i + 1) % w, j], [(i + w - 1) % w, j], [i, (j + 1) % h], [i, (j + h - 1) % h]]);
        }
    }
    false
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
            let way = leave_a_path(&left, start, goal);
            let expected = if way { Err(ProofError::NotSeparated(0)) } else { Ok(()) };
            assert_eq!(recheck(&left, &scene, start, &goal.into(), 0.0), expected, "{which:?} without box {gone}");
            opened += usize::from(way);
        }
        assert!(opened > 0, "{which:?}: no box matters");
    }
}

/// Returns the same arm as [`rr`], with segments without thickness as its links.
fn skeleton(axes: [JointRange; 2]) -> cplan::model::Arm {
    let mut arm = rr(axes);
    arm.links[0].parts[0].shape = wall(Point::zeros(), Point::new(1.0, 0.0));
    arm.links[1].parts[0].shape = wall(Point::zeros(), Point::new(0.8, 0.0));
    arm
}

#[test]
fn thin_links_are_stopped_by_thin_walls() {
    let circles = [JointRange::Circle, JointRange::Circle];
    let front = wall(Point::new(0.5, -0.2), Point::new(0.7, 0.3));
    let back = wall(Point::new(-0.6, -0.3), Point::new(-0.7, 0.1));
    let (start, goal) = (q(-1.2, 0.4), q(1.3, -0.4));
    // Slanted walls block the upper arm. Without one of them, it can pass in the other direction.
    let one_wall = scene(skeleton(circles), vec![front.clone()]);
    assert!(matches!(connectivity(&one_wall, start, &goal.into(), 0.0, 100_000), Connectivity::Connected(_)));
    let closed = scene(skeleton(circles), vec![front, back]);
    assert_eq!(recheck(&proof(&closed, start, goal, 0.0), &closed, start, &goal.into(), 0.0), Ok(()));

    // A wall beyond the elbow's circle, for which the limits keep the forearm stretched enough.
    let narrow = [JointRange::Interval { lower: -1.5, upper: 1.5 }, JointRange::Interval { lower: -0.4, upper: 0.4 }];
    let beyond = scene(skeleton(narrow), vec![wall(Point::new(1.05, 0.1), Point::new(1.7, -0.2))]);
    let (start, goal) = (q(-1.2, 0.1), q(1.3, -0.1));
    assert_eq!(recheck(&proof(&beyond, start, goal, 0.0), &beyond, start, &goal.into(), 0.0), Ok(()));
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
            let at = configuration_at_fractions(&scene, f64::from(i % 29) / 28.5, f64::from(i % 31) / 30.5);
            (scene.clearance(at) > 0.01).then_some(at)
        };
        let [start, goal] = [0, 500].map(|from| (from..).find_map(free).unwrap());
        let boxes = explore(&scene, start, &goal.into(), 0.0, 5_000).boxes;
        let area: f64 = boxes.iter().map(|(c, _)| (c.upper[0] - c.lower[0]) * (c.upper[1] - c.lower[1])).sum();
        let whole = topology.ranges[0].extent() * topology.ranges[1].extent();
        assert!((area - whole).abs() < 1e-9 * whole, "kind {kind}: {area} of {whole}");
        for i in 0..4_000_u32 {
            let at =
                configuration_at_fractions(&scene, (f64::from(i % 89) + 0.5) / 89.0, (f64::from(i % 97) + 0.5) / 97.0);
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
    let slide = |x: f64, y: f64| JointType::Prismatic { direction: Vector::new(x, y) };
    let range = JointRange::Interval { lower: 0.0, upper: 2.0 };
    let bridge = link("bridge", vec![rectangle(0.0, 0.25, 0.0, 0.25)]);
    let head = link("head", vec![rectangle(0.0, 0.25, 0.0, 0.25)]);
    let joints = [joint("x", slide(1.0, 0.0), range), joint("y", slide(0.0, 1.0), range)];
    let arm = arm(joints, [bridge, head], Vector::zeros(), Point::zeros());
    let scene = scene(arm, vec![rectangle(0.0, 4.0, -0.5, 0.0)]);
    let exploration = explore(&scene, q(0.5, 0.5), &q(1.5, 0.5).into(), 0.0, 1000);
    assert!(matches!(exploration.answer, Connectivity::Undecided { .. }));
    assert!(exploration.boxes.len() < 100_000, "{}", exploration.boxes.len());
}
