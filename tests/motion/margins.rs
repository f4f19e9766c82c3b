//! Margins of motions, compared with dense samples by an oracle with its own kinematics and distances.

use cplan::engine::plan;
use cplan::geometry::{Pose, Vector};
use cplan::model::{Arm, Grip, MotionProblem, Scene, Workspace};
use cplan::motion::{BodyKind, ErrorKind, Margins, Trajectory};
use cplan::space::{Configuration, Path};
use cplan::{Options, Plan, Problem};
use cplan_testkit::judged::{Question, judge};
use cplan_testkit::moving::state_between;
use cplan_testkit::oracle::Oracle;
use cplan_testkit::problems::shipped_feasible;
use cplan_testkit::solid::Solid;
use cplan_testkit::{shipped, world};
use serde_json::Value;
use std::f64::consts::TAU;

/// Allowance for rounding, as a share of a margin.
const ROUNDING: f64 = 1e-9;

/// Share of the true margins that the proven ones must reach in the median.
const MEDIAN: f64 = 0.9;

/// Returns configurations on a trajectory, at this many places of each interval between samples.
fn on_trajectory(trajectory: &Trajectory, places: u32) -> Vec<(f64, Configuration)> {
    let between = |k: usize| {
        let duration = trajectory.time[k + 1] - trajectory.time[k];
        let at = move |i: u32| duration * f64::from(i) / f64::from(places);
        (0..places).map(move |i| (trajectory.time[k] + at(i), state_between(trajectory, k, at(i))[0]))
    };
    let end = (trajectory.duration(), trajectory.position[trajectory.position.len() - 1].into());
    (0..trajectory.time.len() - 1).flat_map(between).chain([end]).collect()
}

/// Returns configurations on a path, at this many places of each segment.
fn on_path(path: &Path, places: u32) -> Vec<Configuration> {
    let between = |(from, to): (Configuration, Configuration)| {
        (0..=places).map(move |i| from + (to - from) * (f64::from(i) / f64::from(places)))
    };
    path.segments().flat_map(between).collect()
}

/// Returns the oracle for the arm and the obstacles of a scene, without clearance, after a change.
fn oracle(scene: &Scene, change: impl FnOnce(&mut Arm, &mut Workspace)) -> Oracle {
    let (mut arm, mut workspace) = (scene.arm().clone(), scene.workspace().clone());
    workspace.clearance = 0.0;
    change(&mut arm, &mut workspace);
    Oracle::new(&Scene::new(arm, workspace).unwrap())
}

/// Returns the least room on a motion.
fn least(oracle: &Oracle, motion: &[Configuration]) -> f64 {
    motion.iter().map(|q| oracle.room(*q)).fold(f64::INFINITY, f64::min)
}

/// Returns the plan of a problem without the robot's own body as an obstacle. `None` if there is no motion.
fn planned(problem: &MotionProblem) -> Option<Plan> {
    let (mut arm, workspace) = problem.scene().clone().into_parts();
    arm.self_obstacles.clear();
    let problem = Problem::new(arm, workspace, problem.start(), problem.goals().clone()).unwrap();
    Some(plan(&problem, &Options::default()).unwrap()).filter(|plan| plan.trajectory().is_some())
}

/// Returns shipped and random problems, with the names of their worlds.
fn problems() -> Vec<(String, MotionProblem)> {
    let random = world::KINDS.iter().flat_map(|kind| {
        cplan_cases::seeds(4).filter_map(move |seed| Some((format!("{kind} {seed}"), world::world(kind, seed)?)))
    });
    shipped_feasible().into_iter().chain(random).collect()
}

fn assert_median(mut ratios: Vec<f64>, least_count: usize) {
    assert!(ratios.len() >= least_count, "only {} margins", ratios.len());
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] >= MEDIAN, "the median is {}", ratios[ratios.len() / 2]);
}

#[test]
fn margins_of_bodies_are_proven_and_tight() {
    let mut ratios = Vec::new();
    for (name, problem) in problems() {
        let Some(plan) = planned(&problem) else { continue };
        let scene = plan.problem().scene();
        let mut motion: Vec<_> = on_trajectory(plan.trajectory().unwrap(), 4).into_iter().map(|(_, q)| q).collect();
        let path = plan.motion().unwrap().1.outcome.found().unwrap().path.path();
        motion.extend(on_path(path, 50));
        let margins = plan.margins();
        let obstacles = scene.workspace().obstacles.len();
        for (k, body) in margins.bodies.iter().enumerate() {
            let truth = oracle(scene, |arm, workspace| match body.kind {
                BodyKind::Link => {
                    arm.links.iter_mut().for_each(|link| link.parts.retain(|part| part.body == body.name));
                }
                _ => workspace.obstacles = vec![workspace.obstacles[k].clone()],
            });
            assert_eq!(body.kind == BodyKind::Link, k >= obstacles, "{name}: {}", body.name);
            let (seen, margin) = (least(&truth, &motion), body.margin.map(|margin| margin.size));
            let proven = margin.unwrap_or(f64::INFINITY);
            assert!(proven <= seen * (1.0 + ROUNDING), "{name}: {} keeps {seen}, not {proven}", body.name);
            ratios.extend(margin.map(|margin| margin / seen));
        }
    }
    assert_median(ratios, 200);
}

/// Returns errors of a kind with this size, as oracles and changes of the configuration.
fn wrong(scene: &Scene, kind: ErrorKind, size: f64) -> Vec<(Oracle, Configuration)> {
    let still = Configuration::zeros();
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let moved = |pose: Pose| {
        let away = |_: &mut Arm, workspace: &mut Workspace| {
            workspace.obstacles.iter_mut().for_each(|obstacle| *obstacle = obstacle.at(&pose));
        };
        (oracle(scene, away), still)
    };
    match kind {
        ErrorKind::BasePosition => (0..12)
            .map(|k| Vector::new((f64::from(k) * TAU / 12.0).cos(), (f64::from(k) * TAU / 12.0).sin()))
            .map(|direction| moved(Pose::translation(direction * size)))
            .collect(),
        ErrorKind::BaseAngle => [size, -size].map(|angle| moved(Pose::rotation(angle))).into(),
        ErrorKind::LinkLengths => signs
            .map(|signs| {
                let longer = |arm: &mut Arm, _: &mut Workspace| {
                    let lengthwise = |v: Vector, sign: f64| v.try_normalize(0.0).unwrap_or_default() * (sign * size);
                    let along = lengthwise(arm.tip, signs[1]);
                    if arm.joints[1].joint_type.is_revolute() {
                        arm.offset += lengthwise(arm.offset, signs[0]);
                    }
                    for part in &mut arm.links[1].parts {
                        part.shape = part.shape.mapped(|corner| corner + along, part.shape.radius());
                    }
                };
                (oracle(scene, longer), still)
            })
            .into(),
        ErrorKind::TurningZeros | ErrorKind::SlidingZeros => {
            let errors = kind.errors(scene.arm(), size).zeros;
            signs.map(|signs| (oracle(scene, |_, _| ()), [signs[0] * errors[0], signs[1] * errors[1]].into())).into()
        }
    }
}

/// With each error of the stated size, the motion stays free. With a somewhat larger error, it touches at the stated place.
#[test]
fn tolerances_are_proven_and_tight() {
    let (mut tight, mut all) = (0, 0);
    for (name, problem) in problems() {
        let Some(plan) = planned(&problem) else { continue };
        let scene = plan.problem().scene();
        let motion = on_trajectory(plan.trajectory().unwrap(), 1);
        for tolerance in &plan.margins().tolerances {
            let Some(margin) = tolerance.margin else { continue };
            for (truth, off) in wrong(scene, tolerance.of, margin.size) {
                for (_, q) in &motion {
                    let room = truth.room(*q + off);
                    assert!(room > -1e-12, "{name}: {:?} of {} touches at {q}", tolerance.of, margin.size);
                }
            }
            let mut larger = wrong(scene, tolerance.of, margin.size / MEDIAN).into_iter();
            tight += usize::from(larger.any(|(truth, off)| truth.room(margin.at + off) <= 0.0));
            all += 1;
        }
    }
    assert!(all > 100 && 2 * tight > all, "{tight} of {all} are tight");
}

fn shipped(robot: &str, world: &str) -> Plan {
    let plan = shipped::plan(robot, world, &Options::default());
    assert!(plan.trajectory().is_some(), "{world} has no motion");
    plan
}

fn margin_of(margins: &Margins, name: &str) -> f64 {
    margins.bodies.iter().find(|body| body.name == name).unwrap().margin.map_or(f64::INFINITY, |margin| margin.size)
}

/// Returns the position of the tip of an arm with two revolute joints.
fn tip(arm: &Arm, q: Configuration) -> Vector {
    let turned = |v: Vector, angle: f64| {
        Vector::new(v.x * angle.cos() - v.y * angle.sin(), v.x * angle.sin() + v.y * angle.cos())
    };
    let [first, second] = [0, 1].map(|k| arm.joints[k].joint_type.turn() * q[k]);
    arm.base + turned(arm.offset, first) + turned(arm.tip, first + second)
}

/// Returns the least distance of a level payload from an obstacle that it can meet, over some configurations.
fn least_of_payload(scene: &Scene, number: usize, motion: &[Configuration]) -> f64 {
    let Some(attachment) = scene.attachment() else { return f64::INFINITY };
    let Grip::Level { angle, point } = attachment.grip else { panic!("the payload is not level") };
    let obstacle = scene.obstacle(number);
    if attachment.supports.contains(&number) || !attachment.heights.overlap(obstacle.heights) {
        return f64::INFINITY;
    }
    let turned = Pose::rotation(angle);
    let at = |q: &Configuration| turned.shifted(tip(scene.arm(), *q) - turned.point(point));
    let apart = |pose: Pose| {
        let pieces = attachment.pieces().map(move |piece| Solid::new(&piece.at(&pose)));
        let distances =
            pieces.flat_map(|piece| obstacle.pieces.iter().map(move |other| piece.distance(&Solid::new(other))));
        distances.fold(f64::INFINITY, f64::min)
    };
    motion.iter().map(|q| apart(at(q))).fold(f64::INFINITY, f64::min)
}

/// Objects are obstacles and payloads in turn. Strokes of the tool only reduce the margins.
#[test]
fn margins_of_tasks_hold_for_all_steps() {
    for (robot, world, is_tight) in [
        ("rrbot_vertical", "tasks/tower", true),
        ("scara", "tasks/feeder", true),
        ("scara", "tasks/kitting_cell", false),
        ("scara", "arch/into_the_box", false),
    ] {
        let plan = shipped(robot, world);
        let (task, answer) = plan.task().unwrap();
        let fixed = task.workspace.fixed.obstacles.len();
        let mut ratios = Vec::new();
        for number in 0..fixed + task.objects.len() {
            let (mut seen, mut name) = (f64::INFINITY, String::new());
            for leg in answer.legs.iter().take(12) {
                name.clone_from(&leg.scene.obstacle(number).name);
                let obstacle = leg.scene.obstacle(number).clone();
                let motion: Vec<_> = on_trajectory(&leg.timed.trajectory, 4).into_iter().map(|(_, q)| q).collect();
                if !obstacle.pieces.is_empty() {
                    seen = seen.min(least_of_payload(&leg.scene, number, &motion));
                }
                let (mut arm, mut workspace) = Scene::clone(&leg.scene).into_parts();
                arm.self_obstacles.clear();
                workspace.obstacles = vec![obstacle];
                if leg.scene.additions().allowed_contacts.contains(&number) {
                    arm.links[1].parts.clear();
                }
                seen = seen.min(least(&oracle(&Scene::new(arm, workspace).unwrap(), |_, _| ()), &motion));
            }
            let proven = margin_of(plan.margins(), &name);
            assert!(proven <= seen * (1.0 + ROUNDING), "{world}: {name} keeps {seen}, not {proven}");
            ratios.extend(seen.is_finite().then_some(proven / seen));
        }
        if is_tight {
            assert_median(ratios, 2);
        }
    }
}

#[test]
fn margins_of_moving_obstacles_hold_at_all_times() {
    for world in ["moving/crossing", "moving/gate", "moving/swing"] {
        let plan = plan(&shipped::world(world).problem(), &Options::default()).unwrap();
        let (timed, margins) = (plan.problem().timed(), plan.margins());
        for (k, loose) in timed.scene.loose_obstacles().iter().enumerate() {
            let static_obstacles = timed.scene.workspace().obstacles.len();
            let room = |(time, q): (f64, Configuration)| {
                let keep = |arm: &mut Arm, workspace: &mut Workspace| {
                    arm.self_obstacles.clear();
                    workspace.obstacles = vec![workspace.obstacles[static_obstacles + k].clone()];
                };
                oracle(&timed.frozen(time), keep).room(q)
            };
            let seen = on_trajectory(plan.trajectory().unwrap(), 2).into_iter().map(room).fold(f64::INFINITY, f64::min);
            let proven = margin_of(margins, &loose.obstacle.name);
            assert!(proven <= seen, "{world}: {} keeps {seen}, not {proven}", loose.obstacle.name);
            assert!(proven >= MEDIAN * seen, "{world}: {} keeps {seen}, only {proven} is proven", loose.obstacle.name);
        }
    }
}

/// Returns the findings about a recording of waypoints, which are joined by straight lines.
fn verified(world: &str, joints: [&str; 2], waypoints: &[[f64; 2]]) -> Value {
    let rows: String = waypoints.iter().map(|[a, b]| format!("{a},{b}\n")).collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("recorded.csv");
    std::fs::write(&file, format!("{},{}\n{rows}", joints[0], joints[1])).unwrap();
    judge(&shipped::world(world).robot, &shipped::world(world).world, &file, &Question::with_free_ends()).unwrap()
}

/// Recordings of any origin have margins like those of plans. Places on motions without times are waypoints.
#[test]
fn margins_of_recordings_are_proven_and_tight() {
    let mut ratios = Vec::new();
    for world in ["shelf", "workbench", "crowd", "scara_cell", "gantry_maze", "polar_gate"] {
        let shipped = shipped::world(world);
        let problem = shipped.motion();
        let scene = problem.scene();
        let path = plan(&shipped.problem(), &Options::default()).unwrap().waypoints().unwrap();
        let joints = scene.arm().joints.each_ref().map(|joint| joint.name.as_str());
        let found = verified(world, joints, &path);
        assert_eq!(found["verdict"], "free", "{world}: {found:#}");
        let waypoints = Path::new(path.iter().map(|q| Configuration::from(*q)).collect());
        let motion = on_path(&waypoints, 400);
        let obstacles = found["margins"].as_array().unwrap().iter().filter(|margin| margin["kind"] == "obstacle");
        for (k, margin) in obstacles.enumerate() {
            let truth = oracle(scene, |arm, workspace| {
                arm.self_obstacles.clear();
                workspace.obstacles = vec![workspace.obstacles[k].clone()];
            });
            let (seen, name) = (least(&truth, &motion), &scene.workspace().obstacles[k].name);
            assert_eq!(margin["body"], **name, "{world}");
            let Some(proven) = margin["clearance"].as_f64() else { continue };
            assert!(proven <= seen * (1.0 + ROUNDING), "{world}: {name} keeps {seen}, not {proven}");
            ratios.push(proven / seen);
            let at: Configuration = serde_json::from_value::<[f64; 2]>(margin["at"].clone()).unwrap().into();
            let waypoint = margin["waypoint"].as_f64().unwrap();
            let (from, share) = (waypoint.floor().min(path.len() as f64 - 2.0), waypoint.fract());
            let [from, to] = [0, 1].map(|next| Configuration::from(path[from as usize + next]));
            let share = if share == 0.0 && at == to { 1.0 } else { share };
            assert!((from + (to - from) * share - at).norm() < 1e-9, "{world}: {at} is not at waypoint {waypoint}");
        }
        let kinds = found["tolerances"].as_array().unwrap().len();
        assert_eq!(kinds, plan(&shipped.problem(), &Options::default()).unwrap().margins().tolerances.len(), "{world}");
    }
    assert_median(ratios, 50);
}

/// A recording that is not proven free has no margins.
#[test]
fn colliding_recordings_have_no_margins() {
    let joints = ["shoulder", "elbow"];
    let found = verified("shelf", joints, &[[-0.9, 0.4], [1.55, -0.35]]);
    assert_eq!((&found["verdict"], &found["margins"]), (&Value::from("collision"), &Value::Null));
}
