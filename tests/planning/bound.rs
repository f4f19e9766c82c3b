//! Bounds on the optimum, compared with closed forms, with published figures, and with the paths of all other planners.

use cplan::Outcome;
use cplan::engine::{Answer, Bound, Criterion, Method, Planner, Space, bound, solve};
use cplan::geometry::{Convex, Point};
use cplan::model::MotionProblem;
use cplan::proofs::{MotionQuery, least_length};
use cplan::space::{Configuration, GoalSet, JointRange, Metric, Path};
use cplan_testkit::arms::{gantry, rr};
use cplan_testkit::problems::{self, Benchmark, motion_problem, shipped_feasible};
use cplan_testkit::scenes::{obstacle, q, scene};
use cplan_testkit::shapes::disc;
use std::f64::consts::TAU;

/// Planners that search for the optimum.
const PLANNERS: [Method; 2] = [Method::Shortest, Method::Visibility];

const CRITERIA: [Criterion; 3] = [Criterion::Euclidean, Criterion::Weighted([1.0, 0.3]), Criterion::Time];

fn answer(problem: &MotionProblem, criterion: Criterion, gap: Option<f64>) -> Answer {
    answer_by(Method::Visibility, problem, criterion, gap)
}

fn answer_by(method: Method, problem: &MotionProblem, criterion: Criterion, gap: Option<f64>) -> Answer {
    let planner = Planner::named(method).with_criterion(criterion);
    let planner = gap.map_or(planner, |gap| planner.with_gap(gap));
    solve(problem, &planner.into(), &mut |_| {})
}

fn path(answer: &Answer) -> &Path {
    match &answer.outcome {
        Outcome::Found(certified) => certified.path(),
        other => panic!("{other:?}"),
    }
}

fn bounded(answer: &Answer) -> Bound {
    answer.bound().unwrap_or_else(|| panic!("no bound: {:?} {:?}", answer.outcome, answer.history))
}

#[test]
fn a_gap_of_a_thousandth_is_reached_on_every_feasible_workspace() {
    for (name, problem) in shipped_feasible() {
        for planner in PLANNERS {
            let answer = answer_by(planner, &problem, Criterion::Euclidean, Some(0.001));
            let bound = bounded(&answer);
            assert_eq!(bound.upper, path(&answer).length(), "{name}");
            assert!(bound.lower <= bound.upper && bound.gap() <= 0.001, "{name}, {planner}: {bound:?}");
        }
    }
}

/// Checks that the gap is below the default in every metric, and a hundred times smaller on request.
#[test]
fn the_shortest_path_is_within_a_ten_thousandth_on_every_feasible_workspace() {
    for (name, problem) in shipped_feasible() {
        let each = CRITERIA.map(|criterion| (criterion, None));
        for (criterion, gap) in each.into_iter().chain([(Criterion::Euclidean, Some(1e-6))]) {
            let answer = answer_by(Method::Shortest, &problem, criterion, gap);
            let metric = criterion.metric(problem.scene().arm());
            let bound = bounded(&answer);
            assert_eq!(bound.upper, metric.length(path(&answer)), "{name}");
            assert!(bound.gap() <= gap.unwrap_or(1e-4), "{name}, {metric:?}: {} of {gap:?}", bound.gap());
            // The planner needs a graph only for gantries, whose C-obstacles are polygons.
            let is_gantry = problem.scene().arm().kind() == "PP";
            assert_eq!(matches!(answer.space, Space::Regions(_)), is_gantry, "{name}, {metric:?}");
        }
    }
}

/// Checks that no bound exceeds the length of a certified path, because such a bound would be false.
#[test]
fn no_planner_finds_a_path_below_the_bound() {
    for (name, problem) in shipped_feasible() {
        let metrics = CRITERIA.map(|criterion| criterion.metric(problem.scene().arm()));
        let lower = CRITERIA.map(|criterion| bounded(&answer(&problem, criterion, Some(0.01))).lower);
        for method in Method::ALL.into_iter().filter(|&method| method != Method::Harmonic) {
            if let Outcome::Found(found) = solve(&problem, &method.into(), &mut |_| {}).outcome {
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
            let answer = answer_by(planner, &problems::problem(which), Criterion::Euclidean, Some(1e-4));
            let bound = bounded(&answer);
            assert!(bound.gap() <= 1e-4 && bound.upper == path(&answer).length(), "{which:?}: {bound:?}");
            // The published figures have four decimals.
            assert!(bound.lower <= optimum + 5e-5 && optimum - 5e-5 <= bound.upper, "{which:?}: {bound:?}");
        }
    }
}

fn problem_among(
    axes: [JointRange; 2],
    pieces: Vec<Convex>,
    start: Configuration,
    goals: &[Configuration],
) -> MotionProblem {
    let obstacles = pieces.into_iter().map(|piece| obstacle("block", piece)).collect::<Vec<_>>();
    let pieces = obstacles.into_iter().flat_map(|o| o.pieces).collect();
    motion_problem(scene(rr(axes), pieces), start, goals.iter().copied().collect::<GoalSet>())
}

#[test]
fn without_obstacles_the_bound_is_the_shortest_displacement() {
    let circles = [JointRange::Circle, JointRange::Circle];
    let problem = problem_among(circles, Vec::new(), q(-3.0, 0.0), &[q(3.0, 0.5)]);
    let straight = (TAU - 6.0).hypot(0.5);
    let found = bounded(&answer(&problem, Criterion::Euclidean, None));
    assert!((found.lower - straight).abs() < 1e-8 && (found.upper - straight).abs() < 1e-8, "{found:?}");
    let [first, second] = problem.scene().arm().joints.each_ref().map(|joint| joint.velocity);
    let slower = f64::max((TAU - 6.0) / first, 0.5 / second);
    let time = bounded(&answer(&problem, Criterion::Time, None));
    assert!((time.lower - slower).abs() < 1e-8 && (time.upper - slower).abs() < 1e-8, "{time:?}");
}

/// Checks that the bound is that of the nearest goal if there are several.
#[test]
fn the_bound_covers_all_goals() {
    let interval = JointRange::Interval { lower: -3.0, upper: 3.0 };
    let goals = [q(2.0, 2.0), q(1.0, 0.0), q(-2.0, 1.0)];
    let problem = problem_among([interval, interval], Vec::new(), q(0.0, 0.0), &goals);
    let found = bounded(&answer(&problem, Criterion::Euclidean, None));
    assert!((found.lower - 1.0).abs() < 1e-8, "{found:?}");
}

/// Checks a path to the middle of a square spiral of walls. Its length is proven within the default gap, and the stated
/// bound does not exceed the one that strips give.
#[test]
fn gantries_find_paths_into_spirals() {
    let (gap, radius) = (1.0, 0.2);
    for turns in [2, 6] {
        let size = gap * f64::from(turns);
        let arm = gantry([-size - 3.0, size + 3.0], vec![disc(Point::zeros(), radius)]);
        // From the middle outwards. Each length occurs on two sides.
        let mut corners = vec![Point::zeros()];
        for side in 0..4 * turns {
            let (sin, cos) = (TAU / 4.0 * f64::from(side)).sin_cos();
            let length = gap * f64::from(side / 2 + 1);
            corners.push(corners[corners.len() - 1] + nalgebra::Vector2::new(cos.round(), sin.round()) * length);
        }
        let walls: Vec<Convex> =
            corners.windows(2).map(|ends| Convex::segment(ends[0], ends[1]).expect("finite")).collect();
        let problem = motion_problem(scene(arm, walls), q(size + 2.0, size + 2.0), q(0.5, 0.5));
        let answer = answer_by(Method::Shortest, &problem, Criterion::Euclidean, None);
        let found = bounded(&answer);
        assert!(found.gap() <= 1e-4 && matches!(answer.space, Space::Regions(_)), "{turns}: {found:?}");
        // The strips share no code with the bound, and confirm it up to their own gap.
        let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
        let motions = MotionQuery { scene, start, goals, clearance: 0.0, metric: Metric::Euclidean };
        let strips = least_length(&motions, found.upper, 1e-3, &[]);
        assert!(strips <= found.upper && found.lower <= strips * 1.005, "{turns}: {found:?}, {strips}");
    }
}

/// Checks that the gap is that between the bound and the given path, whichever planner found the path.
#[test]
fn a_detour_has_a_gap() {
    let problem = problems::problem(Benchmark::A);
    let shortest = answer(&problem, Criterion::Euclidean, Some(1e-3));
    let Outcome::Found(other) = solve(&problem, &Method::Wavefront.into(), &mut |_| {}).outcome else {
        panic!("problem A has a path")
    };
    let gap = bound(&problem, other.path(), Metric::Euclidean, 1e-4).gap();
    let longer = other.path().length() / path(&shortest).length() - 1.0;
    assert!(gap >= longer - 1e-9 && gap <= longer + 2e-3, "{gap} {longer}");
}
