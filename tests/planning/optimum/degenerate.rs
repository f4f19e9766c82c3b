//! Starts and goals at the ends of rows, seams and domains, and joints that cannot move.

use super::{LIMITS, ROUNDING, bound, metrics};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{JointType, MotionProblem};
use cplan::proofs::{MotionQuery, least_length};
use cplan::space::{Configuration, JointRange, Metric};
use cplan_testkit::arms::{arm, joint, link, rr};
use cplan_testkit::problems::{self, motion_problem};
use cplan_testkit::scenes::{q, scene};
use cplan_testkit::shapes::{convex, disc, rectangle};
use std::f64::consts::{PI, TAU};

const CIRCLES: [JointRange; 2] = [JointRange::Circle, JointRange::Circle];

/// Checks the bound in a space without obstacles, which is the length of the straight motion to the nearest copy of a
/// goal.
fn assert_straight(axes: [JointRange; 2], start: Configuration, goals: &[Configuration]) {
    let scene = scene(rr(axes), Vec::new());
    let topology = scene.arm().topology();
    for metric in metrics() {
        let way = |goal: &Configuration| {
            let turns = |k: usize| if topology.ranges[k].is_circle() { -3..=3 } else { 0..=0 };
            let copies = turns(0).flat_map(|i| turns(1).map(move |j| q(f64::from(i) * TAU, f64::from(j) * TAU)));
            let base = topology.lift(*goal, start);
            copies.map(|by| metric.norm(base + by - start)).fold(f64::INFINITY, f64::min)
        };
        let straight = goals.iter().map(way).fold(f64::INFINITY, f64::min);
        for factor in LIMITS {
            let limit = factor * straight.max(0.1);
            let found = least_length(
                &MotionQuery { scene: &scene, start, goals: &goals.iter().copied().collect(), clearance: 0.0, metric },
                limit,
                1e-4,
                &[],
            );
            let error = (found - straight).abs();
            assert!(
                error <= 2.0 * ROUNDING * straight.max(1e-3),
                "{metric:?}, {start:?} to {goals:?}: {found}, {straight}"
            );
        }
    }
}

#[test]
fn without_obstacles_paths_are_straight() {
    assert_straight(CIRCLES, q(-3.0, 0.0), &[q(3.0, 0.5)]);
    assert_straight(CIRCLES, q(-3.0, 3.0), &[q(3.0, -3.0), q(0.0, 0.0)]);
    assert_straight(CIRCLES, q(9.0, -14.0), &[q(-2.0, 1.0), q(1.0, 1.0), q(100.0, 3.0)]);
    let limits = JointRange::Interval { lower: -3.0, upper: 3.0 };
    assert_straight([limits; 2], q(-3.0, 3.0), &[q(3.0, -3.0), q(2.9, 2.9)]);
    assert_straight([JointRange::Circle, limits], q(3.0, -3.0), &[q(-3.0, 3.0)]);
    assert_straight([limits, JointRange::Circle], q(3.0, -3.0), &[q(-3.0, 3.0)]);
}

#[test]
fn a_goal_at_the_start_is_reached_at_once() {
    for at in [q(0.3, 0.4), q(-PI, PI), q(PI, -PI), q(0.0, 0.0), q(7.0 * PI, 0.1)] {
        assert_straight(CIRCLES, at, &[at]);
        assert_straight(CIRCLES, at, &[at + q(TAU, -TAU)]);
    }
    let limits = JointRange::Interval { lower: -1.0, upper: 1.0 };
    for at in [q(-1.0, -1.0), q(1.0, 1.0), q(1.0, -1.0), q(0.0, 0.0)] {
        assert_straight([limits; 2], at, &[at]);
    }
}

/// Checks starts and goals at the borders of strips; the domain of joint 1 begins with 64 strips. They are exactly on
/// the border of two strips, on either side of it by one last bit, on the seam, and at the same places on other turns.
#[test]
fn starts_and_goals_on_slices_are_bounded() {
    let axes = [JointRange::Circle, JointRange::Interval { lower: -1.0, upper: 2.5 }];
    for (first, turns) in axes.into_iter().flat_map(|axis| [-3, -1, 0, 1, 2].map(|turns| (axis, turns))) {
        let (lower, upper) = first.domain();
        let turn = if first.is_circle() { f64::from(turns) * TAU } else { 0.0 };
        for row in [0, 1, 31, 32, 63, 64] {
            let at = lower + (upper - lower) * f64::from(row) / 64.0 + turn;
            for x in [at, at.next_up(), at.next_down()] {
                if !first.contains(x) {
                    continue;
                }
                for way in [-0.7, -0.1, -0.05, -1e-9, 1e-9, 0.05, 0.1, 0.7] {
                    let goal = q(x + way, 0.3);
                    if first.contains(goal[0]) {
                        assert_straight([first, JointRange::Circle], q(x, 0.2), &[goal]);
                        assert_straight([first, JointRange::Circle], goal, &[q(x, 0.2)]);
                    }
                }
                // Along the row.
                assert_straight([first, JointRange::Circle], q(x, 0.2), &[q(x, 3.0)]);
            }
        }
    }
}

fn problem_among(
    axes: [JointRange; 2],
    pieces: Vec<Convex>,
    start: Configuration,
    goal: Configuration,
) -> MotionProblem {
    motion_problem(scene(rr(axes), pieces), start, goal)
}

/// Checks goals on the other side of a post that the upper arm cannot pass. The arm reaches them stretched, by turning
/// in the other direction.
#[test]
fn goals_beyond_a_post_are_reached_in_the_other_direction() {
    let post = disc(Point::new(0.5, 0.0), 0.1);
    let ways = [
        (q(-0.5, 0.0), q(0.5, 0.0), TAU - 1.0),
        (q(0.5 - TAU, 0.0), q(-0.5, TAU), TAU - 1.0),
        (q(PI / 2.0, 0.0), q(-PI / 2.0, 0.0), PI),
        (q(-PI, 0.0), q(-0.5, 0.0), PI - 0.5),
        (q(0.5, 0.0), q(PI, 0.0), PI - 0.5),
    ];
    for (start, goal, way) in ways {
        let problem = problem_among([JointRange::Circle, JointRange::Circle], vec![post.clone()], start, goal);
        for factor in LIMITS {
            let found = bound(&problem, Metric::Euclidean, factor * way, 1e-4);
            assert!((found - way).abs() <= 2.0 * ROUNDING * way, "{start:?} to {goal:?}: {found}, not {way}");
        }
    }
}

/// Checks joints without room to move. Then there is nothing to cut into strips, or nothing beside the strips.
#[test]
fn joints_that_cannot_move_are_bounded() {
    let fixed = JointRange::Interval { lower: 0.5, upper: 0.5 };
    for axes in [[fixed, JointRange::Circle], [JointRange::Circle, fixed], [fixed, fixed]] {
        let to = |k: usize, by: f64| if axes[k].is_circle() { 0.5 + by } else { 0.5 };
        assert_straight(axes, q(0.5, 0.5), &[q(to(0, 1.0), to(1, 1.0))]);
        assert_straight(axes, q(0.5, 0.5), &[q(to(0, -3.0), to(1, 3.5))]);
    }
    let wall = rectangle(1.2, 1.4, 0.9, 1.1);
    let problem = problem_among(
        [JointRange::Interval { lower: 0.0, upper: 0.0 }, JointRange::Circle],
        vec![wall],
        q(0.0, 0.0),
        q(0.0, 3.0),
    );
    assert!(bound(&problem, Metric::Euclidean, 10.0, 1e-4) <= 3.0);
}

#[test]
fn bounds_are_reproducible_to_the_last_bit() {
    for metric in metrics() {
        let problem = problems::problem(problems::Benchmark::A);
        let found = [0; 2].map(|_| bound(&problem, metric, 30.0, 1e-4).to_bits());
        assert_eq!(found[0], found[1]);
    }
}

/// Checks a capsule on a carriage that slides past an obstacle, or on the axis of joint 1. Within one strip, its
/// collision interval leaves the lower limit of joint 2 and enters at the upper one, a turn away. The elbow is always
/// inside the link, and in no obstacle.
#[test]
fn permanent_contact_closes_nothing() {
    let (far, half, radius) = (0.9_f64, 0.1_f64, 0.1);
    // Link and obstacle are segments grown by the radius; the link just touches an end of the obstacle's.
    let touching = (half / far).atan() + (2.0 * radius / far.hypot(half)).asin();
    let around = JointRange::Interval { lower: touching - PI, upper: PI - touching };
    let first = JointRange::Interval { lower: -0.5, upper: 0.48 };
    let slide = JointType::Prismatic { direction: Vector::y() };
    let turn = JointType::Revolute { sign: 1.0 };
    let capsule = |from: Point, to: Point| convex(vec![from, to], radius);
    for motion in [slide, turn] {
        let joints = [joint("first", motion, first), joint("second", turn, around)];
        let second = link("second", vec![capsule(Point::zeros(), Point::new(1.0, 0.0))]);
        let arm = arm(joints, [link("first", Vec::new()), second], Vector::zeros(), Point::new(1.0, 0.0));
        let scene = scene(arm, vec![capsule(Point::new(-far, -half), Point::new(-far, half))]);
        let problem = motion_problem(scene, q(-0.4, 0.0), q(0.4, 0.0));
        for factor in LIMITS {
            let found = bound(&problem, Metric::Euclidean, factor * 0.8, 1e-4);
            assert!((found - 0.8).abs() <= 2.0 * ROUNDING, "{motion:?}: {found}, not 0.8");
        }
    }
}
