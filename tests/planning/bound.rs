//! Bounds on the optimum, against closed forms, published figures and the paths of every other planner.

use crate::common::{self, Benchmark, asked, disc, obstacle, q, rr, scene, shipped_feasible};
use cplan::engine::{Answer, Bound, Effort, Method, Space, Verdict, bound, solve};
use cplan::geometry::{Convex, Point};
use cplan::model::MotionProblem;
use cplan::space::{Configuration, GoalSet, JointRange, Metric, Path};
use std::f64::consts::TAU;

/// Those that are after the optimum.
const PLANNERS: [Method; 2] = [Method::Shortest, Method::Visibility];

fn answer(problem: &MotionProblem, metric: Metric, gap: Option<f64>) -> Answer {
    answer_by(Method::Visibility, problem, metric, gap)
}

fn answer_by(method: Method, problem: &MotionProblem, metric: Metric, gap: Option<f64>) -> Answer {
    solve(problem, method, &Effort { metric, gap, ..Effort::default() }, &mut |_| {})
}

fn path(answer: &Answer) -> &Path {
    match &answer.verdict {
        Verdict::Found(certified) => certified.path(),
        other => panic!("{other:?}"),
    }
}

fn bounded(answer: &Answer) -> Bound {
    answer.bound.unwrap_or_else(|| panic!("no bound: {:?} {:?}", answer.verdict, answer.history))
}

#[test]
fn a_gap_of_a_thousandth_is_reached_on_every_feasible_workspace() {
    for (name, problem) in shipped_feasible() {
        for planner in PLANNERS {
            let answer = answer_by(planner, &problem, Metric::Euclidean, Some(0.001));
            let bound = bounded(&answer);
            assert_eq!(bound.upper, path(&answer).length(), "{name}");
            assert!(bound.lower <= bound.upper && bound.gap() <= 0.001, "{name}, {planner}: {bound:?}");
        }
    }
}

/// By default, in every metric; and a hundred times closer where it is asked for.
#[test]
fn the_shortest_path_is_within_a_ten_thousandth_on_every_feasible_workspace() {
    for (name, problem) in shipped_feasible() {
        let speeds = problem.scene().arm().joints.each_ref().map(|joint| joint.velocity);
        let metrics = [Metric::Euclidean, Metric::Weighted { weights: [1.0, 0.3] }, Metric::Time { speeds }];
        for (metric, gap) in metrics.map(|metric| (metric, None)).into_iter().chain([(Metric::Euclidean, Some(1e-6))]) {
            let answer = answer_by(Method::Shortest, &problem, metric, gap);
            let bound = bounded(&answer);
            assert_eq!(bound.upper, metric.length(path(&answer)), "{name}");
            assert!(bound.gap() <= gap.unwrap_or(1e-4), "{name}, {metric:?}: {} of {gap:?}", bound.gap());
            // No graph was needed.
            assert!(!matches!(answer.space, Space::Regions(_)), "{name}, {metric:?}");
        }
    }
}

/// A lower bound above the length of a path that is certified would be a lie.
#[test]
fn no_planner_finds_a_path_below_the_bound() {
    for (name, problem) in shipped_feasible() {
        let speeds = problem.scene().arm().joints.each_ref().map(|joint| joint.velocity);
        let metrics = [Metric::Euclidean, Metric::Weighted { weights: [1.0, 0.3] }, Metric::Time { speeds }];
        let lower = metrics.map(|metric| bounded(&answer(&problem, metric, Some(0.01))).lower);
        for method in Method::ALL.into_iter().filter(|&method| method != Method::Harmonic) {
            if let Verdict::Found(found) = solve(&problem, method, &Effort::default(), &mut |_| {}).verdict {
                for (metric, lower) in metrics.into_iter().zip(lower) {
                    let length = metric.length(found.path());
                    assert!(lower <= length, "{name}, {method}, {metric:?}: {lower} above {length}");
                }
            }
        }
    }
}

#[test]
fn published_optima_lie_within_the_bounds() {
    for (which, optimum) in [(Benchmark::A, 6.4229), (Benchmark::B, 6.4281)] {
        for planner in PLANNERS {
            let bound = bounded(&answer_by(planner, &common::problem(which), Metric::Euclidean, Some(1e-4)));
            assert!(bound.gap() <= 1e-4, "{which:?}: {bound:?}");
            // Published with four digits.
            assert!(bound.lower <= optimum + 5e-5 && optimum - 5e-5 <= bound.upper, "{which:?}: {bound:?}");
        }
    }
}

fn among(axes: [JointRange; 2], pieces: Vec<Convex>, start: Configuration, goals: &[Configuration]) -> MotionProblem {
    let obstacles = pieces.into_iter().map(|piece| obstacle("block", piece)).collect::<Vec<_>>();
    let pieces = obstacles.into_iter().flat_map(|o| o.pieces).collect();
    asked(scene(rr(axes), pieces), start, goals.iter().copied().collect::<GoalSet>())
}

#[test]
fn without_obstacles_the_bound_is_the_straight_way_the_short_way_round() {
    let circles = [JointRange::Circle, JointRange::Circle];
    let problem = among(circles, Vec::new(), q(-3.0, 0.0), &[q(3.0, 0.5)]);
    let straight = (TAU - 6.0).hypot(0.5);
    let found = bounded(&answer(&problem, Metric::Euclidean, None));
    assert!((found.lower - straight).abs() < 1e-8 && (found.upper - straight).abs() < 1e-8, "{found:?}");
    let time = bounded(&answer(&problem, Metric::Time { speeds: [0.5, 0.1] }, None));
    assert!((time.lower - 5.0).abs() < 1e-8 && (time.upper - 5.0).abs() < 1e-8, "{time:?}");
}

/// Of several goals the nearest counts.
#[test]
fn the_bound_covers_all_goals() {
    let interval = JointRange::Interval { lower: -3.0, upper: 3.0 };
    let goals = [q(2.0, 2.0), q(1.0, 0.0), q(-2.0, 1.0)];
    let problem = among([interval, interval], Vec::new(), q(0.0, 0.0), &goals);
    let found = bounded(&answer(&problem, Metric::Euclidean, None));
    assert!((found.lower - 1.0).abs() < 1e-8, "{found:?}");
}

/// A bar of a gantry's tool passes a block: around its corner in two straight pieces, of known length.
#[test]
fn around_a_block_the_bound_is_the_shortest_path() {
    let tool = disc(Point::origin(), 0.0);
    let slide =
        |angle: f64| cplan::model::JointType::Prismatic { direction: Point::new(angle.cos(), angle.sin()).coords };
    let axis = JointRange::Interval { lower: -2.0, upper: 2.0 };
    let joints = [common::joint("x", slide(0.0), axis), common::joint("y", slide(TAU / 4.0), axis)];
    let links = [common::link("beam", Vec::new()), common::link("tool", vec![tool])];
    let arm = common::arm(joints, links, Point::origin().coords, Point::origin());
    let block = common::rectangle(-0.5, 0.5, -2.5, 0.25);
    let problem = asked(scene(arm, vec![block]), q(-1.5, 0.0), q(1.5, 0.0));
    let string = 1.0 + 2.0 * 1.0_f64.hypot(0.25);
    let found = bounded(&answer(&problem, Metric::Euclidean, Some(1e-5)));
    assert!(found.lower <= string && string <= found.upper && found.gap() <= 1e-5, "{found:?} {string}");
}

/// The bound speaks of the path it is given, whoever planned it.
#[test]
fn a_detour_has_a_gap() {
    let problem = common::problem(Benchmark::A);
    let shortest = answer(&problem, Metric::Euclidean, Some(1e-3));
    let Verdict::Found(other) = solve(&problem, Method::Wavefront, &Effort::default(), &mut |_| {}).verdict else {
        panic!("problem A has a path")
    };
    let gap = bound(&problem, other.path(), Metric::Euclidean, 1e-4).gap();
    let longer = other.path().length() / path(&shortest).length() - 1.0;
    assert!(gap >= longer - 1e-9 && gap <= longer + 2e-3, "{gap} {longer}");
}
