//! The program's own outputs in all formats, unchanged and tampered with.

use cplan::check::{CollisionCheck, Limit, LimitViolation, check_collision, limit_violations};
use cplan::engine::{Method, Plan, Problem, plan};
use cplan::input::{self, LoadedScene, Overrides, load_recording, load_scene};
use cplan::model::RobotJoints;
#[cfg(feature = "mcap")]
use cplan::motion::mcap;
use cplan::motion::{Format, JointMotion, Trajectory, csv, ros_yaml};
use cplan::space::{Configuration, Path, Recording};
use serde_json::Value;
use std::path::PathBuf;

fn root(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file)
}

/// Returns a shipped workspace with the motion that the planner finds in it. Returns `None` if it finds none.
fn plan_shipped(robot: &str, world: &str) -> Option<(LoadedScene, Plan)> {
    let files = [root(&format!("robots/{robot}.urdf")), root(&format!("workspaces/{world}.toml"))];
    let problem = input::load(&files[0], &files[1], &Overrides::default()).unwrap().problem;
    let plan = plan(&Problem::from(problem), &Method::Visibility.into()).unwrap();
    plan.trajectory()?;
    Some((load_scene(&files[0], &files[1]).unwrap(), plan))
}

/// Formats that `verify` reads, each with a name.
const FORMATS: &[(Format, &str)] = &[
    (Format::Json, "a.json"),
    (Format::Csv, "a.csv"),
    (Format::Yaml, "a.yaml"),
    #[cfg(feature = "mcap")]
    (Format::Mcap, "a.mcap"),
];

fn read(scene: &LoadedScene, name: &str, content: impl AsRef<[u8]>) -> Recording {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    std::fs::write(&file, content).unwrap();
    load_recording(&file, scene).unwrap_or_else(|e| panic!("{e}")).recording
}

fn judge(scene: &LoadedScene, recording: &Recording) -> (CollisionCheck, Vec<LimitViolation>) {
    let clearance = scene.scene.workspace().clearance;
    (check_collision(&scene.scene, recording, clearance), limit_violations(&scene.scene.arm().joints, recording))
}

#[test]
fn every_shipped_result_verifies_alike_in_all_formats() {
    let mut checked = 0;
    for entry in std::fs::read_dir(root("workspaces")).unwrap() {
        let file = entry.unwrap().path();
        if file.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        let Some(robot) = text.lines().find_map(|l| l.strip_prefix("# robot: ")) else { continue };
        let name = file.file_stem().unwrap().to_str().unwrap();
        let Some((scene, plan)) = plan_shipped(robot.trim(), name) else { continue };
        for &(format, file) in FORMATS {
            let recording = read(&scene, file, plan.encoded(format).unwrap());
            let (verdict, broken) = judge(&scene, &recording);
            let CollisionCheck::Free { clearance, .. } = verdict else { panic!("{name}, {file}: {verdict:?}") };
            assert_eq!(broken, [], "{name}, {file}");
            // The motion is the same. The bounds depend on the search, but both are at least 0.9 of the truth.
            if let Some(certified) = plan.clearance() {
                assert!(clearance >= 0.9 * certified && certified >= 0.9 * clearance, "{name}, {file}: {clearance}");
            }
        }
        checked += 1;
    }
    assert!(checked >= 10, "only {checked} workspaces");
}

/// Returns the file's content, with another motion instead of the plan's.
fn written(format: Format, plan: &Plan, motion: &Trajectory) -> Vec<u8> {
    let names = plan.arm().joints.each_ref().map(|joint| joint.name.clone());
    let message = JointMotion::new(&RobotJoints::only_planned(&names), motion, true).without_accelerations();
    match format {
        Format::Json => {
            let mut result: Value = serde_json::from_str(&plan.to_json()).unwrap();
            result["trajectory"] = serde_json::to_value(motion).unwrap();
            result.to_string().into_bytes()
        }
        Format::Csv => csv(&names, motion, &[], false, None).into_bytes(),
        Format::Yaml => ros_yaml(&message).into_bytes(),
        #[cfg(feature = "mcap")]
        Format::Mcap => mcap(&[(&message, 0.0)], None),
    }
}

fn shelf() -> (LoadedScene, Plan) {
    plan_shipped("planar_2r", "shelf").expect("has a path")
}

#[test]
fn tampered_results_are_caught() {
    let (scene, plan) = shelf();
    let motion = plan.trajectory().unwrap();
    let read =
        |motion: &Trajectory, format: Format, name| judge(&scene, &read(&scene, name, written(format, &plan, motion)));
    let with = |change: &dyn Fn(&mut Trajectory)| {
        let mut motion = motion.clone();
        change(&mut motion);
        motion
    };
    let kinds = |broken: &[LimitViolation]| broken.iter().map(|e| (e.joint, e.limit)).collect::<Vec<_>>();

    // Twice as fast in the same shape: speeds double, accelerations quadruple.
    let fast = with(&|t| {
        t.time.iter_mut().for_each(|t| *t /= 2.0);
        t.velocity.iter_mut().flatten().for_each(|v| *v *= 2.0);
        t.acceleration.iter_mut().flatten().for_each(|a| *a *= 4.0);
    });
    let last = motion.time.len() - 1;
    let times = motion.time.clone();
    // One sample moved into the shelf: contact before it, and after the sample before.
    let at = last / 2;
    let hit = with(&|t| t.position[at] = [0.15, 0.08]);
    assert!(scene.scene.clearance(Configuration::new(0.15, 0.08)) < -0.1);
    let pushed = with(&|t| t.velocity[0][1] = 0.25);
    let thrown = with(&|t| t.velocity[last][0] = -0.25);

    for &(format, name) in FORMATS {
        let (verdict, broken) = read(&fast, format, name);
        assert!(matches!(verdict, CollisionCheck::Free { .. }), "{name}");
        let ratio = |limit| {
            let worst = broken.iter().filter(|e| e.limit == limit);
            worst.map(|e| e.value.abs() / e.allowed).fold(0.0, f64::max)
        };
        let (speed, pull) = (ratio(Limit::Velocity), ratio(Limit::Acceleration));
        // Times in nanoseconds increase the accelerations of blends, whose samples are close together, slightly.
        assert!((speed - 2.0).abs() < 1e-3 && (pull - 4.0).abs() < 0.2, "{name}: {speed}, {pull}");

        let (verdict, broken) = read(&pushed, format, name);
        assert!(matches!(verdict, CollisionCheck::Free { .. }), "{name}");
        assert!(kinds(&broken).contains(&(1, Limit::RestAtStart)), "{name}: {broken:?}");
        let (_, broken) = read(&thrown, format, name);
        let end = broken.iter().find(|e| e.limit == Limit::RestAtEnd).expect("does not end at rest");
        assert_eq!((end.joint, end.value, end.moment.sample), (0, -0.25, last), "{name}");

        let (verdict, _) = read(&hit, format, name);
        let CollisionCheck::Collision { first, free_until, deepest, .. } = verdict else {
            panic!("{name}: {verdict:?}")
        };
        assert!(
            times[at - 1] < free_until && free_until <= first.moment.time && first.moment.time < times[at],
            "{name}"
        );
        assert!(scene.scene.describe(first.contact.pair).contains("obstacle \"shelf\""), "{name}");
        assert!(deepest.contact.separation.distance < -0.1, "{name}");
    }
}

#[test]
fn the_straight_motion_collides_where_the_path_does_not() {
    let (scene, plan) = shelf();
    let path = plan.waypoints().unwrap();
    let (a, b) = (path[0], path[path.len() - 1]);
    let csv = format!("shoulder,elbow\n{},{}\n{},{}\n", a[0], a[1], b[0], b[1]);
    let (verdict, broken) = judge(&scene, &read(&scene, "ends.csv", &csv));
    let CollisionCheck::Collision { first, .. } = verdict else { panic!("{verdict:?}") };
    assert_eq!(broken, []);
    // The first contact by bisection of densely sampled distances.
    let at = |u: f64| Configuration::new(a[0] + (b[0] - a[0]) * u, a[1] + (b[1] - a[1]) * u);
    let sampled = (0..=100_000).map(|i| f64::from(i) / 1e5).find(|u| scene.scene.clearance(at(*u)) <= 0.0).unwrap();
    assert!(first.moment.time <= sampled && sampled - first.moment.time <= 1e-5);
}

#[test]
fn spellings_of_columns_and_messages_mean_the_same() {
    let (scene, _) = shelf();
    let expected = Recording::new(
        vec![Configuration::new(0.1, 0.2), Configuration::new(0.2, 0.3)],
        Some(vec![0.0, 1.5]),
        Some(vec![Configuration::zeros(), Configuration::new(0.0, -0.5)]),
    )
    .unwrap();
    for (name, text) in [
        ("a.csv", "time,shoulder,elbow,shoulder_velocity,elbow_velocity\n0,0.1,0.2,0,0\n1.5,0.2,0.3,0,-0.5\n"),
        (
            "a.CSV",
            "elbow.velocity, elbow.position ,effort,t,vel_shoulder,pos_shoulder\r\n0,.2,9,0,0,.1\r\n-0.5,.3,9,1.5,0,.2\r\n",
        ),
        (
            "a.csv",
            "# time_from_start,/js/shoulder/position,/js/elbow/position,/js/elbow/velocity,/js/shoulder/velocity\n0,0.1,0.2,0,0\n\n15e-1,0.2,0.3,-0.5,0",
        ),
        (
            "a.yaml",
            "joint_names: [elbow, camera, shoulder]\npoints:\n- {positions: [0.2, 7, 0.1], velocities: [0, 0, 0], effort: [], time_from_start: {sec: 0}}\n- positions: [0.3, 8, 0.2]\n  velocities: [-0.5, 0, 0]\n  time_from_start: {sec: 1, nanosec: 500000000}\n---\n",
        ),
        (
            "a.yml",
            "joint_trajectory:\n  joint_names: [shoulder, elbow]\n  points:\n  - {positions: [0.1, 0.2], velocities: [0, 0], time_from_start: 0}\n  - {positions: [0.2, 0.3], velocities: [0, -0.5], time_from_start: 1.5}\n",
        ),
        (
            "a.json",
            r#"{"joint_names": ["shoulder", "elbow"], "points": [
            {"positions": [0.1, 0.2], "velocities": [0, 0], "time_from_start": {"secs": 0, "nsecs": 0}},
            {"positions": [0.2, 0.3], "velocities": [0, -0.5], "time_from_start": {"secs": 1, "nsecs": 500000000}}]}"#,
        ),
        (
            "a.json",
            r#"{"joints": ["elbow", "shoulder"], "path": [[9, 9]], "trajectory":
            {"time": [0, 1.5], "position": [[0.2, 0.1], [0.3, 0.2]], "velocity": [[0, 0], [-0.5, 0]]}}"#,
        ),
    ] {
        assert_eq!(read(&scene, name, text), expected, "{text}");
    }
    let path = read(&scene, "a.json", r#"{"joints": ["elbow", "shoulder"], "path": [[0.2, 0.1], [0.3, 0.2]]}"#);
    assert_eq!(path.outline(), Path::new(expected.positions().to_vec()));
    assert!(path.times().is_none() && path.velocities().is_none());
}

#[test]
fn messages_of_sixty_thousand_points_are_read() {
    let (scene, _) = shelf();
    let mut text = String::from("joint_names: [shoulder, elbow]\npoints:\n");
    for k in 0..60_000 {
        text += &format!("- positions: [0.0, 0.0]\n  time_from_start: {{sec: {k}, nanosec: 0}}\n");
    }
    assert_eq!(read(&scene, "long.yaml", &text).positions().len(), 60_000);
}

/// Checks a recording of hundreds of mebibytes, which cplan can write and read.
#[test]
fn a_recording_may_be_larger_than_other_files() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("m.csv");
    let padding = " ".repeat(257 << 20);
    std::fs::write(&file, format!("time,shoulder,elbow\n#{padding}\n0,-0.9,0.4\n1,-0.8,0.4\n")).unwrap();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = load_scene(root.join("robots/planar_2r.urdf"), &root.join("workspaces/shelf.toml")).unwrap();
    let loaded = load_recording(&file, &scene).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.recording.positions().len(), 2);
    // A robot file of this size is not read, and the hint is not about permissions.
    let error = load_scene(&file, &root.join("workspaces/shelf.toml")).unwrap_err().to_string();
    assert!(error.contains("larger than 256 MiB") && !error.contains("permissions"), "{error}");
}
