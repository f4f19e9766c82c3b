//! Goals of the tip that leave a joint free, compared with goals at many values of that joint.

use cplan::engine::{Method, solve};
use cplan::geometry::{Point, Vector};
use cplan::model::{Arm, JointType, MotionProblem, Scene, inverse};
use cplan::proofs::{Connectivity, MotionQuery, connectivity, least_length, slab_connectivity};
use cplan::space::{Configuration, GoalSet, JointRange, Metric, Segment};
use cplan::{Options, Outcome};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::arms::{arm, joint, link};
use cplan_testkit::problems::{motion_problem, recheck};
use cplan_testkit::scenes::{anywhere, discs_and_walls, scene};
use cplan_testkit::shapes::{rectangle, wall};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of values of the free joint for which the test plans one by one.
const TRIED: usize = 13;

/// If an answer took at most this many levels, its path must be within 5 % of the shortest. At later levels the path
/// may be longer.
const LOOKED_AT: usize = 2;

/// Draws an arm whose tip goal leaves a joint free, and the target of the tip.
fn drawn(dice: &mut Dice) -> (Arm, Point) {
    let turn = |dice: &mut Dice| JointType::Revolute { sign: if dice.below(3) == 0 { -1.0 } else { 1.0 } };
    let slide = |angle: f64| JointType::Prismatic { direction: Vector::new(angle.cos(), angle.sin()) };
    let turns = |dice: &mut Dice| match dice.below(3) {
        0 => JointRange::Circle,
        1 => JointRange::Interval { lower: -dice.within(1.5, 3.3), upper: dice.within(1.5, 3.3) },
        _ => JointRange::Interval { lower: -4.0, upper: 4.5 },
    };
    let stroke = |dice: &mut Dice| JointRange::Interval { lower: -dice.within(0.3, 1.0), upper: dice.within(0.3, 1.0) };
    let links = |length: f64| {
        [
            link("first", vec![rectangle(0.0, length, -0.03, 0.03)]),
            link("second", vec![rectangle(-0.05, 0.7, -0.03, 0.03)]),
        ]
    };
    match dice.below(5) {
        // The tip is on the axis of a revolute joint 2.
        0 | 1 => {
            let joints = [joint("a", turn(dice), turns(dice)), joint("b", turn(dice), turns(dice))];
            let arm = arm(joints, links(1.0), Vector::new(1.0, 0.0), Point::zeros());
            let angle = dice.within(-1.4, 1.4);
            (arm, Point::new(angle.cos(), angle.sin()))
        }
        2 => {
            let joints = [joint("a", slide(FRAC_PI_2), stroke(dice)), joint("b", turn(dice), turns(dice))];
            let arm = arm(joints, links(0.4), Vector::new(0.4, 0.0), Point::zeros());
            (arm, Point::new(0.4, dice.within(-0.3, 0.3)))
        }
        // The goal is on the axis of joint 1: an arm folded back, and one drawn in.
        3 => {
            let joints = [
                joint("a", turn(dice), turns(dice)),
                joint("b", turn(dice), JointRange::Interval { lower: -3.3, upper: 3.3 }),
            ];
            (arm(joints, links(0.7), Vector::new(0.7, 0.0), Point::new(0.7, 0.0)), Point::zeros())
        }
        _ => {
            let joints = [joint("a", turn(dice), turns(dice)), joint("b", slide(0.0), stroke(dice))];
            (arm(joints, links(0.3), Vector::new(-0.2, 0.0), Point::new(0.2, 0.0)), Point::zeros())
        }
    }
}

/// Returns a random world with a free start and the tip's goals. `None` if no start is free, or all goals are blocked.
fn world(seed: u64) -> Option<MotionProblem> {
    let mut dice = Dice::new(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
    let (arm, tip) = drawn(&mut dice);
    let count = 2 + dice.below(6);
    let pieces = discs_and_walls(&mut dice, count, [0.25, 1.6]);
    let scene: Scene = scene(arm, pieces);
    let start = (0..50).map(|_| anywhere(&mut dice, scene.arm())).find(|&q| scene.clearance(q) > 1e-3)?;
    let solved = inverse(scene.arm(), tip, start);
    assert!(solved.free.is_some(), "the generator's goals leave a joint free");
    let mut goals = solved.solutions(scene.arm());
    goals.retain(|goals| scene.blocked_along(goals).is_none());
    let goals: GoalSet = goals.into_iter().collect();
    (!goals.is_empty()).then(|| motion_problem(scene, start, goals))
}

/// Returns free goals at several values of the free joint.
fn goals_with_free_joint(problem: &MotionProblem) -> Vec<Configuration> {
    let along = |goals: &Segment| (0..TRIED).map(|k| goals.at((k as f64 + 0.5) / TRIED as f64)).collect::<Vec<_>>();
    let mut tried: Vec<Configuration> = problem.goals().pieces().iter().flat_map(along).collect();
    tried.retain(|&goal| problem.scene().clearance(goal) > 1e-6);
    tried
}

#[test]
fn a_set_of_goals_is_reached_if_any_of_it_is() {
    let (mut worlds, mut infeasible, mut slid) = (0, 0, 0);
    for seed in seeds(40) {
        let Some(problem) = world(seed) else { continue };
        worlds += 1;
        let (scene, start) = (problem.scene(), problem.start());
        let topology = scene.arm().topology();
        let each: Vec<_> = goals_with_free_joint(&problem)
            .into_iter()
            .map(|goal| {
                let goals = goal.into();
                (goal, slab_connectivity(scene, start, &goals, 0.0, 4_000, 200_000))
            })
            .collect();
        let connected: Vec<Configuration> = each
            .iter()
            .filter(|(_, answer)| matches!(answer, Connectivity::Connected(_)))
            .map(|(goal, _)| *goal)
            .collect();
        let whole = slab_connectivity(scene, start, problem.goals(), 0.0, 4_000, 200_000);
        let boxes = connectivity(scene, start, problem.goals(), 0.0, 20_000);
        for answer in [&whole, &boxes] {
            match answer {
                Connectivity::Disconnected(proof) => {
                    assert!(connected.is_empty(), "seed {seed}: a false proof, {connected:?} can be reached");
                    assert_eq!(
                        recheck(proof.collision_boxes(), scene, start, problem.goals(), 0.0),
                        Ok(()),
                        "seed {seed}"
                    );
                    infeasible += 1;
                }
                Connectivity::Connected(channel) => {
                    let end = channel.path().goal();
                    assert!(problem.goals().contains(&topology, end, 1e-9), "seed {seed}: {end} is no goal");
                }
                Connectivity::Undecided { .. } => assert!(connected.is_empty(), "seed {seed}: undecided"),
            }
        }
        // A proof for one value holds for the set only if nothing of the set can be reached.
        for (goal, answer) in &each {
            if let (Connectivity::Disconnected(proof), false) = (answer, connected.is_empty()) {
                let whole = recheck(proof.collision_boxes(), scene, start, problem.goals(), 0.0);
                assert!(whole.is_err(), "seed {seed}: a proof about {goal} is taken for one about all goals");
            }
        }
        let answer = solve(&problem, &Method::Visibility.into(), &mut |_| {});
        match &answer.outcome {
            Outcome::Found(path) => {
                let end = path.path().goal();
                assert!(problem.goals().contains(&topology, end, 1e-9), "seed {seed}: {end} is no goal");
                slid += u64::from(problem.goals().pieces().iter().any(|goals| !goals.is_point()));
                let bound = answer.bound().expect("visibility bounds what it finds");
                for &goal in &connected {
                    let single = motion_problem(problem.scene().clone(), problem.start(), goal);
                    let other = solve(&single, &Method::Visibility.into(), &mut |_| {});
                    let Outcome::Found(path) = &other.outcome else { continue };
                    let length = path.path().length();
                    assert!(
                        bound.lower <= length * (1.0 + 1e-9),
                        "seed {seed}: {} above {length} to {goal}",
                        bound.lower
                    );
                    let metric = Metric::Euclidean;
                    let motions = MotionQuery { scene, start, goals: problem.goals(), clearance: 0.0, metric };
                    let least = least_length(&motions, length, 1e-3, &[]);
                    assert!(least <= length, "seed {seed}");
                    // The planner looks for a shorter path that only the finest levels show in two cases: it has found
                    // no other path, or a gap is requested.
                    let most = if other.history.len() <= LOOKED_AT { 1.05 * length } else { f64::INFINITY };
                    assert!(bound.upper <= most, "seed {seed}: {} beside {length} to {goal}", bound.upper);
                }
            }
            Outcome::Infeasible(_) => assert!(connected.is_empty(), "seed {seed}: a false proof"),
            Outcome::Unknown(reason) => assert!(connected.is_empty(), "seed {seed}: {reason}"),
        }
    }
    assert!(
        !uses_default_cases() || worlds >= 20 && slid > worlds / 4,
        "{worlds} worlds, {slid} with paths, {infeasible} proofs"
    );
}

/// Checks a folded arm whose tip must return to the base. The path to the left passes an obstacle at a distance of a
/// millimetre. The polygons of the first level close it, so that only a path all around remains, of length 5.89. The
/// bound (0.89) shows that a shorter path may exist, so the planner tries a finer level.
#[test]
fn a_short_narrow_passage_is_preferred_to_a_long_detour() {
    let problem = world(9_083_322_546_425_692_186).expect("a world");
    let answer = solve(&problem, &Method::Visibility.into(), &mut |_| {});
    let bound = answer.bound().expect("visibility bounds what it finds");
    assert!(bound.gap() < 0.05, "{bound:?}");
    assert!(0.85 < bound.lower && bound.upper < 0.95, "{bound:?}");
    // With the first level alone there is only the long path. Its bound shows that.
    let hasty = solve(&problem, &Options { levels: 1, ..Method::Visibility.into() }, &mut |_| {});
    let bound = hasty.bound().expect("visibility bounds what it finds");
    assert!(bound.lower < 0.95 && bound.upper > 5.0, "{bound:?}");
}

/// Checks that no planner reports a problem as infeasible that has a path.
#[test]
fn planners_agree_about_sets_of_goals() {
    for seed in seeds(15).map(|seed| seed + 1_000) {
        let Some(problem) = world(seed) else { continue };
        let verdicts = Method::ALL.map(|method| {
            let verdict = solve(&problem, &method.into(), &mut |_| {}).outcome;
            if let Outcome::Found(path) = &verdict {
                let end = path.path().goal();
                let topology = problem.scene().arm().topology();
                assert!(problem.goals().contains(&topology, end, 1e-9), "seed {seed}, {method}: {end} is no goal");
            }
            verdict
        });
        let found = verdicts.iter().any(|verdict| matches!(verdict, Outcome::Found(_)));
        let infeasible = verdicts.iter().any(|verdict| matches!(verdict, Outcome::Infeasible(_)));
        assert!(!(found && infeasible), "seed {seed}");
    }
}

/// Checks a tip on the common axis of both joints, and one beside it. In the first case every configuration is a goal;
/// in the second, every pair of angles with a certain sum.
#[test]
fn joints_about_one_axis_share_the_angle() {
    let turning = |lower, upper| joint("t", JointType::Revolute { sign: 1.0 }, JointRange::Interval { lower, upper });
    let links = || {
        [link("first", vec![rectangle(0.0, 0.3, -0.03, 0.03)]), link("second", vec![rectangle(0.0, 0.7, -0.03, 0.03)])]
    };
    let coaxial = |tip| arm([turning(-2.0, 2.0), turning(-2.5, 2.5)], links(), Vector::zeros(), tip);
    let blocks = vec![wall(Point::new(0.2, 0.05), Point::new(0.25, 0.05))];
    let scene = scene(coaxial(Point::new(0.7, 0.0)), blocks);
    let start = Configuration::new(-0.5, -1.0);
    let problem = |angle: f64| {
        let target = Point::new(0.7 * angle.cos(), 0.7 * angle.sin());
        let goals: GoalSet = inverse(scene.arm(), target, start).solutions(scene.arm()).into_iter().collect();
        for goals in goals.pieces() {
            for k in 0..=10 {
                let q = goals.at(f64::from(k) / 10.0);
                assert!((scene.arm().tip_at(q) - target).norm() < 1e-9, "{q}");
            }
        }
        motion_problem(scene.clone(), start, goals)
    };
    // The sum is 1.5. The sum 1.5 - tau is beyond both limits, and the obstacle is in between.
    let barred = problem(1.5);
    assert_eq!(barred.goals().pieces().len(), 1, "{:?}", barred.goals());
    // Of the sums 1.9 and 1.9 - tau, one can be reached in the other direction.
    let open = problem(1.9);
    assert_eq!(open.goals().pieces().len(), 2, "{:?}", open.goals());
    for method in Method::ALL {
        let Outcome::Infeasible(proof) = solve(&barred, &method.into(), &mut |_| {}).outcome else {
            panic!("{method}: link 2 has to pass the obstacle")
        };
        assert_eq!(recheck(proof.collision_boxes(), &scene, start, barred.goals(), 0.0), Ok(()), "{method}");
        let Outcome::Found(path) = solve(&open, &method.into(), &mut |_| {}).outcome else {
            panic!("{method}: the other way round is free")
        };
        let end = path.path().goal();
        assert!((end[0] + end[1] - (1.9 - TAU)).abs() < 1e-9, "{method}: {end}");
    }
    let anywhere = inverse(&coaxial(Point::zeros()), Point::zeros(), start).solutions(&coaxial(Point::zeros()));
    assert_eq!(anywhere, [Segment::point(start)]);
}
