//! Decisions whether there is a path at all: among thousands of pieces, and in cases that boxes cannot decide.

use cplan::check::certify;
use cplan::engine::{Method, decide, solve};
use cplan::geometry::{Point, shapes_meet};
use cplan::input::{self, Overrides};
use cplan::model::{Growth, Heights, MotionProblem, Obstacle, Shape, Workspace};
use cplan::space::JointRange;
use cplan::{Options, Outcome};
use cplan_testkit::arms::rr;
use cplan_testkit::problems::{motion_problem, recheck};
use cplan_testkit::scenes::{placed, q};
use cplan_testkit::shapes::wall;
use cplan_testkit::shipped;
use std::f64::consts::TAU;

/// Returns a problem with `count` short walls on a circle around the base. The outstretched arm reaches beyond the
/// circle between walls in two places, and must move from one to the other. It can do so only if it can fold.
fn ring(count: usize, folding: f64) -> MotionProblem {
    let at = |k: usize| {
        let angle = TAU * k as f64 / count as f64;
        // Some noise, so that neighbouring walls are not in line.
        let radius = 1.5 + 0.01 * (k as f64 * 0.618_033_988_749).fract();
        Point::new(radius * angle.cos(), radius * angle.sin())
    };
    let points: Vec<Point> = (0..=count).map(at).collect();
    let ends = points.windows(2).filter(|w| w[0].y.abs() > 0.5);
    let pieces = ends.map(|w| wall(w[0], w[1])).collect();
    let obstacle = Obstacle {
        name: "ring".into(),
        shape: Shape::Pieces,
        pieces,
        heights: Heights::ALL,
        growth: Growth::default(),
    };
    let workspace =
        Workspace { name: "ring".into(), obstacles: vec![obstacle], clearance: 0.0, preferences: Vec::new() };
    let scene = placed(rr([JointRange::Circle, JointRange::Interval { lower: -folding, upper: folding }]), workspace);
    motion_problem(scene, q(0.0, 0.0), q(3.0, 0.0))
}

#[test]
fn a_path_among_20_000_pieces_is_found_and_certified() {
    let problem = ring(20_000, 3.0);
    let verdict = decide(&problem, 20_000);
    let Outcome::Found(path) = verdict else { panic!("an arm that folds gets there: {verdict:?}") };
    assert_eq!(certify(problem.scene(), path.path().clone()).expect("free").path(), path.path());
    let certified_ends = [path.path().start(), path.path().goal()];
    assert!(
        certified_ends
            .iter()
            .zip([problem.start(), q(3.0, 0.0)])
            .all(|(a, b)| { problem.scene().arm().topology().distance(*a, b) < 1e-9 })
    );
}

#[test]
fn infeasibility_among_20_000_pieces_is_proven_with_original_pairs() {
    let problem = ring(20_000, 0.3);
    let verdict = decide(&problem, 20_000);
    let Outcome::Infeasible(proof) = verdict else { panic!("a stiff arm stays in its gap: {verdict:?}") };
    let scene = problem.scene();
    assert_eq!(recheck(proof.collision_boxes(), scene, problem.start(), problem.goals(), 0.0), Ok(()));
    assert!(!proof.collision_boxes().is_empty());
    for stuck in proof.collision_boxes() {
        let pose = scene.arm().pose(stuck.pair.link, stuck.cell.center());
        assert!(shapes_meet(&scene.part(stuck.pair).at(&pose), scene.piece(stuck.pair)), "{stuck:?}");
    }
}

/// Checks a slot that is slightly narrower than the arm. A proof that it is closed takes tens of thousands of boxes.
/// Slabs show that it is closed, so the search continues beyond the budget for unclear cases.
#[test]
fn infeasibility_found_by_slabs_is_proven() {
    let problem = shipped::world("slot_closed").motion();
    let first = solve(&problem, &Options { boxes: 10_000, ..Method::First.into() }, &mut |_| {});
    for proof in [decide(&problem, 20_000).infeasible(), first.outcome.infeasible()] {
        let proof = proof.expect("it is closed");
        assert!(proof.collision_boxes().len() < 1000, "{}", proof.collision_boxes().len());
        assert_eq!(recheck(proof.collision_boxes(), problem.scene(), problem.start(), problem.goals(), 0.0), Ok(()));
    }
}

/// Checks a slot that is exactly as wide as the arm. Only contact closes it, which no box can prove, so the search ends
/// with its budget.
#[test]
fn exceeded_budgets_leave_the_answer_unknown() {
    let shipped = shipped::world("slot_closed");
    let place = tempfile::tempdir().unwrap();
    let world = place.path().join("touched.toml");
    std::fs::write(&world, std::fs::read_to_string(shipped.world).unwrap().replace("0.03995", "0.04")).unwrap();
    let problem = input::load(&shipped.robot, &world, &Overrides::default()).unwrap().problem;
    for allowed in [5_000, 20_000] {
        let Outcome::Unknown(reason) = decide(&problem, allowed) else {
            panic!("{allowed} boxes were not enough to decide")
        };
        let boxes: usize = reason.split(' ').next().and_then(|word| word.parse().ok()).expect(&reason);
        // All boxes are halved together, so the number may exceed the budget by the last round.
        assert!(boxes <= 2 * allowed + 100, "{reason}");
    }
}
