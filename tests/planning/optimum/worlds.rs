//! Random worlds with all kinds of arms: no planner finds a motion that is shorter than the bound.

use super::{LIMITS, ROUNDING, bound, metrics};
use cplan::engine::{Criterion, Method, Options, Planner, decide, solve};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::MotionProblem;
use cplan::space::{GoalSet, Path};
use cplan_testkit::arms::all_kinds;
use cplan_testkit::problems::motion_problem;
use cplan_testkit::scenes::{configuration_at_fractions, scene};
use cplan_testkit::shapes::{convex, disc, rectangle, wall};
use cplan_testkit::world;
use proptest::prelude::*;
use std::f64::consts::TAU;

const SLABS: usize = 20_000;

/// Optimization criteria, tried one after the other.
const CRITERIA: [Criterion; 3] = [Criterion::Euclidean, Criterion::Weighted([1.0, 0.3]), Criterion::Time];

/// Returns certified motions of all planners.
fn motions(problem: &MotionProblem) -> Vec<Path> {
    let options = |method: Method, criterion: Criterion| {
        let planner = Planner::named(method).with_criterion(criterion).with_margin(1e-4).with_cells(128);
        Options { levels: 2, boxes: 5000, ..planner.into() }
    };
    let solved = |method, criterion| solve(problem, &options(method, criterion), &mut |_| {}).path().cloned();
    let mut paths = vec![decide(problem, SLABS).found().map(|found| found.path().clone())];
    for method in [Method::Shortest, Method::Visibility] {
        paths.extend(CRITERIA.map(|criterion| solved(method, criterion)));
    }
    let others = [Method::Trapezoid, Method::Wavefront, Method::Subdivision];
    paths.extend(others.map(|method| solved(method, Criterion::Euclidean)));
    paths.into_iter().flatten().collect()
}

/// Checks that the bound does not exceed the length of any known motion.
fn check_bound_below_motions(problem: &MotionProblem, gap: f64) {
    let paths = motions(problem);
    for metric in metrics() {
        let length = paths.iter().map(|path| metric.length(path)).fold(f64::INFINITY, f64::min);
        if length.is_finite() {
            for factor in LIMITS {
                let found = bound(problem, metric, (factor * length).max(1e-3), gap);
                assert!(found <= length * (1.0 + ROUNDING), "{metric:?}, {gap}: {found} above {length}");
            }
        }
    }
}

fn gaps() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1e-2), Just(1e-4)]
}

/// Returns a strategy for convex obstacles of any kind.
pub fn obstacle() -> impl Strategy<Value = Convex> {
    let at = (0.2..1.9_f64, -3.2..3.2_f64).prop_map(|(r, t)| Point::new(r * t.cos(), r * t.sin()));
    (at, 0..5_u8, 0.03..0.3_f64, 0.0..TAU).prop_map(|(at, kind, size, turn)| {
        let corner = |k: u8, n: u8| {
            let angle = turn + TAU * f64::from(k) / f64::from(n);
            at + Vector::new(angle.cos(), angle.sin()) * size
        };
        match kind {
            0 => disc(at, size),
            1 => wall(corner(0, 2), corner(1, 2)),
            2 => convex(vec![corner(0, 2), corner(1, 2)], size / 3.0),
            // A thin wall.
            3 => convex(vec![corner(0, 2), corner(1, 2)], 1e-4),
            _ => convex((0..5).map(|k| corner(k, 5)).collect(), 0.0),
        }
    })
}

/// Checks a pair of walls that separate and meet again within a strip. Barriers through all of them once closed the
/// path by mistake, because the elbow, which is in the link everywhere, counted as being in the obstacle.
#[test]
fn walls_that_part_and_meet_block_no_path() {
    for gap in [1e-2, 1e-4] {
        check_bound_below_motions(&world::world("PR", 5_703_491_533_213_168_642).unwrap(), gap);
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(30))]

    #[test]
    fn no_motion_is_shorter_than_the_bound(
        kind in 0_usize..5, obstacles in prop::collection::vec(obstacle(), 1..7), start in (0.0..=1.0_f64, 0.0..=1.0_f64),
        goals in prop::collection::vec((0.0..=1.0_f64, 0.0..=1.0_f64), 1..3),
        clearance in prop_oneof![Just(0.0), 0.0..0.05_f64], gap in gaps(),
    ) {
        let scene = scene(all_kinds().swap_remove(kind), obstacles).with_clearance(clearance).unwrap();
        let start = configuration_at_fractions(&scene, start);
        let goals: Vec<_> = goals.into_iter().map(|at| configuration_at_fractions(&scene, at)).collect();
        prop_assume!(goals.iter().chain([&start]).all(|&at| scene.clearance(at) > clearance + 1e-6));
        check_bound_below_motions(&motion_problem(scene, start, goals.into_iter().collect::<GoalSet>()), gap);
    }

    /// Checks bounds in worlds that include touching, pointed and thin obstacles, joints of all ranges, and starts on
    /// limits, on other turns and next to obstacles.
    #[test]
    fn no_motion_in_a_hard_world_is_shorter_than_the_bound(kind in 0_usize..4, seed in any::<u64>(), gap in gaps()) {
        let problem = world::world(world::KINDS[kind], seed);
        prop_assume!(problem.is_some());
        check_bound_below_motions(&problem.unwrap(), gap);
    }

    /// Checks bounds for two walls that leave a slot between them.
    #[test]
    fn no_motion_through_a_slot_is_shorter_than_the_bound(
        kind in 0_usize..5, at in (0.5..1.5_f64, -3.2..3.2_f64), width in prop_oneof![1e-4..1e-2_f64, 0.1..0.3_f64],
        start in (0.0..=1.0_f64, 0.0..=1.0_f64), goal in (0.0..=1.0_f64, 0.0..=1.0_f64), gap in gaps(),
    ) {
        let (x, y) = (at.0 * at.1.cos(), at.0 * at.1.sin());
        let walls = vec![rectangle(x - 0.01, x + 0.01, y + 0.1 + width, y + 2.0), rectangle(x - 0.01, x + 0.01, y - 2.0, y)];
        let scene = scene(all_kinds().swap_remove(kind), walls);
        let (start, goal) = (configuration_at_fractions(&scene, start), configuration_at_fractions(&scene, goal));
        prop_assume!(scene.clearance(start) > 1e-6 && scene.clearance(goal) > 1e-6);
        check_bound_below_motions(&motion_problem(scene, start, goal), gap);
    }
}
