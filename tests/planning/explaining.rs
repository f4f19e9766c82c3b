//! Explanations of infeasible problems. Sets of blockers are compared with planning in worlds that the test builds from
//! them. Changes are compared with closed forms and with a flood fill.
//!
//! `CPLAN_WORLDS` is the number of random infeasible worlds of each kind of arm; the long run prints times:
//!
//! ```sh
//! CPLAN_WORLDS=250 cargo test --profile quick --test planning explaining -- --nocapture
//! ```

use cplan::engine::explain::{BlockingSet, ChangeKind, Element, MotionQuestion, Side, blocking_set, explain};
use cplan::engine::{Method, Planner, decide, solve};
use cplan::geometry::{Convex, Point};
use cplan::model::{JointType, MotionProblem, Obstacle, Outcome, Scene, Workspace};
use cplan::space::{Configuration, GoalSet, JointRange, Segment};
use cplan::{Options, Status, engine};
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::arms;
use cplan_testkit::scenes::placed;
use cplan_testkit::shapes::rectangle;
use cplan_testkit::world::{KINDS, world};
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

/// Number of boxes for each decision.
const BOXES: usize = 20_000;

/// Number of boxes with which `explain` decides the cases that it would otherwise leave unknown.
const BOXES_AT_LAST: usize = 1_000_000;

/// A range of values that exceeds the needs of all slides in the random worlds, in metres.
const FAR: f64 = 20.0;

/// Returns the problem with only those blocking elements that are in `there`. The test builds it independently.
fn problem_with(problem: &MotionProblem, there: &[Element]) -> MotionProblem {
    let (mut arm, mut workspace) = problem.scene().clone().into_parts();
    let mut number = 0;
    workspace.obstacles.retain(|_| {
        number += 1;
        there.contains(&Element::Obstacle { number: number - 1 })
    });
    if !there.contains(&Element::Clearance) {
        workspace.clearance = 0.0;
    }
    // Two nearly parallel slides need long motions to pass an obstacle. Two slides on one line never leave it.
    let between = match arm.joints.each_ref().map(|joint| joint.joint_type) {
        [JointType::Prismatic { direction: a }, JointType::Prismatic { direction: b }] => a.angle(&b).sin(),
        _ => 1.0,
    };
    let between = if between < 1e-3 { 1.0 } else { between };
    for (k, joint) in arm.joints.iter_mut().enumerate() {
        let far = if joint.joint_type.is_revolute() { TAU } else { FAR / between };
        if let JointRange::Interval { lower, upper } = &mut joint.range {
            if !there.contains(&Element::Limit { joint: k, side: Side::Lower }) {
                *lower -= far;
            }
            if !there.contains(&Element::Limit { joint: k, side: Side::Upper }) {
                *upper += far;
            }
        }
    }
    // Requires a clearance of a micrometre, or a millionth of the reach for small arms. If start or goal has less,
    // requires none.
    let asked = |clearance: f64| {
        let workspace = Workspace { clearance: workspace.clearance.max(clearance), ..workspace.clone() };
        let scene = Scene::new(arm.clone(), workspace).expect("less of what is valid");
        MotionProblem::new(scene, problem.start(), problem.goals().clone())
    };
    asked(1e-6 * problem.scene().arm().reach().min(1.0)).unwrap_or_else(|_| asked(0.0).expect("ends stay free"))
}

/// Returns descriptions of what is wrong with a blocking set.
fn faults(problem: &MotionProblem, set: &BlockingSet) -> Vec<String> {
    let mut faults = Vec::new();
    let elements = set.elements();
    let truth = decide(&problem_with(problem, &elements), Options::default().boxes).status();
    if truth != Status::Infeasible {
        faults.push(format!("{elements:?} are not known to be enough: {truth}"));
    }
    for element in &elements {
        let others: Vec<Element> = elements.iter().filter(|other| *other != element).copied().collect();
        let known = set.without(*element);
        let truth = engine::solve(&problem_with(problem, &others), &Options::default(), &mut |_| ()).outcome.status();
        if truth != Status::Found && (known == Status::Found || truth == Status::Infeasible) {
            faults.push(format!("{element:?} is not needed of {elements:?}: {truth}"));
        }
    }
    faults
}

#[test]
fn blocking_sets_are_irreducible() {
    let wanted = std::env::var("CPLAN_WORLDS").ok().and_then(|n| n.parse::<usize>().ok()).unwrap_or(3);
    let (mut times, mut sizes, mut wrong) = (Vec::<Duration>::new(), Vec::new(), Vec::new());
    let mut unknown = Vec::new();
    for kind in KINDS {
        let mut seen = 0;
        for seed in seeds(1).start.. {
            let Some(problem) = world(kind, seed) else { continue };
            let Outcome::Infeasible(proof) = decide(&problem, BOXES) else { continue };
            let clock = Instant::now();
            let set = blocking_set(&MotionQuestion::from(&problem), Some(proof), [BOXES, BOXES_AT_LAST]);
            times.push(clock.elapsed());
            sizes.push(set.blockers.len());
            if !set.is_irreducible() {
                let left: Vec<Element> =
                    set.elements().into_iter().filter(|&element| set.without(element) == Status::Unknown).collect();
                unknown.push(format!("{kind} {seed}: {left:?} of {}", set.blockers.len()));
            }
            wrong.extend(faults(&problem, &set).into_iter().map(|fault| format!("{kind} {seed}: {fault}")));
            seen += 1;
            if seen == wanted {
                break;
            }
        }
    }
    times.sort();
    sizes.sort_unstable();
    let count = times.len();
    println!(
        "{count} worlds: median {:.2?}, 95 % {:.2?}, longest {:.2?}; blockers: median {}, most {}; {} not shown irreducible: {unknown:?}",
        times[count / 2],
        times[count * 95 / 100],
        times[count - 1],
        sizes[count / 2],
        sizes[count - 1],
        unknown.len()
    );
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(unknown.len() * 20 <= count, "of {count} are not shown to be irreducible: {unknown:#?}");
}

/// Checks nearly parallel slides, and walls and points without area. Without any clearance, such a wall neither lets
/// the arm pass nor proves that it cannot pass.
#[test]
fn blocking_sets_of_degenerate_worlds_are_irreducible() {
    let long_ways = [722, 931, 1095, 1154, 1393, 1580].map(|seed| ("PP", seed));
    let thin = [("RR", 39), ("RR", 253), ("RP", 615), ("PP", 862), ("PR", 28), ("PR", 684), ("PR", 874)];
    for (kind, seed) in long_ways.into_iter().chain(thin) {
        let problem = world(kind, seed).expect("a world");
        let Outcome::Infeasible(proof) = decide(&problem, BOXES) else { panic!("{kind} {seed} has a motion") };
        let set = blocking_set(&MotionQuestion::from(&problem), Some(proof), [BOXES, BOXES_AT_LAST]);
        assert!(set.is_irreducible(), "{kind} {seed}: {:?}", set.elements());
        assert_eq!(faults(&problem, &set), Vec::<String>::new(), "{kind} {seed}");
    }
}

/// Half the side of the block that the gantry carries, in metres.
const HALF: f64 = 0.1;

/// Returns a question about a square block that slides along x and y, within 1 m of the origin, from the left to the
/// right.
fn gantry(obstacles: Vec<Obstacle>, clearance: f64) -> MotionQuestion {
    let arm = arms::gantry([-1.0, 1.0], vec![rectangle(-HALF, HALF, -HALF, HALF)]);
    let scene = placed(arm, Workspace { clearance, ..Workspace::new(obstacles) });
    MotionQuestion::new(scene, Configuration::new(-0.8, 0.0), GoalSet::from(Configuration::new(0.8, 0.0)))
}

fn bar(name: &str, lower: f64, upper: f64) -> Obstacle {
    Obstacle::polygon(name, [[-0.05, lower], [0.05, lower], [0.05, upper], [-0.05, upper]]).expect("a rectangle")
}

/// Returns a wall with a gap of this width. The slides end before the outer ends of the wall.
fn wall(gap: f64) -> Vec<Obstacle> {
    vec![bar("above", gap / 2.0, 3.0), bar("below", -3.0, -gap / 2.0)]
}

/// Checks changes with closed forms. A gap is too narrow by 0.03 m. Either half of the wall is moved or made smaller by
/// 0.03 m, or both by half of that.
#[test]
fn the_missing_width_of_a_gap_is_reported() {
    let lacking = 0.03;
    let explanation = explain(&gantry(wall(2.0 * HALF - lacking), 0.0), &Options::default());
    let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{}", explanation.status()) };
    assert_eq!(closed.blocking(explanation.question.scene()), ["above", "below"]);
    assert_eq!(closed.sets.len(), 1);
    let of_obstacles = || closed.changes().filter(|change| change.element.obstacle().is_some());
    for change in of_obstacles() {
        assert!(change.by.closed <= lacking && lacking < change.by.opens, "{change:?}");
        assert!(change.by.opens - change.by.closed <= 1e-3, "{change:?}");
        if let ChangeKind::Moved { direction: [x, y] } = change.cure {
            let outwards = if change.element == (Element::Obstacle { number: 0 }) { 1.0 } else { -1.0 };
            assert!(x.abs() < 1e-9 && (y - outwards).abs() < 1e-9, "{change:?}");
        }
    }
    assert_eq!(of_obstacles().count(), 4, "{:?}", closed.sets);
    let stuck = closed.bottleneck.as_ref().expect("a narrow place");
    assert!(stuck.by.closed <= lacking / 2.0 && lacking / 2.0 < stuck.by.opens, "{stuck:?}");
    assert!((stuck.missing_distance(0.0) - lacking).abs() < 1e-9, "{stuck:?}");
    assert!(stuck.at[1].abs() < lacking && stuck.at[0].abs() < HALF + 0.06, "{stuck:?}");
}

/// Checks a gap that is too narrow only because of the required clearance of 0.05 m on either side.
#[test]
fn clearance_is_lowered_to_half_the_gap() {
    let explanation = explain(&gantry(wall(2.0 * HALF + 0.06), 0.05), &Options::default());
    let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{}", explanation.status()) };
    let set = &closed.sets[0];
    assert!(set.elements().contains(&Element::Clearance), "{:?}", set.elements());
    let lowered =
        closed.changes().find(|change| change.cure == ChangeKind::Lowered).expect("the clearance opens a way");
    assert!(lowered.by.closed <= 0.02 && 0.02 <= lowered.by.opens, "{lowered:?}");
    assert!(lowered.by.opens - lowered.by.closed <= 1e-3, "{lowered:?}");
}

/// Checks a wall that leaves room only at its upper end, where the slide stops a hundredth of a metre too early.
#[test]
fn a_limit_is_widened_by_the_missing_range() {
    let end = 1.0 - HALF + 0.01;
    let explanation = explain(&gantry(vec![bar("wall", -3.0, end)], 0.0), &Options::default());
    let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{}", explanation.status()) };
    let [lower, upper] = [Side::Lower, Side::Upper].map(|side| Element::Limit { joint: 1, side });
    assert_eq!(closed.sets[0].elements(), [lower, upper, Element::Obstacle { number: 0 }]);
    let widened = closed.changes().find(|change| change.element == upper).expect("a change");
    assert!(widened.by.closed <= 0.01 && 0.01 < widened.by.opens && widened.by.opens < 0.0111, "{widened:?}");
}

/// Checks two walls, each of which closes the space. No single change opens a path through both, and the result lists
/// both.
#[test]
fn walls_behind_one_another_are_sets_of_their_own() {
    let behind = |obstacle: Obstacle, name: &str| {
        let cplan::model::Shape::Polygon(corners) = &obstacle.shape else { panic!("a bar") };
        Obstacle::polygon(name, corners.iter().map(|p| [p.x + 0.4, p.y])).expect("a rectangle")
    };
    let walls = vec![bar("first", -3.0, 3.0), behind(bar("second", -3.0, 3.0), "second")];
    let explanation = explain(&gantry(walls, 0.0), &Options::default());
    let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{}", explanation.status()) };
    assert_eq!(closed.sets.len(), 2);
    let all: Vec<Element> = closed.sets.iter().flat_map(BlockingSet::elements).collect();
    for number in [0, 1] {
        assert!(all.contains(&Element::Obstacle { number }), "{all:?}");
    }
}

/// Checks that a start in an obstacle is explained by that obstacle alone.
#[test]
fn a_blocked_start_names_the_obstacle_to_change() {
    let block = Obstacle::polygon("block", [[-0.75, -0.3], [-0.6, -0.3], [-0.6, 0.3], [-0.75, 0.3]]).expect("a block");
    let explanation = explain(&gantry(vec![bar("post", 0.5, 0.6), block], 0.0), &Options::default());
    let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{}", explanation.status()) };
    assert_eq!(closed.blocking(explanation.question.scene()), ["block"]);
    // The block's left side is at -0.75, and the arm's right side at -0.7, so 0.05 are missing.
    for change in closed.changes() {
        assert!(change.by.closed <= 0.05 && 0.05 < change.by.opens && change.by.opens < 0.0511, "{change:?}");
    }
    assert_eq!(closed.changes().count(), 2);
}

/// Checks a world with one bar. Without the bar, the path would be straight.
#[test]
fn obstacles_that_lengthen_the_path_are_reported_with_their_cost() {
    let (across, corner) = (0.15, [0.15_f64, 0.3]);
    let bars = vec![bar("high", 0.8, 0.9), bar("middle", -3.0, corner[1] - HALF)];
    let explanation = explain(&gantry(bars, 0.0), &Options::default());
    let Outcome::Found(shaped) = &explanation.outcome else { panic!("{}", explanation.status()) };
    let around = 2.0 * ((0.8_f64 - across).hypot(corner[1]) + across);
    let [saving] = &shaped.savings[..] else { panic!("{:?}", shaped.savings) };
    assert_eq!(saving.element, Element::Obstacle { number: 1 });
    let truth = around - 1.6;
    assert!(saving.at_least <= truth && truth <= saving.at_most, "{saving:?} {truth}");
    assert!(saving.at_most - saving.at_least < 1e-2 * truth, "{saving:?}");
}

/// Returns the same arm and world in another unit of length. The start and the goals are shifted by whole turns of
/// continuous joints.
fn scaled_problem(problem: &MotionProblem, scale: f64, turns: [f64; 2]) -> MotionProblem {
    let (mut arm, mut workspace) = problem.scene().clone().into_parts();
    let point = |p: Point| p * scale;
    let shape = |piece: &Convex| {
        Convex::new(piece.core().iter().map(|p| point(*p)).collect(), piece.radius() * scale).expect("a shape")
    };
    let slides = arm.joints.each_ref().map(|joint| !joint.joint_type.is_revolute());
    let range = |k: usize| arm.joints[k].range;
    let value = |k: usize, value: f64, by: f64| match range(k) {
        JointRange::Circle => value + by * TAU,
        JointRange::Interval { .. } if slides[k] => value * scale,
        JointRange::Interval { .. } => value,
    };
    let at = |q: Configuration, turns: [f64; 2]| Configuration::from_fn(|k, _| value(k, q[k], turns[k]));
    let start = at(problem.start(), turns);
    let goals: GoalSet =
        problem.goals().pieces().iter().map(|goal| Segment::point(at(goal.ends()[0], [0.0; 2]))).collect();
    for (joint, slides) in arm.joints.iter_mut().zip(slides) {
        if let (JointRange::Interval { lower, upper }, true) = (&mut joint.range, slides) {
            (*lower, *upper) = (*lower * scale, *upper * scale);
        }
    }
    (arm.base, arm.tip, arm.offset) = (point(arm.base), point(arm.tip), arm.offset * scale);
    arm.links.iter_mut().flat_map(|link| &mut link.parts).for_each(|part| part.shape = shape(&part.shape));
    for obstacle in &mut workspace.obstacles {
        obstacle.pieces = obstacle.pieces.iter().map(shape).collect();
        obstacle.shape = cplan::model::Shape::Pieces;
    }
    workspace.clearance *= scale;
    MotionProblem::new(Scene::new(arm, workspace).expect("a scene"), start, goals).expect("as free as before")
}

/// Checks arms of metres, millimetres and hundreds of metres, with starts up to twenty turns away. The reported lengths
/// without an element are those of another planner's paths in a world that the test builds without the element.
#[test]
fn reported_lengths_hold_for_another_planner() {
    let (by_graph, mut seen) = (Options { planner: Planner::named(Method::Visibility), ..Options::default() }, 0);
    let graph = |problem: &MotionProblem| match solve(problem, &by_graph, &mut |_| ()).outcome {
        Outcome::Found(path) => Some(path.path().length()),
        _ => None,
    };
    for seed in seeds(4) {
        for (kind, scale) in KINDS.into_iter().flat_map(|kind| [(kind, 1e-3), (kind, 1.0), (kind, 300.0)]) {
            let Some(drawn) = world(kind, seed) else { continue };
            let turns = [[0.0, 0.0], [3.0, -1.0], [-20.0, 7.0]][(seed % 3) as usize];
            let (mut arm, mut workspace) = drawn.scene().clone().into_parts();
            workspace.obstacles.truncate(4);
            arm.links.iter_mut().flat_map(|link| &mut link.parts).for_each(|part| part.inner = None);
            let few = Scene::new(arm, workspace).expect("fewer obstacles");
            let few = MotionProblem::new(few, drawn.start(), drawn.goals().clone()).expect("as free as before");
            let problem = scaled_problem(&few, scale, turns);
            let explanation = explain(&MotionQuestion::from(&problem), &Options::default());
            let Outcome::Found(shaped) = &explanation.outcome else { continue };
            let whole = shaped.answer.bound().expect("a bound");
            let name = format!("{kind} {seed} at {scale}");
            let slack = 1e-12 * whole.upper;
            if let Some(length) = graph(&problem) {
                assert!(whole.lower <= length + slack, "{name}: {whole:?}, another path of {length}");
            }
            for saving in &shaped.savings {
                let gone = |element: &Element| *element != saving.element;
                let there: Vec<Element> = Element::all(problem.scene()).into_iter().filter(gone).collect();
                let (mut arm, mut workspace) = problem_with(&problem, &there).into_scene().into_parts();
                // The smaller the arm, the farther an omitted limit extends. No clearance is added here.
                if scale != 1.0 && matches!(saving.element, Element::Limit { .. }) {
                    continue;
                }
                let keeps = problem.scene().workspace().clearance;
                workspace.clearance = if saving.element == Element::Clearance { 0.0 } else { keeps };
                arm.name = "without".into();
                let scene = Scene::new(arm, workspace).expect("less of what is valid");
                let without = MotionProblem::new(scene, problem.start(), problem.goals().clone()).expect("free");
                let Some(length) = graph(&without) else { continue };
                seen += 1;
                let least = whole.upper - saving.at_most;
                assert!(least <= length + slack, "{name}: not below {least} without {saving:?}, but {length}");
            }
        }
    }
    println!("{seen} lengths compared");
    assert!(!uses_default_cases() || seen > 2, "{seen}");
}

/// Checks an arm of a millimetre, for which a micrometre is large. A bound for paths with that clearance does not hold
/// for paths without it.
#[test]
fn lengths_without_an_obstacle_are_those_at_the_worlds_own_clearance() {
    let small = |obstacle: Obstacle| {
        let cplan::model::Shape::Polygon(corners) = &obstacle.shape else { panic!("a bar") };
        Obstacle::polygon(&obstacle.name, corners.iter().map(|p| [p.x * 1e-3, p.y * 1e-3])).expect("a rectangle")
    };
    let corner = [0.15_f64, 0.3];
    let bars = vec![small(bar("higher", -3.0, 0.5)), small(bar("lower", -3.0, corner[1] - HALF))];
    let (mut arm, workspace) = gantry(bars, 0.0).scene().clone().into_parts();
    for joint in &mut arm.joints {
        joint.range = JointRange::Interval { lower: -1e-3, upper: 1e-3 };
    }
    for part in arm.links.iter_mut().flat_map(|link| &mut link.parts) {
        let corners = part.shape.core().iter().map(|p| *p * 1e-3).collect();
        part.shape = Convex::new(corners, 0.0).expect("a square");
    }
    let scene = Scene::new(arm, workspace).expect("a scene");
    let goal = GoalSet::from(Configuration::new(0.8e-3, 0.0));
    let explanation = explain(&MotionQuestion::new(scene, Configuration::new(-0.8e-3, 0.0), goal), &Options::default());
    let Outcome::Found(shaped) = &explanation.outcome else { panic!("{}", explanation.status()) };
    let around = |height: f64| 2.0 * ((0.8_f64 - corner[0]).hypot(height) + corner[0]) * 1e-3;
    let [saving] = &shaped.savings[..] else { panic!("{:?}", shaped.savings) };
    let truth = around(0.5 + HALF) - around(corner[1]);
    assert!(saving.at_least <= truth && truth <= saving.at_most, "{saving:?} {truth}");
    assert!(saving.at_most - saving.at_least < 1e-2 * truth, "{saving:?}");
}

/// Checks that an explanation whose time is up has its known part: the problem is infeasible, with possible blockers.
#[test]
fn a_stopped_explanation_claims_no_irreducible_set() {
    let question = gantry(wall(2.0 * HALF - 0.03), 0.0).with_time_limit(Duration::from_nanos(1));
    let explanation = explain(&question, &Options::default());
    let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{}", explanation.status()) };
    assert!(explanation.is_stopped && closed.proof.is_some());
    let [set] = &closed.sets[..] else { panic!("{:?}", closed.sets) };
    assert!(!set.is_irreducible() && set.blockers.len() >= 2, "{set:?}");
    assert_eq!(closed.changes().count(), 0);
    let open = gantry(vec![bar("middle", -3.0, 0.2)], 0.0).with_time_limit(Duration::from_nanos(1));
    let explanation = explain(&open, &Options::default());
    let Outcome::Found(shaped) = &explanation.outcome else { panic!("{}", explanation.status()) };
    assert!(explanation.is_stopped && shaped.savings.is_empty());
}
