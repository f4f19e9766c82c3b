//! Replays of planners: they show truly how a planner found its answer.

use cplan::engine::{Method, Phase, Replay, Setting, Shows, SlabBoxes};
use cplan::planner::{GridSearch, PathKind, Trace};
use cplan::space::Configuration;
use cplan::{Options, Plan, Planner};
use cplan_testkit::problems::shipped_feasible;
use cplan_testkit::shipped;

fn plan_shipped(robot: &str, world: &str, planner: impl Into<Options>) -> Plan {
    shipped::plan(robot, world, &planner.into())
}

fn replayed(plan: &Plan) -> Vec<Phase> {
    let Replay { phases } = plan.replay().unwrap();
    assert_eq!(plan.replay().unwrap().phases, phases, "told twice it is the same");
    for Phase { caption, events, .. } in &phases {
        assert!(!caption.is_empty() && !caption.contains('\n') && caption.len() < 100, "{caption:?}");
        assert!(*events > 0, "{caption}");
    }
    phases
}

/// Returns how many items of the trace a phase shows. Returns `None` if the trace has no items for it.
fn shown_count(shows: &Shows, trace: &Trace) -> Option<usize> {
    Some(match (shows, trace) {
        (Shows::Nodes | Shows::Edges, Trace::Roadmap { edges, .. } | Trace::Roads { edges, .. }) => edges.len(),
        (Shows::Expanded, Trace::Roads { expanded, .. } | Trace::Channel { expanded, .. }) => expanded.len(),
        (Shows::Cells { .. }, Trace::Channel { cells, .. }) => cells.len(),
        (Shows::Channel, Trace::Channel { channel, .. }) => channel.len(),
        (Shows::Slices, Trace::Slices { free }) => free.len(),
        (Shows::Boxes, Trace::Boxes { free, stuck, mixed }) => free.len() + stuck.len() + mixed.len(),
        (Shows::Wave, Trace::Wavefront { labels, .. }) => labels.iter().filter(|&&label| label != u32::MAX).count(),
        (Shows::Levels, Trace::Field { values, .. }) => values.iter().filter(|value| value.is_finite()).count(),
        _ => return None,
    })
}

#[test]
fn every_planner_has_a_replay() {
    for method in Method::ALL {
        let plan = plan_shipped("planar_2r", "workbench", method);
        let ((_, answer), phases) = (plan.motion().unwrap(), replayed(&plan));
        let Some(path) = answer.path() else { panic!("{method} finds it") };
        assert_eq!(phases.last().unwrap().shows, Shows::Path, "{method}");
        assert!(phases.len() > 1, "{method} saw something before");
        for Phase { shows, events, caption, .. } in &phases {
            match shows {
                Shows::Path => assert_eq!(*events, path.waypoints().len()),
                Shows::Own(own) => {
                    assert_eq!(answer.path_kind, PathKind::Taut);
                    assert!(own.length() >= path.length() - 1e-9, "{method} pulls its path taut");
                }
                Shows::Slabs(_) | Shows::Sweeps(_) | Shows::First(_) | Shows::Bound { .. } => {}
                _ => assert_eq!(shown_count(shows, &answer.drawn()), Some(*events), "{method}: {caption}"),
            }
        }
        let has_own = phases.iter().any(|phase| matches!(phase.shows, Shows::Own(_)));
        assert_eq!(has_own, method.has_own_path() && method.path_kind() == PathKind::Taut, "{method}");
    }
}

#[test]
fn replays_follow_the_order_of_the_search() {
    for search in GridSearch::ALL {
        let planner = Planner::named(Method::Wavefront).with(Setting::GridSearch, |s| s.grid_search = search);
        let plan = plan_shipped("planar_2r", "shelf", planner);
        let Trace::Wavefront { cells, labels, expanded, forward: false, .. } = &plan.motion().unwrap().1.run.trace
        else {
            panic!("a wavefront")
        };
        assert_eq!(expanded.is_empty(), search == GridSearch::Wave);
        let [first, .., last] = &expanded[..] else { continue };
        assert_eq!(labels[*first as usize], 0, "{search} begins at the goal");
        // The cell of the start, computed from the arm's limits.
        let arm = plan.problem().scene().arm();
        let at = |k: usize| {
            let (lower, upper) = arm.topology().ranges[k].domain();
            ((plan.trajectory().unwrap().position[0][k] - lower) / (upper - lower) * cells[k] as f64) as usize
        };
        assert_eq!(*last as usize, at(0) * cells[1] + at(1), "{search} ends at the start");
        let phase = &replayed(&plan)[0];
        assert_eq!((&phase.shows, phase.events), (&Shows::Wave, expanded.len()), "{search}");
        let by_distance = expanded.is_sorted_by_key(|&cell| labels[cell as usize]);
        assert!(by_distance || !matches!(search, GridSearch::BreadthFirst | GridSearch::Dijkstra), "{search}");
    }
}

#[test]
fn boxes_of_slabs_have_true_states() {
    let mut seen = 0;
    for (name, problem) in shipped_feasible() {
        let options = Options::from(Method::First);
        let answer = cplan::engine::solve(&problem, &options, &mut |_| ());
        let Replay { phases } = Replay::new(&problem, &options, &answer);
        let Some(Phase { shows: Shows::Slabs(SlabBoxes { free, stuck, mixed }), events, .. }) = phases.first() else {
            continue;
        };
        assert_eq!(free.len() + stuck.len() + mixed.len(), *events, "{name}");
        let (scene, clearance) = (problem.scene(), problem.scene().workspace().clearance);
        let places = |[lower, upper]: &[Configuration; 2]| {
            let at = |a: f64, b: f64| {
                Configuration::new(lower[0] + a * (upper[0] - lower[0]), lower[1] + b * (upper[1] - lower[1]))
            };
            [at(0.5, 0.5), at(0.1, 0.2), at(0.9, 0.7)]
        };
        for place in free.iter().flat_map(places) {
            assert!(scene.clearance(place) >= clearance, "{name}: {place:?} is free");
        }
        for place in stuck.iter().flat_map(places) {
            let is_allowed = scene.arm().topology().contains(place);
            assert!(scene.clearance(place) <= clearance || !is_allowed, "{name}: {place:?} is stuck");
        }
        seen += free.len() + stuck.len();
    }
    assert!(seen > 100, "{seen} boxes");
}

/// Checks the phases in which the length is enclosed: the first path is certified again, and the bounds never fall and never
/// exceed the length of a path. Without walls, the bound is the straight line.
#[test]
fn the_length_is_enclosed_from_both_sides() {
    let mut rounds_seen = 0;
    for (robot, world) in [("planar_2r", "shelf"), ("planar_2r", "workbench"), ("scara", "scara_cell")] {
        let plan = plan_shipped(robot, world, Method::Shortest);
        let (problem, answer) = plan.motion().unwrap();
        let (phases, bound) = (replayed(&plan), answer.bound().unwrap());
        let [.., first, Phase { shows: Shows::Bound { rounds, .. }, .. }, _, last] = &phases[..] else {
            panic!("{phases:?}")
        };
        let Shows::First(path) = &first.shows else { panic!("{first:?}") };
        assert!(cplan::check::certify(problem.scene(), path.clone()).is_ok(), "{world}");
        assert_eq!((first.length, last.length), (Some(path.length()), Some(bound.upper)), "{world}");
        assert!(path.length() >= bound.upper - 1e-9, "{world}");
        let lower: Vec<f64> = rounds.iter().map(|round| round.lower).collect();
        assert!(lower.is_sorted() && lower[lower.len() - 1] == bound.lower && bound.lower <= bound.upper, "{world}");
        let ends = answer.path().unwrap().waypoints();
        let straight = (ends[ends.len() - 1] - ends[0]).norm();
        assert!(lower[0] <= straight && rounds[0].slices.is_empty(), "{world}: {} {straight}", lower[0]);
        assert!(rounds.iter().all(|round| round.path.is_empty() || round.path[0] == problem.start()), "{world}");
        assert!(rounds[1..].windows(2).all(|pair| pair[0].slices.len() <= pair[1].slices.len()), "{world}");
        rounds_seen += rounds.len();
    }
    assert!(rounds_seen > 8, "{rounds_seen}");
}

#[test]
fn a_proof_is_replayed_box_by_box() {
    let plan = plan_shipped("planar_2r_continuous", "no_path", Method::Shortest);
    let proof = plan.motion().unwrap().1.outcome.infeasible().unwrap().collision_boxes().len();
    let last = replayed(&plan).pop().unwrap();
    assert_eq!((last.shows, last.events), (Shows::Proof, proof));
}

#[test]
fn a_field_is_replayed_sweep_by_sweep() {
    let relaxed = cplan::planner::FieldPlanner {
        field: cplan::planner::FieldChoice::Relaxed {
            equation: cplan::planner::EquationChoice::Harmonic,
            relaxation: cplan::field::Relaxation::JACOBI,
            measure: cplan::field::Measure::GreatestRelativeChange,
            tolerance: 1e-3,
            max_sweeps: 2000,
            on: cplan::field::Device::Cpu,
            stencil: cplan::field::Stencil::Square,
            initial: cplan::field::Initial::High,
        },
        limits: cplan::field::Limits::High,
        escape: None,
        path: PathKind::Own,
    };
    let planner = Planner::named(Method::Harmonic).with_cells(32).with(Setting::Field, |s| s.field = Some(relaxed));
    let plan = plan_shipped("planar_2r", "shelf", planner);
    let phases = replayed(&plan);
    let Some(Phase { shows: Shows::Sweeps(sweeps), .. }) = phases.first() else { panic!("{phases:?}") };
    let total = plan.motion().unwrap().1.run.size.figures()[1].1;
    assert!(sweeps.frames.is_sorted_by(|a, b| a.0 < b.0) && sweeps.frames.last().unwrap().0 == total);
    let reached = |values: &[f64]| values.iter().filter(|value| value.is_finite()).count();
    assert!(sweeps.frames.is_sorted_by_key(|(_, values)| reached(values)), "a sweep takes nothing back");
    assert!(reached(&sweeps.frames[0].1) < reached(&sweeps.frames.last().unwrap().1));
    assert!(sweeps.frames.iter().all(|(_, values)| values.len() == sweeps.cells[0] * sweeps.cells[1]));
}
