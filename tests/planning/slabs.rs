//! Slabs of joint 1, compared with collision tests of sampled configurations, with the subdivision into boxes, and with
//! the independent check.

use crate::optimum::obstacle;
use cplan::Outcome;
use cplan::check::{Cell, certify_at};
use cplan::engine::decide;
use cplan::geometry::{Point, Vector};
use cplan::model::{JointType, Scene};
use cplan::proofs::{Connectivity, connectivity, slab_connectivity};
use cplan::space::{Configuration, GoalSet, JointRange};
use cplan_testkit::arms::{all_kinds, arm, joint, link, rr};
use cplan_testkit::problems::{Benchmark, benchmark, recheck};
use cplan_testkit::scenes::{clutter, configuration_at_fractions, q, scene};
use cplan_testkit::shapes::{convex, disc, rectangle, wall};
use cplan_testkit::shipped;
use proptest::prelude::*;

const SLABS: usize = 20_000;

/// Number of boxes for cases that slabs do not decide.
const BOXES: usize = 200_000;

/// Checks an answer by code that shares nothing with the slabs. Paths are certified, proofs are checked as boxes, and
/// samples check both. Returns true for a path, false for a proof, and `None` for neither.
fn check(scene: &Scene, start: Configuration, goals: &GoalSet, clearance: f64) -> Option<bool> {
    match slab_connectivity(scene, start, goals, clearance, SLABS, BOXES) {
        Connectivity::Connected(channel) => {
            let path = channel.path();
            let topology = scene.arm().topology();
            assert_eq!(path.start(), start);
            assert!(goals.contains(&topology, path.goal(), 1e-12), "{path:?}");
            for (a, b) in path.segments() {
                for i in 0..=200 {
                    let at = a + (b - a) * (f64::from(i) / 200.0);
                    let distance = scene.clearance(at);
                    assert!(distance > 0.0 && distance >= clearance, "{distance} at {at:?}");
                }
            }
            let certified = certify_at(scene, path.clone(), clearance).unwrap_or_else(|why| panic!("{why:?}"));
            assert_eq!(certified.path(), &path);
            Some(true)
        }
        Connectivity::Disconnected(proof) => {
            assert_eq!(recheck(proof.collision_boxes(), scene, start, goals, clearance), Ok(()));
            for stuck in proof.collision_boxes() {
                assert!(corners_and_middle(&stuck.cell).all(|at| scene.clearance(at) < clearance), "{stuck:?}");
            }
            Some(false)
        }
        Connectivity::Undecided { .. } => None,
    }
}

fn corners_and_middle(cell: &Cell) -> impl Iterator<Item = Configuration> + use<> {
    let (l, u) = (cell.lower, cell.upper);
    [cell.center(), q(l[0], l[1]), q(l[0], u[1]), q(u[0], l[1]), q(u[0], u[1])].into_iter()
}

/// Checks that slabs and boxes both give an answer.
fn check_both(scene: &Scene, start: Configuration, goal: Configuration, clearance: f64, expected: bool) {
    assert_eq!(check(scene, start, &goal.into(), clearance), Some(expected));
    check_boxes(scene, start, goal, clearance, expected);
}

fn check_boxes(scene: &Scene, start: Configuration, goal: Configuration, clearance: f64, expected: bool) {
    match connectivity(scene, start, &goal.into(), clearance, BOXES) {
        Connectivity::Connected(channel) => {
            let path = channel.path();
            assert!(expected && path.start() == start && scene.arm().topology().distance(path.goal(), goal) < 1e-12);
            certify_at(scene, path, clearance).expect("a chain of free boxes is free");
        }
        Connectivity::Disconnected(proof) => {
            assert!(!expected);
            assert_eq!(recheck(proof.collision_boxes(), scene, start, &goal.into(), clearance), Ok(()));
        }
        Connectivity::Undecided { .. } => panic!("the boxes do not decide"),
    }
}

#[test]
fn benchmark_problems_are_decided() {
    for (which, connected) in
        [(Benchmark::A, true), (Benchmark::B, true), (Benchmark::Inf, false), (Benchmark::T, false)]
    {
        let (scene, start, goal) = benchmark(which);
        check_both(&scene, start, goal, 0.0, connected);
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(200))]

    #[test]
    fn random_scenes_are_answered_as_the_boxes_answer_them(
        kind in 0_usize..5, obstacles in prop::collection::vec(obstacle(), 1..7),
        a in (0.0..1.0_f64, 0.0..1.0_f64), b in (0.0..1.0_f64, 0.0..1.0_f64),
        clearance in prop_oneof![Just(0.0), 0.0..0.05_f64],
    ) {
        let scene = scene(all_kinds().swap_remove(kind), obstacles);
        let (start, goal) = (configuration_at_fractions(&scene, a), configuration_at_fractions(&scene, b));
        prop_assume!(scene.clearance(start) > clearance + 1e-6 && scene.clearance(goal) > clearance + 1e-6);
        agrees_with_the_boxes(&scene, start, goal, clearance);
    }
}

/// Checks that slabs and boxes agree if both decide.
fn agrees_with_the_boxes(scene: &Scene, start: Configuration, goal: Configuration, clearance: f64) {
    if let Some(connected) = check(scene, start, &goal.into(), clearance) {
        match connectivity(scene, start, &goal.into(), clearance, 20_000) {
            Connectivity::Connected(_) => assert!(connected),
            Connectivity::Disconnected(_) => assert!(!connected),
            Connectivity::Undecided { .. } => {}
        }
    }
}

/// Checks a case that `random_scenes_are_answered_as_the_boxes_answer_them` found: collision intervals across the seam
/// of joint 2 belong to the proof.
#[test]
fn a_proof_may_reach_across_the_seam() {
    let disc = disc(Point::new(-0.2574244886139003, -0.7541749868020048), 0.03);
    let wall = [(-0.8754122955094447, -0.6096296790282105), (-1.1648286518001902, -0.6096296790282105)];
    let capsule = convex(wall.map(|(x, y)| Point::new(x, y)).to_vec(), 0.04823605938179094);
    let scene = scene(all_kinds().swap_remove(0), vec![disc, capsule]);
    let (start, goal) = (
        configuration_at_fractions(&scene, (0.14021252832200662, 0.39818998128329575)),
        configuration_at_fractions(&scene, (0.0, 0.0)),
    );
    assert!(scene.clearance(start) > 0.0 && scene.clearance(goal) > 0.0);
    agrees_with_the_boxes(&scene, start, goal, 0.0);
}

/// Checks two segments without thickness. A shape without area contains no smaller shape, so only two answers are
/// possible: a path, or a proof that joint 1 alone closes the space.
#[test]
fn thin_links_among_thin_walls_are_decided() {
    let thin = |axes| {
        let mut arm = rr(axes);
        arm.links[0].parts[0].shape = wall(Point::zeros(), Point::new(1.0, 0.0));
        arm.links[1].parts[0].shape = wall(Point::zeros(), Point::new(0.8, 0.0));
        arm
    };
    let circles = [JointRange::Circle, JointRange::Circle];
    // Slanted walls block the upper arm. Without one of them, it can pass in the other direction.
    let front = wall(Point::new(0.5, -0.2), Point::new(0.7, 0.3));
    let back = wall(Point::new(-0.6, -0.3), Point::new(-0.7, 0.1));
    let (start, goal) = (q(-1.2, 0.4), q(1.3, -0.4));
    check_both(&scene(thin(circles), vec![front.clone()]), start, goal, 0.0, true);
    check_both(&scene(thin(circles), vec![front, back]), start, goal, 0.0, false);
    // A wall beyond the elbow's circle, for which the limits keep the forearm stretched enough. Slabs leave it open.
    let narrow = [JointRange::Interval { lower: -1.5, upper: 1.5 }, JointRange::Interval { lower: -0.4, upper: 0.4 }];
    let beyond = scene(thin(narrow), vec![wall(Point::new(1.05, 0.1), Point::new(1.7, -0.2))]);
    check_boxes(&beyond, q(-1.2, 0.1), q(1.3, -0.1), 0.0, false);
}

#[test]
fn a_scene_without_obstacles_is_connected() {
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![]);
    assert_eq!(check(&scene, q(0.1, 0.2), &q(3.0, -3.0).into(), 0.0), Some(true));
    assert_eq!(check(&scene, q(0.1, 0.2), &q(0.1, 0.2).into(), 0.0), Some(true));
    // Copies of a goal on a circle are also goals.
    assert_eq!(check(&scene, q(0.1, 0.2), &q(9.0, -9.0).into(), 0.0), Some(true));
}

#[test]
fn a_base_inside_an_obstacle_is_never_connected() {
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![rectangle(-0.1, 0.1, -0.1, 0.1)]);
    assert_ne!(check(&scene, q(0.0, 0.0), &q(1.0, 0.0).into(), 0.0), Some(true));
}

/// Checks links that do not contain their pivots, and an elbow whose circle passes through an obstacle or touches it.
#[test]
fn odd_links_and_elbows_on_obstacles_are_decided() {
    let turn = JointType::Revolute { sign: -1.0 };
    let arm = arm(
        [joint("a", turn, JointRange::Circle), joint("b", turn, JointRange::Circle)],
        [link("one", vec![rectangle(0.2, 0.5, 0.1, 0.2)]), link("two", vec![rectangle(0.3, 0.8, -0.3, -0.25)])],
        Vector::new(0.0, 1.0),
        Point::new(0.8, 0.0),
    );
    // Obstacles on the elbow's circle (radius 1): one across it, one that touches it from inside, one from outside, and
    // one with a corner on it.
    let around = [
        disc(Point::new(0.6, 0.8), 0.2),
        disc(Point::new(0.8, 0.0), 0.2),
        disc(Point::new(-1.2, 0.0), 0.2),
        rectangle(0.0, 0.3, -1.3, -1.0),
    ];
    let mut answers = Vec::new();
    for (i, first) in around.iter().enumerate() {
        for second in &around[i..] {
            let scene = scene(arm.clone(), vec![first.clone(), second.clone()]);
            let free: Vec<_> = (0..40)
                .map(|k| q(f64::from(k) * 2.4 - 40.0, f64::from(k) * 1.7))
                .map(|at| scene.arm().topology().wrap(at))
                .filter(|&at| scene.clearance(at) > 1e-3)
                .collect();
            assert!(free.len() > 1);
            answers.extend(free.windows(2).map(|w| check(&scene, w[0], &w[1].into(), 0.0)));
        }
    }
    let decided = answers.iter().filter(|a| a.is_some()).count();
    assert!(decided == answers.len(), "{decided} of {}", answers.len());
}

/// Checks limits that are longer than a turn. The same pose of the arm occurs at several configurations, and there may
/// be no path between two of them.
#[test]
fn limits_longer_than_a_turn_are_decided() {
    let long = JointRange::Interval { lower: -5.0, upper: 5.0 };
    let narrow = JointRange::Interval { lower: -0.5, upper: 0.5 };
    let pole = disc(Point::new(0.0, 0.7), 0.1);
    let closed = scene(rr([long, narrow]), vec![pole.clone()]);
    let turn = std::f64::consts::TAU;
    assert_eq!(check(&closed, q(-4.0, 0.1), &q(turn - 4.0, 0.1).into(), 0.0), Some(false));
    let open = scene(rr([long, narrow]), vec![]);
    assert_eq!(check(&open, q(-4.0, 0.1), &q(turn - 4.0, 0.1).into(), 0.0), Some(true));
    // For every position of the elbow, the forearm reaches the point.
    let second = scene(rr([narrow, long]), vec![disc(Point::new(1.2, 0.3), 0.15)]);
    assert_eq!(check(&second, q(0.0, -4.0), &q(0.0, turn - 4.0).into(), 0.0), Some(false));
}

/// Checks a pole that the arm can pass on the torus, but not within limits that end before it.
#[test]
fn limits_and_clearance_close_passages() {
    let half = JointRange::Interval { lower: 0.0, upper: 3.0 };
    let [narrow, folding] = [0.1, 3.0].map(|upper| JointRange::Interval { lower: -upper, upper });
    for (axes, clearance, connected) in [
        ([JointRange::Circle; 2], 0.0, true),
        ([half, narrow], 0.0, false),
        ([half, folding], 0.0, true),
        // The folded forearm comes within 0.4 m of the pole when the elbow passes under it.
        ([half, folding], 0.4, false),
    ] {
        let pole = scene(rr(axes), vec![disc(Point::new(0.0, 1.4), 0.05)]);
        check_both(&pole, q(0.5, 0.0), q(2.6, 0.0), clearance, connected);
    }
}

#[test]
fn joints_that_cannot_move_are_left_undecided() {
    let fixed = JointRange::Interval { lower: 0.5, upper: 0.5 };
    let scene = scene(rr([fixed, JointRange::Circle]), clutter());
    assert_eq!(check(&scene, q(0.5, 0.0), &q(0.5, 0.1).into(), 0.0), None);
}

/// Checks all shipped workspaces, among them the six closed twins and the six open ones.
#[test]
fn shipped_workspaces_have_the_stated_answers() {
    let worlds = shipped::worlds("");
    assert!(worlds.len() > 20, "{}", worlds.len());
    for world in worlds {
        let (name, problem, feasible) = (&world.name, world.motion(), world.expect == "found");
        let (scene, clearance) = (problem.scene(), problem.scene().workspace().clearance);
        let connected = check(scene, problem.start(), problem.goals(), clearance);
        assert_eq!(connected, Some(feasible), "{name}");
        match decide(&problem, BOXES) {
            Outcome::Found(path) => assert!(feasible && path.clearance() >= clearance, "{name}"),
            Outcome::Infeasible(_) => assert!(!feasible, "{name}"),
            Outcome::Unknown(why) => panic!("{name}: {why}"),
        }
    }
}
