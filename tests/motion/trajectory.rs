//! From a certified path to files, and back through independent readers.

use cplan::check::{CertifiedPath, blend, certify};
use cplan::engine::{GridSpace, Method, Options, Plan, Planner, Problem, plan};
use cplan::geometry::{Point, Vector};
use cplan::model::{Arm, Joint, JointType, MotionProblem, Obstacle, RobotJoints, Scene, Status, Workspace};
use cplan::motion::{BlendReport, Format, JointMotion, Limits, TimedMotion, Trajectory, csv, ros_yaml, time};
use cplan::space::{Configuration, JointRange, Path};
use cplan_testkit::arms::{arm, joint, link};
use cplan_testkit::problems::shipped_feasible;
use cplan_testkit::scenes::placed;
use cplan_testkit::shapes::disc;
use serde_json::Value;

const NAMES: [&str; 2] = ["shoulder, \"left\"", "no: 1"];

/// Returns a revolute joint that carries nothing, followed by a prismatic one that carries a disc. With `obstacle`,
/// there is a distant obstacle.
fn scene(obstacle: bool) -> Scene {
    let joint = |name: &str, joint_type| Joint {
        velocity: 1.5,
        ..joint(name, joint_type, JointRange::Interval { lower: -3.0, upper: 3.0 })
    };
    let joints = [
        joint(NAMES[0], JointType::Revolute { sign: 1.0 }),
        joint(NAMES[1], JointType::Prismatic { direction: Vector::x() }),
    ];
    let links = [link("turret", vec![]), link("slider", vec![disc(Point::zeros(), 0.1)])];
    let far = Obstacle::circle("far", [9.0, 0.0], 0.5).expect("a disc");
    let obstacles = if obstacle { vec![far] } else { vec![] };
    let workspace = Workspace { name: "room".into(), ..Workspace::new(obstacles) };
    placed(arm(joints, links, Vector::zeros(), Point::zeros()), workspace)
}

fn certified(scene: &Scene, waypoints: &[[f64; 2]]) -> CertifiedPath {
    let path = Path::new(waypoints.iter().map(|&[a, b]| Configuration::new(a, b)).collect());
    certify(scene, path).expect("nothing is near")
}

fn driven(waypoints: &[[f64; 2]]) -> TimedMotion {
    let scene = scene(true);
    let path = certified(&scene, waypoints);
    let curve = blend(&scene, &path, f64::INFINITY, 0.0);
    time(curve, &Limits::from(&scene.arm().joints), 0.01).expect("an ordinary motion")
}

/// Plans from the first of [`WAYPOINTS`] to the last.
fn plan_waypoints(obstacle: bool) -> Plan {
    let [start, _, goal] = WAYPOINTS.map(Configuration::from);
    let problem = MotionProblem::new(scene(obstacle), start, goal).expect("both are free");
    plan(&problem.into(), &Options { timings: true, ..Method::Visibility.into() }).expect("an ordinary motion")
}

const WAYPOINTS: [[f64; 2]; 3] = [[-0.9, 0.4], [0.1, 1.7 + 1e-8], [1.55, 1.0 / 3.0]];

/// Asserts that the numbers in a JSON text are close to these. The reader of JSON prefers speed, so it may miss the
/// nearest double by one unit in the last place. The writer does not.
fn assert_close(json: &Value, rows: &[[f64; 2]]) {
    let json = json.as_array().expect("a list");
    assert_eq!(json.len(), rows.len());
    for (read, row) in json.iter().zip(rows) {
        for (i, value) in row.iter().enumerate() {
            let read = read[i].as_f64().expect("a number");
            assert!((read - value).abs() <= f64::EPSILON * value.abs(), "{read} {value}");
        }
    }
}

#[test]
fn json_holds_the_contract() {
    let plan = plan_waypoints(true);
    let text = plan.to_json();
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(json["status"], "found");
    assert_eq!(json["name"], "room");
    assert_eq!(json["planner"], "visibility");
    assert_eq!(json["joints"], serde_json::json!(NAMES));
    assert_eq!(json["units"], serde_json::json!(["rad", "m"]));
    let [start, _, goal] = WAYPOINTS;
    assert_close(&json["path"], &[start, goal]);
    assert_eq!(json["certified"], true);
    let clearance = json["clearance"].as_f64().expect("a number");
    assert!((6.0..8.5).contains(&clearance), "{clearance}");
    assert!(json["closest"].as_str().is_some_and(|closest| closest.contains("obstacle \"far\"")), "{json}");
    let gap = json["optimum"]["gap"].as_f64().expect("a number");
    assert!((0.0..1e-8).contains(&gap), "{gap}");
    assert!(json["size"]["nodes"].is_u64() && json["timings"]["build"].is_f64());
    let trajectory = plan.trajectory().expect("found");
    assert_close(&json["trajectory"]["position"], &trajectory.position);
    assert_close(&json["trajectory"]["velocity"], &trajectory.velocity);
    assert_close(&json["trajectory"]["acceleration"], &trajectory.acceleration);
    assert_eq!(json["trajectory"]["time"].as_array().expect("a list").len(), trajectory.time.len());
    assert_eq!(json["blends"], serde_json::json!({ "count": 0, "largest_radius": 0.0 }));
    assert_eq!(json["duration"].as_f64(), Some(trajectory.duration()));
    let length = (goal[0] - start[0]).hypot(goal[1] - start[1]);
    assert!((json["length"].as_f64().expect("a number") - length).abs() < 1e-12);
    // There is one line per field, in the order of the list.
    let keys: Vec<_> = text.lines().filter_map(|l| l.strip_prefix("  \"")?.split('"').next()).collect();
    let order = "status name planner joints units path_kind path length optimum certified clearance closest margins tolerances \
                 size timings blends duration interpolation trajectory";
    assert_eq!(keys.join(" "), order);
    assert!(text.starts_with("{\n  \"status\": \"found\",\n") && text.ends_with("]}\n}\n"));
}

#[test]
fn blends_are_counted() {
    let BlendReport { count, largest_radius } = BlendReport::of(&driven(&WAYPOINTS).curve);
    assert!(count == 1 && largest_radius > 0.1 && largest_radius < 2.0, "{count}, {largest_radius}");
}

#[test]
fn infinite_clearance_is_null() {
    let json: Value = serde_json::from_str(&plan_waypoints(false).to_json()).expect("JSON");
    assert_eq!((&json["certified"], json.get("clearance")), (&Value::Bool(true), Some(&Value::Null)));
}

#[test]
fn without_a_path_there_is_a_reason() {
    // A post blocks a link that turns within limits.
    let mut arm = Arm::rr([1.0, 0.8], 0.06).expect("an ordinary arm");
    arm.joints[0] = Joint::turning("shoulder", -2.0, 2.0);
    let post = Obstacle::circle("post", [0.4, 0.0], 0.1).expect("a disc");
    let ends = [-1.0, 1.0].map(|q1| Configuration::new(q1, 2.5));
    let closed = Problem::new(arm, Workspace::new([post]), ends[0], ends[1]).expect("both are free");
    let infeasible = plan(&closed, &Method::Subdivision.into()).expect("an ordinary problem");
    // A slot that does not appear on a coarse grid.
    let (_, slot) = shipped_feasible().into_iter().find(|(name, _)| name == "narrow_slot").expect("a shipped world");
    let coarse = Planner::named(Method::Wavefront).with_space(GridSpace::Sampled).with_cells(16);
    let unknown = plan(&slot.into(), &Options { levels: 1, ..coarse.into() }).expect("an ordinary problem");
    for (plan, status, order) in [
        (
            infeasible,
            Status::Infeasible,
            "certified clearance joints length path planner proof reason size status trajectory units",
        ),
        (
            unknown,
            Status::Unknown,
            "certified clearance joints length name path path_exists planner reason search size space status trajectory units",
        ),
    ] {
        assert_eq!(plan.status(), status);
        let json: Value = serde_json::from_str(&plan.to_json()).expect("JSON");
        let keys: Vec<_> = json.as_object().expect("an object").keys().map(String::as_str).collect();
        assert_eq!(keys.join(" "), order);
        assert_eq!(json["certified"], false);
        assert!(["path", "length", "clearance", "trajectory"].iter().all(|k| json[k].is_null()), "{json}");
        assert_eq!(json["status"], status.name());
        assert_eq!((plan.encoded(Format::Csv), plan.encoded(Format::Yaml)), (None, None));
        assert_eq!(plan.encoded(Format::Json), Some(plan.to_json().into_bytes()));
    }
}

#[test]
fn csv_reads_back() {
    let trajectory = driven(&WAYPOINTS).trajectory;
    let text = csv(&NAMES.map(str::to_owned), &trajectory, &[], false, None);
    let (header, body) = text.split_once('\n').expect("a header");
    let first = "\"shoulder, \"\"left\"\"";
    assert_eq!(header, format!("time,{first}\",no: 1,{first}_velocity\",no: 1_velocity"));
    let mut read = Trajectory { time: vec![], position: vec![], velocity: vec![], ..trajectory.clone() };
    for line in body.lines() {
        let n: Vec<f64> = line.split(',').map(|f| f.parse().expect("a number")).collect();
        assert_eq!(n.len(), 5);
        read.time.push(n[0]);
        read.position.push([n[1], n[2]]);
        read.velocity.push([n[3], n[4]]);
    }
    assert_eq!(read, trajectory);
}

#[test]
fn ros_message_reads_back() {
    // A piece of a nanometre makes samples that are a few microseconds apart.
    for waypoints in [&WAYPOINTS[..], &[[0.0, 0.0], [1e-9, 0.0], [1e-9, 1e-9], [0.3, 0.1]], &[[0.2, 0.1]]] {
        let trajectory = driven(waypoints).trajectory;
        let robot = RobotJoints::only_planned(&NAMES.map(str::to_owned));
        let text = ros_yaml(&JointMotion::new(&robot, &trajectory, true).without_accelerations());
        let message: Value = serde_saphyr::from_str(&text).expect("YAML");
        assert_eq!(message["header"], serde_json::json!({"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}));
        assert_eq!(message["joint_names"], serde_json::json!(NAMES));
        let points = message["points"].as_array().expect("a list");
        assert!(!points.is_empty());
        let field = |name: &str| -> Vec<[f64; 2]> {
            points
                .iter()
                .map(|p| p[name].as_array().map(|a| [a[0].as_f64(), a[1].as_f64()]).expect("a list"))
                .map(|row| row.map(|v| v.expect("a number")))
                .collect()
        };
        assert_eq!(field("positions"), trajectory.position);
        assert_eq!(field("velocities"), trajectory.velocity);
        assert!(points.iter().all(|point| point.get("accelerations").is_none()));
        let at: Vec<u64> = points
            .iter()
            .map(|p| {
                let part = |name: &str| p["time_from_start"][name].as_u64().expect("a whole number");
                assert!(part("nanosec") < 1_000_000_000);
                part("sec") * 1_000_000_000 + part("nanosec")
            })
            .collect();
        assert_eq!(at[0], 0);
        assert!(at.windows(2).all(|w| w[0] < w[1]));
        assert!(at.iter().zip(&trajectory.time).all(|(&ns, &t)| ns as f64 / 1e9 == t));
    }
}
