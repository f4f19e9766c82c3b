//! Slices, and grids made from slices, compared with clearances and with parry2d's verdicts, for all four kinds of
//! arms.

use cplan::cspace::{Bitmap, Grid, Proves, Slice, bitmap, grid_from_slices, outer_grid, sampled_grid};
use cplan::geometry::{Convex, Hits, Point, Vector};
use cplan::model::{Arm, Contacts, JointType, Scene};
use cplan::space::{Configuration, JointRange};
use cplan_testkit::problems::{self, Benchmark};
use cplan_testkit::shapes::{self, convex, disc};
use cplan_testkit::{arms, scenes};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// If a cell's centre is this close to contact, in metres, either verdict about it is accepted. The tolerance of
/// parry2d is some 1e-10.
const BOUNDARY: f64 = 1e-7;

fn revolute() -> impl Strategy<Value = (JointType, JointRange)> {
    let axis = prop_oneof![
        Just(JointRange::Circle),
        (-4.0..0.0f64, 0.5..6.0f64).prop_map(|(lower, extent)| JointRange::Interval { lower, upper: lower + extent }),
        Just(JointRange::Interval { lower: -4.0, upper: 4.5 }),
    ];
    (prop_oneof![Just(1.0), Just(-1.0)], axis).prop_map(|(sign, axis)| (JointType::Revolute { sign }, axis))
}

fn prismatic() -> impl Strategy<Value = (JointType, JointRange)> {
    (-PI..PI, -1.0..0.2f64, 0.1..1.5f64).prop_map(|(angle, lower, extent)| {
        let direction = Vector::new(angle.cos(), angle.sin());
        (JointType::Prismatic { direction }, JointRange::Interval { lower, upper: lower + extent })
    })
}

fn piece() -> impl Strategy<Value = Convex> {
    let size = 0.05..0.4f64;
    ((-2.0..2.0, -2.0..2.0), size, 1usize..6, 0.0..TAU, prop_oneof![Just(0.0), 0.02..0.2f64]).prop_map(
        |((x, y), size, corners, turn, radius)| {
            let corner = |k: usize| {
                let angle = turn + TAU * k as f64 / corners as f64;
                Point::new(x + size * angle.cos(), y + size * angle.sin())
            };
            let radius = if corners == 1 { radius + 0.05 } else { radius };
            convex((0..corners).map(corner).collect(), radius)
        },
    )
}

fn part() -> impl Strategy<Value = Convex> {
    let bar = (0.3..1.2f64, 0.02..0.1f64)
        .prop_map(|(length, half_width)| shapes::rectangle(0.0, length, -half_width, half_width));
    let capsule = (0.3..1.2f64, 0.02..0.1f64)
        .prop_map(|(length, radius)| convex(vec![Point::zeros(), Point::new(length, 0.0)], radius));
    prop_oneof![bar, capsule, piece()]
}

fn any_scene() -> impl Strategy<Value = Scene> {
    let joint = || prop_oneof![2 => revolute(), 1 => prismatic()];
    let parts = || prop::collection::vec(part(), 1..3);
    (
        (-0.3..0.3, -0.3..0.3),
        (0.0..1.2f64, -0.2..0.2),
        [joint(), joint()],
        [parts(), parts()],
        prop::collection::vec(piece(), 1..5),
    )
        .prop_map(|(base, offset, [first, second], parts, pieces)| {
            let joints = [arms::joint("j1", first.0, first.1), arms::joint("j2", second.0, second.1)];
            let links = parts.map(|shapes| arms::link("link", shapes));
            let (offset, tip) = (Vector::new(offset.0, offset.1), Point::new(1.0, 0.0));
            let arm = Arm { base: Point::new(base.0, base.1), ..arms::arm(joints, links, offset, tip) };
            scenes::scene(arm, pieces)
        })
}

/// Returns the least distance of all pairs of shapes with this link.
fn link_clearance(scene: &Scene, link: usize, q: Configuration) -> f64 {
    let distances = scene.separations(q).filter(|c| c.pair.link == link).map(|c| c.separation.distance);
    distances.fold(f64::INFINITY, f64::min)
}

fn at(range: JointRange, t: f64) -> f64 {
    range.domain().0 + t * range.extent()
}

/// Returns by how many turns a value of joint 1 must be shifted to lie in a range of reach. Returns `None` if no shift
/// does so. Ranges begin within half a turn of zero and are up to a turn long, but the joint's limits can be anywhere.
/// So a value may be two turns away.
fn turn_within(scene: &Scene, ranges: &[[f64; 2]], value: f64) -> Option<i32> {
    let turns = if scene.arm().joints[0].joint_type.is_revolute() { -2..=2 } else { 0..=0 };
    let is_within = |r: &[f64; 2], value: f64| r[0] <= value && value <= r[1];
    turns.into_iter().find(|turn| ranges.iter().any(|r| is_within(r, value + TAU * f64::from(*turn))))
}

/// Checks, for 400 configurations, that a pair keeps its distance outside its ranges of reach. Returns the largest
/// number of turns between a configuration and its range.
fn outside_reach_ranges_pairs_keep_their_distance(scene: &Scene, grow: f64) -> Result<i32, TestCaseError> {
    let slices = Contacts::new(scene);
    let [first, second] = scene.arm().topology().ranges;
    let mut most = 0;
    for index in slices.second_link_pairs() {
        let mut ranges = Vec::new();
        let hits = slices.reach_range(index, grow, &mut ranges);
        let pair = scene.pairs()[index];
        for k in 0..400 {
            let q = Configuration::new(at(first, f64::from(k % 20) / 19.0), at(second, f64::from(k / 20) / 19.0));
            let reached = match hits {
                Hits::Never => false,
                Hits::Always => true,
                Hits::Within => {
                    let turn = turn_within(scene, &ranges, q[0]);
                    most = most.max(turn.unwrap_or(0).abs());
                    turn.is_some()
                }
            };
            let contact = scene.separations(q).find(|c| c.pair == pair);
            prop_assert!(reached || contact.is_none_or(|c| c.separation.distance > grow - BOUNDARY), "{} {}", index, q);
        }
    }
    Ok(most)
}

/// Checks an arm with limits of -4 and 4.5, and obstacles that the second link reaches at nearly all angles of the
/// first. One range begins before half a turn and ends after a turn and a third, so that the lower limit is two turns
/// below it.
#[test]
fn a_limit_may_be_two_turns_below_a_reach_range() {
    let axis = JointRange::Interval { lower: -4.0, upper: 4.5 };
    let turn = JointType::Revolute { sign: 1.0 };
    let links = [0.5, 0.9].map(|length| arms::link("bar", vec![shapes::rectangle(0.0, length, -0.05, 0.05)]));
    let joints = [arms::joint("j1", turn, axis), arms::joint("j2", turn, JointRange::Circle)];
    let arm = arms::arm(joints, links, Vector::new(0.5, 0.0), Point::new(0.9, 0.0));
    let most = (0..72).map(|k| {
        let angle = TAU * f64::from(k) / 72.0;
        let piece = disc(Point::new(0.5 * angle.cos(), 0.5 * angle.sin()), 0.035);
        let scene = scenes::scene(arm.clone(), vec![piece]);
        outside_reach_ranges_pairs_keep_their_distance(&scene, 0.051_387_181_940_973_81).unwrap()
    });
    assert_eq!(most.max(), Some(2), "no range is two turns off: the test has lost its case");
}

proptest! {
    #![proptest_config(cplan_cases::cases(100))]

    #[test]
    fn bitmaps_are_grids(scene in any_scene(), cells in (1..90_usize, 1..200_usize), clearance in prop_oneof![Just(0.0), 0.0..0.1f64]) {
        let cells = [cells.0, cells.1];
        let (bits, grid) = (bitmap(&scene, cells, clearance), grid_from_slices(&scene, cells, clearance));
        prop_assert_eq!(bits.cells(), cells);
        for index in 0..cells[0] * cells[1] {
            if bits.blocked(index / cells[1], index % cells[1]) != grid.blocked[index] {
                let distance = scene.clearance(grid.center(index)) - clearance;
                prop_assert!(distance.abs() < BOUNDARY, "cell {} is {} from contact", index, distance);
            }
        }
        let counted = (0..cells[0] * cells[1]).filter(|i| bits.blocked(i / cells[1], i % cells[1])).count();
        prop_assert_eq!(bits.count(), counted);
        prop_assert_eq!((0..cells[0]).map(|i| bits.row(i).iter().map(|w| w.count_ones()).sum::<u32>()).sum::<u32>() as usize, bits.count());
    }

    #[test]
    fn slices_and_bands_agree_with_clearances(scene in any_scene(), s in 0.0..1.0f64, grow in prop_oneof![Just(0.0), 0.0..0.2f64]) {
        let slices = Contacts::new(&scene);
        let [first, second] = scene.arm().topology().ranges;
        let bands = Slice::bands(&slices, grow);
        let mut slice = Slice::default();
        let q1 = at(first, s);
        slice.compute(&slices, q1, grow);
        for k in 0..=200 {
            let t = f64::from(k) / 200.0;
            let q = Configuration::new(q1, at(second, t));
            let distance = link_clearance(&scene, 1, q) - grow;
            prop_assert!(distance.abs() < BOUNDARY || slice.forbids(q[1]) == (distance < 0.0), "row {}: {}", q, distance);
            let q = Configuration::new(at(first, t), 0.0);
            let distance = link_clearance(&scene, 0, q) - grow;
            prop_assert!(distance.abs() < BOUNDARY || bands.forbids(q[0]) == (distance < 0.0), "band {}: {}", q, distance);
        }
    }

    #[test]
    fn pairs_outside_their_reach_range_stay_apart(scene in any_scene(), grow in 0.0..0.2f64) {
        outside_reach_ranges_pairs_keep_their_distance(&scene, grow)?;
    }

    #[test]
    fn grids_from_slices_equal_those_of_collision_tests(scene in any_scene(), clearance in prop_oneof![Just(0.0), 0.0..0.1f64]) {
        let cells = [23, 31];
        let (slices, sampled) = (grid_from_slices(&scene, cells, clearance), sampled_grid(&scene, cells, clearance));
        for index in 0..slices.blocked.len() {
            if slices.blocked[index] != sampled.blocked[index] {
                let distance = scene.clearance(slices.center(index)) - clearance;
                prop_assert!(distance.abs() < BOUNDARY, "cell {} is {} from contact", index, distance);
            }
        }
    }

    #[test]
    fn free_cells_are_wholly_free(scene in any_scene(), clearance in prop_oneof![Just(0.0), 0.0..0.1f64], places in prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64), 8)) {
        let grid = outer_grid(&scene, [37, 29], clearance);
        let Proves::Outer { margin } = grid.proves else { panic!("an outer grid proves that free is free") };
        let step = grid.step();
        for index in 0..grid.blocked.len() {
            let center = grid.center(index);
            for (s, t) in &places {
                let q = center + Configuration::new((s - 0.5) * step[0], (t - 0.5) * step[1]);
                let distance = scene.clearance(q);
                if grid.blocked[index] {
                    prop_assert!(distance <= clearance + margin, "blocked at {}, {} away with margin {}", q, distance, margin);
                } else {
                    prop_assert!(distance > clearance, "free at {}, {} away", q, distance);
                }
            }
        }
    }
}

#[test]
fn w20_from_slices_equals_that_of_collision_tests() {
    let scene = scenes::w20();
    let cells = [1024, 1024];
    let (slices, sampled) = (grid_from_slices(&scene, cells, 0.0), sampled_grid(&scene, cells, 0.0));
    let differing: Vec<usize> =
        (0..slices.blocked.len()).filter(|&i| slices.blocked[i] != sampled.blocked[i]).collect();
    for &index in &differing {
        let distance = scene.clearance(slices.center(index));
        assert!(distance.abs() < BOUNDARY, "cell {index} is {distance} from contact");
    }
    let blocked = slices.blocked.iter().filter(|b| **b).count() as f64 / slices.blocked.len() as f64;
    assert!(blocked > 0.1 && blocked < 0.9, "a mixed picture, not a share of {blocked}");
}

/// Returns the cells in which a bitmap differs from a grid.
fn differing(bits: &Bitmap, grid: &Grid) -> Vec<usize> {
    let columns = grid.cells[1];
    (0..grid.blocked.len()).filter(|&i| bits.blocked(i / columns, i % columns) != grid.blocked[i]).collect()
}

#[test]
fn bitmaps_of_the_benchmarks_are_their_grids() {
    for scene in [problems::benchmark(Benchmark::A).0, scenes::w20()] {
        let cells = [2048, 2048];
        let (bits, grid) = (bitmap(&scene, cells, 0.0), grid_from_slices(&scene, cells, 0.0));
        for index in differing(&bits, &grid) {
            let distance = scene.clearance(grid.center(index));
            assert!(distance.abs() < BOUNDARY, "cell {index} is {distance} from contact");
        }
        assert!(bits.count() > 0 && bits.count() < cells[0] * cells[1]);
    }
}

#[test]
fn bitmaps_agree_with_collision_tests() {
    for scene in [problems::benchmark(Benchmark::A).0, scenes::w20()] {
        let cells = [256, 256];
        let (bits, sampled) = (bitmap(&scene, cells, 0.0), sampled_grid(&scene, cells, 0.0));
        for index in differing(&bits, &sampled) {
            let distance = scene.clearance(sampled.center(index));
            assert!(distance.abs() < BOUNDARY, "cell {index} is {distance} from contact");
        }
    }
}
