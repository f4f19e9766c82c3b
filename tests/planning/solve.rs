//! The benchmark problems with published answers, with every planner.

use cplan::Outcome;
use cplan::cspace::Proves;
use cplan::engine::{Answer, GridSpace, Method, Options, Planner, Space, solve};
use cplan::space::JointRange;
use cplan_testkit::arms::rr;
use cplan_testkit::problems::{Benchmark, benchmark, motion_problem, problem, shipped_feasible};
use cplan_testkit::scenes::{q, scene};
use cplan_testkit::shapes::rectangle;

fn answer(which: Benchmark, method: Method) -> Answer {
    solve(&problem(which), &method.into(), &mut |_| {})
}

#[test]
fn narrow_passages_are_found() {
    for method in [Method::Visibility, Method::Trapezoid, Method::Wavefront, Method::Harmonic, Method::Subdivision] {
        for (which, optimum) in [(Benchmark::A, 6.4229), (Benchmark::B, 6.4281)] {
            let answer = answer(which, method);
            let Outcome::Found(certified) = &answer.outcome else {
                panic!("{which:?} by {method}: {:?}\n{:?}", answer.outcome, answer.history);
            };
            assert!(
                certified.clearance() > 0.0 && certified.path().length() >= optimum - 1e-3,
                "{which:?} by {method}"
            );
        }
    }
}

/// Checks that grids with collision checks only make proposals. Paths that they propose are certified, and they prove
/// no infeasibility.
#[test]
fn sampled_grids_lead_to_the_verdicts_of_exact_rows() {
    for method in [Method::Wavefront, Method::Harmonic] {
        for (which, optimum) in
            [(Benchmark::A, Some(6.4229)), (Benchmark::B, Some(6.4281)), (Benchmark::Inf, None), (Benchmark::T, None)]
        {
            let planner = Planner::named(method).with_space(GridSpace::Sampled);
            let answer = solve(&problem(which), &planner.into(), &mut |_| {});
            match (&answer.outcome, optimum) {
                (Outcome::Found(path), Some(optimum)) => {
                    assert!(path.clearance() > 0.0 && path.path().length() >= optimum - 1e-3, "{which:?} by {method}");
                }
                (Outcome::Infeasible(proof), None) => assert!(!proof.collision_boxes().is_empty()),
                (verdict, _) => panic!("{which:?} by {method}: {verdict:?}, {:?}", answer.history),
            }
            let Space::Grid(grid) = &answer.space else { panic!("{method} works on cells") };
            assert_eq!(grid.proves, Proves::Sampled);
        }
    }
}

/// Checks coarse cells, which may contain obstacles although their centres are free. With a single pass, no world is
/// reported as infeasible, and each path is certified.
#[test]
fn coarse_samples_are_never_the_last_word() {
    let planner = Planner::named(Method::Wavefront).with_space(GridSpace::Sampled).with_cells(16);
    let options = Options { levels: 1, ..planner.into() };
    let (mut found, mut unknown) = (0, 0);
    for (name, problem) in shipped_feasible() {
        match solve(&problem, &options, &mut |_| {}).outcome {
            Outcome::Found(path) => {
                found += 1;
                let clearance = problem.scene().workspace().clearance;
                assert!(path.clearance() > 0.0 && path.clearance() >= clearance, "{name}");
            }
            Outcome::Infeasible(_) => panic!("{name} has a way"),
            Outcome::Unknown(_) => unknown += 1,
        }
    }
    assert!(found > 0 && unknown > 0, "{found} found, {unknown} unknown");
}

#[test]
fn infeasible_problems_are_proven_infeasible() {
    for which in [Benchmark::Inf, Benchmark::T] {
        for method in Method::ALL {
            let answer = answer(which, method);
            assert!(matches!(answer.outcome, Outcome::Infeasible(_)), "{which:?} by {method}: {:?}", answer.outcome);
        }
    }
}

/// Checks an outstretched arm that points at a wall a micrometre away. That is far less than the margin by which
/// polygons are grown.
#[test]
fn ends_with_little_room_are_answered_at_the_first_level() {
    let scene = scene(rr([JointRange::Circle, JointRange::Circle]), vec![rectangle(1.8 + 1e-6, 2.0, -0.5, 0.5)]);
    let (tight, roomy) = (q(0.0, 0.0), q(2.0, 0.5));
    for (start, goal) in [(tight, roomy), (roomy, tight), (tight, tight)] {
        let problem = motion_problem(scene.clone(), start, goal);
        for method in Method::ALL {
            let answer = solve(&problem, &Options { levels: 1, ..method.into() }, &mut |_| {});
            let Outcome::Found(certified) = &answer.outcome else {
                panic!("{method} from {start:?}: {:?}\n{:?}", answer.outcome, answer.history);
            };
            assert_eq!(certified.path().start(), start, "{method}");
            assert!(problem.scene().arm().topology().distance(certified.path().goal(), goal) < 1e-9, "{method}");
            assert!(certified.clearance() > 0.0 && certified.clearance() <= 1e-6 + 1e-12, "{method}");
        }
    }
}

/// Checks a start whose distance from obstacles is exactly the clearance.
#[test]
fn a_start_without_room_to_spare_is_answered() {
    let (scene, start, goal) = benchmark(Benchmark::A);
    let clearance = scene.clearance(start);
    let problem = motion_problem(scene.with_clearance(clearance).unwrap(), start, goal);
    for method in [Method::Visibility, Method::Trapezoid] {
        let answer = solve(&problem, &Options { levels: 1, boxes: 1000, ..method.into() }, &mut |_| {});
        // With exactly the clearance, no answer can be certified.
        assert!(!matches!(answer.outcome, Outcome::Found(_)), "{method}");
    }
}
