//! Motors of the elbow on the base: their limits against brute force, and limits that are described for joints and for motors.

use cplan::engine::{Criterion, Method, Planner, Problem, plan, solve};
use cplan::model::{Arm, MotionProblem, Motors, Scene};
use cplan::space::{Configuration, GoalSet, JointRange};
use cplan::{Options, Outcome};
use cplan_cases::dice::Dice;
use cplan_testkit::oracle::Oracle;
use cplan_testkit::problems::motion_problem;
use cplan_testkit::scenes::placed;
use cplan_testkit::world::world;
use std::collections::BinaryHeap;
use std::path::Path;

/// Returns a random world in which the range of the elbow's motor is little wider than start and goals need.
fn limited_world(seed: u64) -> Option<MotionProblem> {
    let free = world("RR", seed)?;
    let mut dice = Dice::new(seed ^ 0x5eed);
    let ratio = [1.0, -1.0, 0.5, 2.0][dice.below(4) as usize];
    let sum = |q: Configuration| ratio * q[0] + q[1];
    let ends = || free.goals().pieces().iter().flat_map(|piece| piece.ends()).chain([free.start()]);
    let least = ends().map(sum).fold(f64::INFINITY, f64::min) - dice.within(0.01, 0.2);
    let greatest = ends().map(sum).fold(f64::NEG_INFINITY, f64::max) + dice.within(0.01, 0.2);
    let mut arm: Arm = free.scene().arm().clone();
    for (k, joint) in arm.joints.iter_mut().enumerate() {
        let [low, high] = [f64::min, f64::max].map(|pick| ends().map(|q| q[k]).fold(ends().next().unwrap()[k], pick));
        joint.range = JointRange::Interval { lower: low - dice.within(0.1, 1.5), upper: high + dice.within(0.1, 1.5) };
    }
    arm.motors = Some(Motors { range: Some([least, greatest]), ..Motors::with_ratio(ratio) });
    let scene = placed(arm, free.scene().workspace().clone());
    let goals: GoalSet = free.goals().pieces().iter().copied().collect();
    Some(motion_problem(scene, free.start(), goals))
}

/// Nodes of the lattice along each axis.
const NODES: usize = 72;

/// Length of an edge that is checked by a sample in its middle, as a share of its room.
const ROOM: f64 = 0.004;

/// Returns the length of the shortest path over a lattice of free configurations from the start to a goal, in a norm; `None`
/// if the lattice shows no path. Collisions, kinematics and sums are the oracle's and this function's own.
fn lattice_length(problem: &MotionProblem, norm: &dyn Fn(Configuration) -> f64) -> Option<f64> {
    let (oracle, motors) = (Oracle::new(problem.scene()), problem.scene().arm().motors.unwrap());
    let [least, greatest] = motors.range.unwrap();
    let allowed = |q: Configuration| {
        let sum = motors.ratio * q[0] + q[1];
        least <= sum && sum <= greatest
    };
    let axes = oracle.axes.map(|(lower, upper, _)| [lower, upper]);
    let at = |node: usize| {
        let share = |index: usize| index as f64 / (NODES - 1) as f64;
        let index = [node / NODES, node % NODES];
        Configuration::from_fn(|k, _| axes[k][0] + (axes[k][1] - axes[k][0]) * share(index[k]))
    };
    let is_open = |q: Configuration| allowed(q) && oracle.room(q) > ROOM;
    let open: Vec<bool> = (0..NODES * NODES).map(|node| is_open(at(node))).collect();
    // An edge is as long as the room at its ends and in two places between allows.
    let is_edge = |a: Configuration, b: Configuration| {
        let speed = oracle.speed(b - a) / 3.0;
        (0..=3).all(|k| {
            let q = a + (b - a) * (f64::from(k) / 3.0);
            allowed(q) && oracle.room(q) > 0.5 * speed
        })
    };
    let near = |q: Configuration| {
        let reach =
            1.5 * [0, 1].map(|k| (axes[k][1] - axes[k][0]) / (NODES - 1) as f64).into_iter().fold(0.0, f64::max);
        let nodes = (0..NODES * NODES).filter(|node| open[*node] && (at(*node) - q).norm() <= reach);
        nodes.filter(|node| is_edge(q, at(*node))).map(|node| (node, norm(at(node) - q))).collect::<Vec<_>>()
    };
    let goals = problem.goals().pieces().iter().flat_map(|piece| near(piece.ends()[0]));
    let mut last = vec![f64::INFINITY; NODES * NODES];
    goals.for_each(|(node, length)| last[node] = length.min(last[node]));
    let mut known = vec![f64::INFINITY; NODES * NODES];
    // Lengths are positive, so their bits are in their order.
    let mut waiting: BinaryHeap<_> =
        near(problem.start()).into_iter().map(|(node, length)| (std::cmp::Reverse(length.to_bits()), node)).collect();
    let mut best: Option<f64> = None;
    while let Some((std::cmp::Reverse(bits), node)) = waiting.pop() {
        let length = f64::from_bits(bits);
        if length >= known[node] {
            continue;
        }
        known[node] = length;
        if last[node].is_finite() {
            best = Some(best.map_or(length + last[node], |best| best.min(length + last[node])));
        }
        let [i, j] = [node / NODES, node % NODES];
        for (a, b) in (i.saturating_sub(1)..=(i + 1).min(NODES - 1))
            .flat_map(|a| (j.saturating_sub(1)..=(j + 1).min(NODES - 1)).map(move |b| (a, b)))
        {
            let next = a * NODES + b;
            if next != node && open[next] && known[next].is_infinite() && is_edge(at(node), at(next)) {
                waiting.push((std::cmp::Reverse((length + norm(at(next) - at(node))).to_bits()), next));
            }
        }
    }
    best
}

/// Returns the length of the path without a range of the motor, if there is one.
fn unlimited_length(problem: &MotionProblem) -> Option<f64> {
    let mut wide = problem.clone();
    wide.arm_mut().motors = None;
    let answer = solve(&wide, &Method::Shortest.into(), &mut |_| {});
    Some(answer.outcome.found()?.bound?.upper)
}

/// Every path stays within the limits of the motor and of all joints, no bound exceeds the length of a path of the lattice,
/// and nothing is called infeasible that the lattice can do.
#[test]
fn answers_agree_with_a_lattice_of_samples() {
    let (mut found, mut infeasible, mut limited, mut counted) = (0, 0, 0, 0);
    for seed in cplan_cases::seeds(30) {
        let Some(problem) = limited_world(seed) else { continue };
        let length = lattice_length(&problem, &|d| d[0].hypot(d[1]));
        let motors = problem.scene().arm().motors.unwrap();
        let [least, greatest] = motors.range.unwrap();
        let unlimited = unlimited_length(&problem);
        match solve(&problem, &Method::Shortest.into(), &mut |_| {}).outcome {
            Outcome::Found(path) => {
                let waypoints = path.path().waypoints();
                let sums = || waypoints.iter().map(|q| motors.ratio * q[0] + q[1]);
                assert!(sums().all(|sum| least - 1e-9 <= sum && sum <= greatest + 1e-9), "{seed}: {waypoints:?}");
                let room = path.certified.clearance().min(1e9) - problem.scene().workspace().clearance - 1e-9;
                let violation = Oracle::new(problem.scene()).violation(path.path(), room, 1e-3);
                assert_eq!(violation, None, "{seed}");
                let bound = path.bound.expect("a bound");
                assert!(length.is_none_or(|length| bound.lower <= length), "{seed}: {bound:?} {length:?}");
                limited += usize::from(unlimited.is_some_and(|length| length < bound.lower));
                found += 1;
                counted += usize::from(bounds_count_the_motors(seed, problem));
            }
            Outcome::Infeasible(_) => {
                limited += usize::from(unlimited.is_some());
                assert_eq!(length, None, "{seed}: the lattice shows a path");
                infeasible += 1;
            }
            Outcome::Unknown(unknown) => assert_eq!(length, None, "{seed}: {}", unknown.reason),
        }
    }
    let are_usual = cplan_cases::uses_default_cases();
    assert!(!are_usual || found >= 10 && infeasible >= 3 && limited >= 2, "{found} {infeasible} {limited}");
    assert!(!are_usual || counted >= 5, "{counted}");
}

/// With a slow motor, the bounds of both metrics that count it are not above the length of the lattice's path in them, whose
/// norms are computed here. Returns true if the motor raises the bound on the time.
fn bounds_count_the_motors(seed: u64, mut problem: MotionProblem) -> bool {
    let motors = problem.scene().arm().motors.unwrap();
    let speeds = problem.scene().arm().joints.each_ref().map(|joint| joint.velocity);
    let bound = |problem: &MotionProblem, criterion: Criterion| {
        let planner = Planner::named(Method::Shortest).with_criterion(criterion);
        solve(problem, &planner.into(), &mut |_| {}).outcome.found().map(|path| path.bound.expect("a bound"))
    };
    let without = bound(&problem, Criterion::Time);
    let slow = 0.4 * (motors.ratio.abs() * speeds[0] + speeds[1]);
    problem.arm_mut().motors = Some(Motors { velocity: Some(slow), ..motors });
    let sum = |d: Configuration| motors.ratio * d[0] + d[1];
    let in_time = |d: Configuration| (d[0].abs() / speeds[0]).max(d[1].abs() / speeds[1]).max(sum(d).abs() / slow);
    let in_motor_angles = |d: Configuration| d[0].hypot(sum(d));
    let norms: [(Criterion, &dyn Fn(Configuration) -> f64); 2] =
        [(Criterion::Time, &in_time), (Criterion::Motor, &in_motor_angles)];
    for (criterion, norm) in norms {
        let (Some(bound), Some(length)) = (bound(&problem, criterion), lattice_length(&problem, norm)) else {
            continue;
        };
        assert!(bound.lower <= length, "{seed}, {criterion:?}: {bound:?} {length}");
        assert!(bound.upper <= 1.001 * length, "{seed}, {criterion:?}: {bound:?} {length}");
    }
    let raised = bound(&problem, Criterion::Time);
    raised.zip(without).is_some_and(|(raised, without)| raised.lower > 1.01 * without.upper)
}

/// Returns the result of a world on the shelf's arm with a `[robot]` table.
fn result(robot: &str, clearance: f64) -> serde_json::Value {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let world = std::fs::read_to_string(root.join("workspaces/shelf.toml")).unwrap();
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("world.toml");
    let world = world.replace("[start]", &format!("[robot]\n{robot}\n[start]"));
    std::fs::write(&file, format!("clearance = {clearance}\n{}", world.replace("clearance", "#clearance"))).unwrap();
    let problem = Problem::load(root.join("robots/planar_2r.urdf"), &file).unwrap();
    let plan = plan(&problem, &Options::default()).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(&plan.to_json()).unwrap();
    value["trajectory"].as_object_mut().map(|trajectory| trajectory.remove("motors"));
    value
}

/// Limits of motors that each turn one joint, through gears, equal the same limits of the joints.
#[test]
fn limits_of_direct_motors_are_limits_of_joints() {
    let (mut dice, mut found) = (Dice::new(7), 0);
    for _ in 0..6 {
        let gear = [[2.0, 0.5, -4.0][dice.below(3) as usize], [1.0, -0.5, 8.0][dice.below(3) as usize]];
        let lower = [dice.within(-2.8, -1.5), dice.within(-2.8, -1.2)];
        let upper = [dice.within(1.8, 2.8), dice.within(1.0, 2.8)];
        let (speed, gain) =
            ([dice.within(0.3, 1.0), dice.within(0.3, 1.0)], [dice.within(1.0, 4.0), dice.within(1.0, 4.0)]);
        let clearance = dice.within(0.0, 0.01);
        let joints = format!(
            "limits = {{ shoulder = [{}, {}], elbow = [{}, {}] }}\nvelocity = {{ shoulder = {}, elbow = {} }}\n\
             acceleration = {{ shoulder = {}, elbow = {} }}",
            lower[0], upper[0], lower[1], upper[1], speed[0], speed[1], gain[0], gain[1]
        );
        let end = |k: usize, is_lower: bool| gear[k] * if is_lower == (gear[k] > 0.0) { lower[k] } else { upper[k] };
        let [low, high] = [true, false].map(|is_lower| [0, 1].map(|k| end(k, is_lower)));
        let [fast, gain] = [speed, gain].map(|limit| [0, 1].map(|k| limit[k] * gear[k].abs()));
        let motors = format!(
            "drives = {{ elbow = \"link\", gear = {gear:?}, motors = {{ lower = {low:?}, upper = {high:?}, velocity = {fast:?}, \
             acceleration = {gain:?} }} }}",
        );
        let value = result(&joints, clearance);
        found += usize::from(value["status"] == "found");
        assert_eq!(value, result(&motors, clearance), "{motors}");
    }
    assert!(found >= 3, "{found}");
}

/// Motions respect the speed and the acceleration of a motor on the base, and use them.
#[test]
fn motions_use_the_limits_of_a_motor_on_the_base() {
    for (ratio, velocity, acceleration) in [(1.0, 0.9, 5.0), (-0.5, 0.6, 30.0), (2.0, 1.2, 3.0)] {
        let robot = format!(
            "drives = {{ ratio = {ratio:?}, motors = {{ velocity = [9.0, {velocity:?}], acceleration = [90.0, {acceleration:?}] }} }}"
        );
        let value = result(&robot, 0.01);
        let sums = |name: &str| -> Vec<f64> {
            let rows = value["trajectory"][name].as_array().unwrap().iter();
            rows.map(|row| ratio * row[0].as_f64().unwrap() + row[1].as_f64().unwrap()).collect()
        };
        let greatest = |name: &str| sums(name).into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(greatest("velocity") <= velocity * (1.0 + 1e-9), "{robot}: {}", greatest("velocity"));
        assert!(greatest("acceleration") <= acceleration * (1.0 + 1e-9), "{robot}: {}", greatest("acceleration"));
        assert!(greatest("velocity") >= 0.9 * velocity || greatest("acceleration") >= 0.9 * acceleration, "{robot}");
    }
}

/// A model whose motor limits the sum of two continuous joints is refused.
#[test]
fn ranges_of_sums_need_limits_of_both_joints() {
    let mut arm = Arm::rr([1.0, 0.8], 0.06).unwrap();
    arm.motors = Some(Motors { range: Some([-1.0, 1.0]), ..Motors::with_ratio(1.0) });
    let error = Scene::new(arm, cplan::model::Workspace::new([])).unwrap_err().to_string();
    assert!(error.contains("not both joints have limits"), "{error}");
}
