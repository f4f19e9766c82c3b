//! Motions that stay free within errors of the robot and its world, replayed by random robots within them.

use cplan::Outcome;
use cplan::engine::{Method, solve};
use cplan::geometry::{Pose, Vector};
use cplan::model::{Arm, Calibration, MotionProblem, Scene, Workspace};
use cplan::space::{Configuration, Path};
use cplan_cases::dice::Dice;
use cplan_testkit::oracle::Oracle;
use cplan_testkit::scenes::placed;
use cplan_testkit::world::{KINDS, world};

/// Share of an arm's reach that errors of lengths have at most.
const LARGEST_ERROR: f64 = 0.01;

/// Robots that replay each motion.
const ROBOTS: u64 = 12;

/// Distance, metres, within which some of the robots must pass: what covers the errors is not far too large.
const NEAR: f64 = 0.01;

/// Allowance for rounding, metres.
const ROUNDING: f64 = 1e-9;

fn errors(dice: &mut Dice, reach: f64) -> (Calibration, f64) {
    let length = |dice: &mut Dice| if dice.chance(0.6) { dice.within(0.0, LARGEST_ERROR * reach) } else { 0.0 };
    let angle = |dice: &mut Dice| if dice.chance(0.6) { dice.within(0.0, LARGEST_ERROR) } else { 0.0 };
    let calibration = Calibration {
        base_shift: length(dice),
        base_turn: angle(dice),
        links: 0.3 * length(dice),
        zero_turn: angle(dice),
        zero_slide: length(dice),
    };
    (calibration, length(dice))
}

/// Returns a random problem, and the same one for all robots and obstacles within errors. `None` if an end is not free.
fn problem_within(kind: &str, seed: u64) -> Option<(MotionProblem, MotionProblem, Calibration, f64)> {
    let drawn = world(kind, seed)?;
    let (calibration, displacement) = errors(&mut Dice::new(seed ^ 0xca11), drawn.scene().arm().reach());
    let scene = displaced(drawn.scene(), displacement).within_errors(&calibration);
    let within = MotionProblem::new(scene, drawn.start(), drawn.goals().clone()).ok()?;
    Some((drawn, within, calibration, displacement))
}

/// Returns the scene whose obstacles may be displaced.
fn displaced(scene: &Scene, by: f64) -> Scene {
    let (arm, mut workspace) = scene.clone().into_parts();
    let clearance = workspace.clearance;
    for obstacle in &mut workspace.obstacles {
        obstacle.growth.error = by;
        obstacle.grow(clearance);
    }
    placed(arm, workspace)
}

/// Draws a number whose greatest values are as probable as all others together.
fn extreme(dice: &mut Dice, most: f64) -> f64 {
    let sign = if dice.chance(0.5) { 1.0 } else { -1.0 };
    sign * most * if dice.chance(0.5) { 1.0 } else { dice.within(0.0, 1.0) }
}

fn any_direction(dice: &mut Dice, most: f64) -> Vector {
    let (sine, cosine) = dice.within(0.0, std::f64::consts::TAU).sin_cos();
    Vector::new(cosine, sine) * extreme(dice, most)
}

/// Draws a robot and a world within the errors, and the offsets of its joints.
fn robot_within(dice: &mut Dice, drawn: &Scene, errors: &Calibration, displacement: f64) -> (Oracle, Configuration) {
    let (mut arm, mut workspace): (Arm, Workspace) = drawn.clone().into_parts();
    for obstacle in &mut workspace.obstacles {
        *obstacle = obstacle.at(&Pose::translation(any_direction(dice, displacement)));
    }
    // A rotation about joint 1, and a displacement.
    let (base, turn) = (arm.base, Pose::rotation(extreme(dice, errors.base_turn)));
    arm = arm.placed(&turn.shifted(base - turn.point(base) + any_direction(dice, errors.base_shift)));
    arm.offset += any_direction(dice, errors.links);
    for link in &mut arm.links {
        let stretch = any_direction(dice, errors.links);
        for part in &mut link.parts {
            part.shape = part.shape.at(&Pose::translation(stretch));
        }
    }
    let zeros = arm.joints.each_ref().map(|joint| match joint.joint_type.is_revolute() {
        true => extreme(dice, errors.zero_turn),
        false => extreme(dice, errors.zero_slide),
    });
    (Oracle::new(&placed(arm, workspace)), zeros.into())
}

/// Every motion that is called free within the errors is free for each of many robots.
#[test]
fn motions_are_free_for_every_robot_within_the_errors() {
    let (mut found, mut near) = (0, 0);
    for (kind, seed) in KINDS.iter().flat_map(|kind| cplan_cases::seeds(40).map(move |seed| (kind, seed))) {
        let Some((drawn, within, errors, displacement)) = problem_within(kind, seed) else { continue };
        let Outcome::Found(answer) = solve(&within, &Method::Shortest.into(), &mut |_| {}).outcome else { continue };
        let mut dice = Dice::new(seed ^ 0x0b07);
        for _ in 0..ROBOTS {
            let (oracle, zeros) = robot_within(&mut dice, drawn.scene(), &errors, displacement);
            let waypoints: Vec<_> = answer.certified.path().waypoints().iter().map(|q| *q + zeros).collect();
            let found_at = oracle.violation(&Path::new(waypoints.clone()), -ROUNDING, 1e-3);
            assert!(found_at.is_none(), "{kind} {seed}: {errors:?}, obstacles {displacement}: {found_at:?}");
            near += usize::from(oracle.violation(&Path::new(waypoints), NEAR, 1e-3).is_some());
        }
        found += 1;
    }
    assert!(found > 30 && near > found / 2, "{found} motions, {near} of their robots pass close by");
}

/// A displacement of the base alone is the same as a clearance: both have the same answer.
#[test]
fn a_displacement_of_the_base_is_a_clearance() {
    let (mut found, mut infeasible) = (0, 0);
    for (kind, seed) in KINDS.iter().flat_map(|kind| cplan_cases::seeds(120).map(move |seed| (kind, seed))) {
        let Some(drawn) = world(kind, seed) else { continue };
        let (scene, clearance) = (drawn.scene(), drawn.scene().workspace().clearance);
        let size = Dice::new(seed).within(0.0, 0.1 * scene.arm().reach());
        let calibration = Calibration { base_shift: size, ..Calibration::default() };
        let wider = scene.clone().with_clearance(clearance + size).unwrap();
        let problem = |scene: Scene| MotionProblem::new(scene, drawn.start(), drawn.goals().clone()).ok();
        let (Some(within), Some(apart)) = (problem(scene.within_errors(&calibration)), problem(wider)) else {
            continue;
        };
        let answers = [within, apart].map(|problem| solve(&problem, &Method::Shortest.into(), &mut |_| {}).outcome);
        match answers {
            [Outcome::Found(a), Outcome::Found(b)] => {
                let lengths = [a, b].map(|answer| answer.certified.path().length());
                assert!((lengths[0] - lengths[1]).abs() <= 1e-3 * lengths[1], "{kind} {seed}: {lengths:?}");
                found += 1;
            }
            [Outcome::Infeasible(_), Outcome::Infeasible(_)] => infeasible += 1,
            [a, b] => panic!("{kind} {seed}, {size}: {:?} and {:?}", a.status(), b.status()),
        }
    }
    assert!(found > 50 && infeasible > 0, "{found} found, {infeasible} infeasible");
}

/// A problem that is infeasible within errors is infeasible with the displacements alone, since only these are exact.
#[test]
fn proofs_use_displacements_alone() {
    let mut proven = 0;
    for (kind, seed) in KINDS.iter().flat_map(|kind| cplan_cases::seeds(40).map(move |seed| (kind, seed))) {
        let Some((drawn, within, errors, displacement)) = problem_within(kind, seed) else { continue };
        let Outcome::Infeasible(_) = solve(&within, &Method::Shortest.into(), &mut |_| {}).outcome else { continue };
        let size = errors.base_shift + displacement;
        let clearance = drawn.scene().workspace().clearance;
        let apart = drawn.scene().clone().with_clearance(clearance + size).unwrap();
        let Ok(apart) = MotionProblem::new(apart, drawn.start(), drawn.goals().clone()) else { continue };
        let outcome = solve(&apart, &Method::Shortest.into(), &mut |_| {}).outcome;
        assert!(outcome.infeasible().is_some(), "{kind} {seed}: {errors:?}, {displacement}: {:?}", outcome.status());
        proven += 1;
    }
    assert!(proven > 3, "only {proven} proofs");
}

/// An obstacle's own clearance is kept from it, and from it alone.
#[test]
fn the_clearance_of_an_obstacle_is_its_own() {
    let mut tight = 0;
    for (kind, seed) in KINDS.iter().flat_map(|kind| cplan_cases::seeds(120).map(move |seed| (kind, seed))) {
        let Some(drawn) = world(kind, seed) else { continue };
        let (arm, mut workspace) = drawn.scene().clone().into_parts();
        let (own, clearance) = (Dice::new(seed).within(0.0, 0.15), workspace.clearance);
        let Some(first) = workspace.obstacles.first_mut() else { continue };
        first.growth.clearance = own;
        first.grow(clearance);
        let scene = placed(arm, workspace);
        let Ok(problem) = MotionProblem::new(scene, drawn.start(), drawn.goals().clone()) else { continue };
        let Outcome::Found(answer) = solve(&problem, &Method::Shortest.into(), &mut |_| {}).outcome else { continue };
        let alone = |keep: &dyn Fn(usize) -> bool, clearance: f64| {
            let (arm, mut workspace) = drawn.scene().clone().into_parts();
            let kept = std::mem::take(&mut workspace.obstacles).into_iter().enumerate().filter(|(k, _)| keep(*k));
            workspace.obstacles = kept.map(|(_, obstacle)| obstacle).collect();
            workspace.clearance = clearance;
            Oracle::new(&placed(arm, workspace))
        };
        let path = answer.certified.path();
        let required = own.max(clearance);
        let first = alone(&|k| k == 0, required);
        assert!(first.violation(path, -ROUNDING, 1e-3).is_none(), "{kind} {seed}: nearer than {required}");
        assert!(alone(&|k| k > 0, clearance).violation(path, -ROUNDING, 1e-3).is_none(), "{kind} {seed}");
        tight += usize::from(own > clearance && first.violation(path, 1e-3, 1e-3).is_some());
    }
    assert!(tight > 3, "{tight} paths pass close to their first obstacle");
}
