//! Robots as real files describe them: with limits in degrees, lengths in millimetres, placeholders for speeds, or no
//! limits.

use super::*;
/// Returns `planar_2r` with pieces of its text replaced, wherever they are.
fn arm(changes: &[(&str, &str)]) -> String {
    let urdf = read(shipped("robots/planar_2r.urdf"));
    changes.iter().fold(urdf, |urdf, (from, to)| {
        assert!(urdf.contains(from), "{from}");
        urdf.replace(from, to)
    })
}

const TO_A_TIP: &str = "[start]\njoints = [0.0, 1.0]\n[goal]\ntip = [0.5, 0.5]\n";

/// Checks the hint about a robot that `cplan plan` and `cplan inspect` give.
fn check_hint(changes: &[(&str, &str)], world: &str, parts: &[&str]) {
    let place = Place::new().with("arm.urdf", arm(changes)).with("world.toml", world);
    let planned = place.run(&["arm.urdf", "world.toml"], "");
    let inspected = place.run(&["inspect", "arm.urdf"], "");
    let warned: String = planned.stderr.lines().filter(|line| line.starts_with("warning: ")).collect();
    for part in parts {
        assert!(warned.contains(part), "{part:?} is not in: {}", planned.stderr);
        inspected.says(&[part]);
    }
}

#[test]
fn limits_that_look_like_degrees_are_refused_with_both_readings() {
    let place = Place::new()
        .with("arm.urdf", arm(&[("lower=\"-2.9\" upper=\"2.9\"", "lower=\"-150\" upper=\"150\"")]))
        .with("world.toml", TO_A_TIP);
    let parts = [
        "joint \"shoulder\" has limits from -150 to 150 rad, which are 48 turns; probably degrees are meant",
        "\"150deg\"",
    ];
    place.run(&["arm.urdf", "world.toml"], "").refused(1, &parts);
    place.run(&["reach", "arm.urdf", "world.toml"], "").refused(1, &parts);
    let inspected = place.run(&["inspect", "arm.urdf"], "");
    let remedy = "limits = { shoulder = [\"-150deg\", \"150deg\"], elbow = [\"-150deg\", \"150deg\"] }";
    inspected.says(&[remedy]);
    for range in ["[\"-150deg\", \"150deg\"]", "[-150, 150]"] {
        place.write("world.toml", format!("[robot]\nlimits = {{ shoulder = {range}, elbow = {range} }}\n{TO_A_TIP}"));
        let done = place.run(&["arm.urdf", "world.toml"], "").exits(0);
        // The joints turn 48 times, so that thousands of IK solutions reach the tip's place.
        assert!(done.stdout.lines().count() < 40, "{}", done.stdout);
    }
    // Limits of whole turns are in radians. So are those of a wrist with a cable.
    for range in ["lower=\"-31.416\" upper=\"31.416\"", "lower=\"-6.98\" upper=\"6.98\""] {
        place.write("arm.urdf", arm(&[("lower=\"-2.9\" upper=\"2.9\"", range)]));
        place.write("world.toml", FREE);
        assert_eq!(place.run(&["arm.urdf", "world.toml"], "").code, 0, "{range}");
    }
}

#[test]
fn robots_in_millimetres_are_noticed() {
    let lengths = [("xyz=\"1.0 0 0\"", "xyz=\"625 0 0\""), ("xyz=\"0.8 0 0\"", "xyz=\"425 0 0\"")];
    check_hint(
        &lengths,
        TO_A_TIP,
        &["625 m from joint to joint, 425 m from joint to tip", "if these are millimetres, divide them by 1000"],
    );
    let shapes = [("size=\"1.0 0.1 0.1\"", "size=\"1000 100 100\"")];
    check_hint(&shapes, FREE, &["the shape of link \"upper_arm\" extends", "scale=\"0.001 0.001 0.001\""]);
    let slides = [
        ("type=\"revolute\"", "type=\"prismatic\""),
        ("lower=\"-2.9\" upper=\"2.9\"", "lower=\"0\" upper=\"600\""),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"1 0 0\"/>"),
    ];
    let inspected = Place::new()
        .with("arm.urdf", arm(&slides).replacen("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"0 1 0\"/>", 1))
        .run(&["inspect", "arm.urdf"], "")
        .stdout;
    assert!(
        inspected.contains("joint \"shoulder\" slides from 0 to 600 m; if the limits are in millimetres"),
        "{inspected}"
    );
}

#[test]
fn speeds_that_no_drive_has_are_noticed() {
    let fast =
        "joint \"shoulder\": velocity=\"1000\" in the URDF means 1000 rad/s (57295.8 deg/s), faster than any drive";
    check_hint(&[("velocity=\"2.0\"", "velocity=\"1000\"")], FREE, &[fast, "[robot] velocity = { shoulder = 2.0 }"]);
    check_hint(
        &[("velocity=\"3.0\"", "velocity=\"100\"")],
        FREE,
        &["velocity=\"100\" in the URDF", "times are too short"],
    );
    check_hint(
        &[("velocity=\"3.0\"", "velocity=\"0.0\"")],
        FREE,
        &["joint \"elbow\": velocity=\"0\" in the URDF counts as missing"],
    );
    // Following the hint solves the problem.
    let place = Place::new()
        .with("arm.urdf", arm(&[("velocity=\"2.0\"", "velocity=\"1000\"")]))
        .with("world.toml", format!("[robot]\nvelocity = {{ shoulder = 2.0 }}\n{FREE}"));
    assert_eq!(place.run(&["arm.urdf", "world.toml"], "").stderr, "");
}

#[test]
fn joints_without_an_axis_are_noticed() {
    let parts = ["joint \"shoulder\" has no <axis>, so the x axis", "joint \"elbow\" has no <axis>"];
    check_hint(&[("<axis xyz=\"0 0 1\"/>", "")], TO_A_TIP, &parts);
    let place =
        Place::new().with("arm.urdf", arm(&[]).replacen("<axis xyz=\"0 0 1\"/>", "", 1)).with("world.toml", FREE);
    let parts = ["do not move in one common plane", "joint \"shoulder\" has no <axis>, so the x axis"];
    place.run(&["arm.urdf", "world.toml"], "").refused(1, &parts);
}

/// Message about a missing acceleration limit.
const ASSUMED: &str =
    "joint \"elbow\": no acceleration limit given; 12 rad/s2 assumed (top speed in 0.25 s), only for timing";

const FAST: &str = "time,shoulder,elbow,shoulder_velocity,elbow_velocity\n0,0,0.5,0,0\n0.2,0.4,0.9,0,0\n";

#[test]
fn verify_judges_limits_that_are_given_and_reports_the_others() {
    let place = Place::new()
        .with("world.toml", FREE)
        .with("motion.csv", FAST)
        .with("arm.urdf", arm(&[("velocity=\"2.0\"", "velocity=\"3.0\"")]));
    let verify = |options: &str| place.run(&["verify", "arm.urdf", "world.toml", "motion.csv"], options);
    let report = verify("--anywhere").exits(0);
    report.says(&["elbow: acceleration 60.000000 rad/s2, at most 12.000000", "this does not count", ASSUMED]);
    let json = verify("--anywhere --json").json();
    assert_eq!((&json["verdict"], json["limits_broken"].as_array().unwrap().len()), (&"free".into(), 0));
    assert_eq!(json["assumed_exceeded"][1]["limit"], "acceleration");
    // Stated limits decide, whether the world or the URDF states them.
    place.write("world.toml", format!("[robot]\nacceleration = {{ elbow = 12 }}\n{FREE}"));
    let given = verify("--anywhere --json");
    let json = given.json();
    assert_eq!((given.code, json["limits_broken"].as_array().unwrap().len()), (3, 1), "{json:#}");
    assert_eq!(json["assumed_exceeded"].as_array().unwrap().len(), 1);
    place.write("world.toml", FREE);
    place.write("arm.urdf", arm(&[("velocity=\"2.0\"", "velocity=\"2.0\"")]));
    assert_eq!(verify("--anywhere").code, 3);
    // A speed that no file states does not decide.
    place.write("arm.urdf", arm(&[(" velocity=\"2.0\"", ""), (" velocity=\"3.0\"", "")]));
    verify("--anywhere").exits(0).says(&["shoulder: velocity 3.000000 rad/s, at most 1.000000"]);
}

#[test]
fn assumptions_have_the_same_words_everywhere() {
    let place = Place::new()
        .with("world.toml", FREE)
        .with("arm.urdf", arm(&[]))
        .with("motion.csv", "time,shoulder,elbow\n0,-0.9,0.4\n9,-0.8,0.4\n")
        .with("problems.jsonl", "{\"urdf\": \"arm.urdf\", \"world\": \"world.toml\"}\n");
    let run = |files: &[&str], options: &str| {
        let done = place.run(files, options).exits(0);
        done.stdout + &done.stderr
    };
    let quoted = ASSUMED.replace('"', "\\\"");
    assert!(run(&["arm.urdf", "world.toml"], "").contains(ASSUMED));
    assert!(run(&["arm.urdf", "world.toml"], "--json").contains(&quoted));
    assert!(run(&["batch", "problems.jsonl"], "").contains(&quoted));
    assert!(run(&["verify", "arm.urdf", "world.toml", "motion.csv"], "--anywhere").contains(ASSUMED));
    assert!(run(&["check", "arm.urdf", "world.toml"], "--at 0,0").contains(ASSUMED));
    #[cfg(feature = "study")]
    {
        let study = "robot = \"arm.urdf\"\nworld = \"world.toml\"\n[[parameter]]\nname = \"q\"\nsets = \"world.start.joints[0]\"\nvalues = [-0.9]\n";
        place.write("study.toml", study);
        assert!(run(&["study", "study.toml"], "").contains(ASSUMED));
    }
}
