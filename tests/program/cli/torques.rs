//! Torques through the program: respected, reported and judged; missing data is named.

use super::*;
fn upright() -> [String; 2] {
    [shipped("robots/rrbot_vertical.urdf"), shipped("workspaces/upright.toml")]
}

/// Returns the greatest torque of each joint in a result.
fn greatest(result: &Value) -> [f64; 2] {
    let rows = result["trajectory"]["torque"].as_array().expect("torques");
    assert_eq!(rows.len(), result["trajectory"]["time"].as_array().expect("times").len());
    [0, 1].map(|k| rows.iter().map(|row| row[k].as_f64().expect("a number").abs()).fold(0.0, f64::max))
}

#[test]
fn torques_are_limited_reported_and_judged() {
    let place = Place::new();
    let [urdf, world] = upright();
    let done =
        place.run(&upright(), "--verbose --output m.json --output m.csv --output m.yaml --picture m.html").exits(0);
    done.says(&["at most 2 rad/s, 36 N m", "at most 3 rad/s, 12 N m", "torque     at most shoulder 35."]);
    let result = place.json("m.json");
    let [shoulder, elbow] = greatest(&result);
    assert!((35.0..=36.0).contains(&shoulder) && (10.0..=12.0).contains(&elbow), "{shoulder} {elbow}");
    assert_eq!(result["assumed"], Value::Null, "efforts take the place of accelerations");
    let table = place.read("m.csv");
    assert!(table.lines().next().unwrap().ends_with(",shoulder_torque,elbow_torque"), "{table}");
    assert!(place.read("m.html").contains("\"torque\":36"));
    for file in ["m.json", "m.csv", "m.yaml"] {
        place.run(&["verify", &urdf, &world, file], "").exits(0);
    }
    // With weaker motors, the same motion needs too much torque.
    let weaker = read(&world).replace("shoulder = 36, elbow = 12", "shoulder = 35, elbow = 11");
    place.write("weaker.toml", weaker);
    for file in ["m.json", "m.csv", "m.yaml"] {
        let verified = place.run(&["verify", &urdf, "weaker.toml", file], "").exits(3);
        verified.says(&["shoulder: torque", "N m, at most 35.0", "elbow: torque", "at most 11.0"]);
    }
}

#[test]
fn the_option_equals_the_setting_of_the_world() {
    let place = Place::new();
    let [urdf, world] = upright();
    let text = read(&world);
    place.write("silent.toml", text.replace("dynamics = true\n", ""));
    let silent = [urdf.as_str(), "silent.toml"];
    let output = place.run(&upright(), "--json --quiet").json();
    assert_eq!(place.run(&silent, "--torque --json --quiet").json(), output);
    // Without the option, accelerations are assumed, and there are no torques to report.
    let without = place.run(&silent, "--output plain.json --json --quiet").json();
    assert!(without["trajectory"]["torque"].is_null() && !without["assumed"]["acceleration"].is_null());
    let verify = |options: &str, file: &str| place.run(&["verify", &urdf, "silent.toml", file], options);
    assert_eq!(verify("", "plain.json").code, 0);
    verify("--torque", "plain.json").exits(3).says(&["torque"]);
    // A motion with stated torques must have these.
    place.run(&silent, "--torque --output m.json --output m.csv").exits(0);
    for file in ["m.json", "m.csv"] {
        assert_eq!(verify("", file).code, 0, "{file}");
    }
}

#[test]
fn motions_with_payloads_and_drives_stay_within_the_efforts() {
    let place = Place::new();
    let [urdf, _] = upright();
    let heavy = shipped("workspaces/tasks/heavy_tower.toml");
    let seconds = |world: &str, options: &str| {
        let done = place.run(&[&urdf, world], &format!("{options} --output m.json --json --quiet")).exits(0);
        place.run(&["verify", &urdf, world, "m.json"], "").exits(0);
        let [shoulder, elbow] = greatest(&done.json());
        assert!(shoulder <= 45.0 && elbow <= 16.0, "{shoulder} {elbow}");
        done.json()["duration"].as_f64().unwrap()
    };
    let text = read(&heavy);
    place.write("light.toml", text.replace("mass = 1.5", "mass = 0"));
    let (laden, light) = (seconds(&heavy, ""), seconds("light.toml", ""));
    assert!(light < 0.95 * laden, "{light} {laden}");
    let jerk = seconds(&heavy, "--jerk 300,300");
    assert!(jerk > laden, "{jerk}");
    // The judge includes the payload: the motion of light blocks needs too much torque for heavy ones.
    place.run(&[&urdf, "light.toml"], "--output light.json").exits(0);
    place.run(&["verify", &urdf, &heavy, "light.json"], "").exits(3).says(&["torque"]);
}

#[test]
fn missing_and_invalid_settings_are_named() {
    let place = Place::new();
    let [urdf, world] = upright();
    place.run(&shelf(), "--torque").refused(1, &["--torque", "link \"upper_arm\" has no mass", "<inertial>"]);
    let [plain, _] = shelf();
    place.run(&[plain.as_str(), world.as_str()], "").refused(1, &["has no mass", "hint"]);
    let text = read(&world);
    let cases = [
        ("shoulder = 36", "shoulder = 0", "effort of \"shoulder\" must be positive"),
        ("shoulder = 36", "wrist = 36", "has no joint \"wrist\""),
        ("shoulder = 36", "shoulder = 9", "joint \"shoulder\" has an effort of 9 N m, but holding the arm at"),
        ("dynamics = true", "dynamics = true\ngravity = [0, 1]", "gravity: expected three finite numbers"),
        ("dynamics = true", "dynamics = 1", "dynamics"),
    ];
    for (from, to, part) in cases {
        place.write("wrong.toml", text.replace(from, to));
        place.run(&[urdf.as_str(), "wrong.toml"], "").refused(1, &[part]);
    }
    // Invalid values are refused, even if nothing depends on them.
    for wrong in ["shoulder = 0", "shoulder = nan", "gravity"] {
        let silent = text.replace("dynamics = true\n", if wrong == "gravity" { "gravity = [0, 1]\n" } else { "" });
        place.write(
            "wrong.toml",
            silent.replace("shoulder = 36", if wrong == "gravity" { "shoulder = 36" } else { wrong }),
        );
        place.run(&[urdf.as_str(), "wrong.toml"], "").refused(1, &["[robot]", "wrong.toml", "hint"]);
    }
    let robot = read(&urdf);
    let robots = [
        ("<mass value=\"4\"/>", "<mass value=\"-4\"/>", "has a mass of -4 kg"),
        ("<mass value=\"4\"/>", "", "link \"upper_arm\" has no mass"),
        ("iyy=\"0.0423\"", "iyy=\"-0.0423\"", "an inertia of -0.0423 kg m2"),
    ];
    for (from, to, part) in robots {
        place.write("wrong.urdf", robot.replace(from, to));
        place.run(&["wrong.urdf", world.as_str()], "").refused(1, &[part]);
        // Nothing else depends on it.
        place.write("silent.toml", text.replace("dynamics = true\n", ""));
        assert_eq!(place.run(&["wrong.urdf", "silent.toml"], "").code, 0, "{part}");
    }
    place.write("weak.urdf", robot.replace(" effort=\"50\" velocity=\"2.0\"", " velocity=\"2.0\""));
    place.write("own.toml", text.replace("effort = { shoulder = 36, elbow = 12 }", ""));
    place.run(&["weak.urdf", "own.toml"], "").refused(1, &["joint \"shoulder\" has no effort", "[robot] effort"]);
}

/// Checks the effort that holds the arm at the end. No motion follows the end, so none would show that the effort is
/// exceeded.
#[test]
fn the_efforts_hold_the_arm_at_the_end() {
    let place = Place::new();
    let world = read(shipped("workspaces/tasks/heavy_tower.toml"));
    let ends_holding = world.split("[[step]]\nplace").next().unwrap();
    place.write("light.toml", ends_holding);
    place.write("heavy.toml", ends_holding.replace("mass = 1.5", "mass = 30"));
    let robot = shipped("robots/rrbot_vertical.urdf");
    place.run(&[&robot, "light.toml"], "--quiet --output held.json").exits(0);
    let heavy = place.run(&[&robot, "heavy.toml"], "").exits(4);
    heavy.says(&["after this step, joint \"shoulder\" has an effort of 45 N m"]);
    // The same motion is judged as one with the heavier block.
    for (world, code) in [("light.toml", 0), ("heavy.toml", 3)] {
        let verified = place.run(&["verify", &robot, world, "held.json"], "").exits(code);
        assert_eq!(verified.stdout.contains("shoulder: torque"), code == 3, "{}", verified.stdout);
    }
}

/// Checks efforts that are far too small, as in a wrong unit, in the world or in the robot's file.
#[test]
fn tiny_efforts_are_distinguished_from_massless_links() {
    let place = Place::new();
    let [urdf, world] = upright();
    let text = read(&world);
    let weak = text.replace("shoulder = 36", "shoulder = 1e-14");
    assert_ne!(weak, text);
    place.write("weak.toml", weak);
    let parts = ["efforts of the joints are far too small", "hint: check the units"];
    place.run(&[&urdf, "weak.toml"], "").refused(1, &parts);
}

/// Checks recordings without velocities. The speed of the arm is unknown, so torques cannot be judged. For a single
/// sample, the program computes the torques that hold the arm there.
#[test]
fn torques_of_recordings_without_velocities_are_not_judged() {
    let place = Place::new();
    let [urdf, world] = upright();
    place.write("path.csv", "time,shoulder,elbow\n0,1.9,-0.4\n10,1.9,-0.39\n");
    let verified = place.run(&["verify", &urdf, &world, "path.csv"], "--anywhere").exits(4);
    verified.says(&["no velocities: torques are unknown"]);
    place.write("one.csv", "time,shoulder,elbow,shoulder_velocity,elbow_velocity\n0,1.9,-0.4,0,0\n");
    let weaker = read(&world).replace("shoulder = 36, elbow = 12", "shoulder = 3, elbow = 1");
    place.write("weaker.toml", weaker);
    for (world, code) in [(world.as_str(), 0), ("weaker.toml", 3)] {
        place.run(&["verify", &urdf, world, "one.csv"], "--anywhere").exits(code);
    }
}
