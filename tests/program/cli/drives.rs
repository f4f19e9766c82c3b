//! Motors: files with their angles, recordings and certificates that their limits refute, and mistakes in their table.

use super::*;
fn files(world: &str) -> [String; 2] {
    [shipped("robots/planar_2r.urdf"), shipped(&format!("workspaces/{world}.toml"))]
}

/// The files have the angles of both shafts, by the formula of the page, through gears as well.
#[test]
fn results_have_the_angles_of_the_shafts() {
    let place = Place::new();
    let [urdf, world] = files("belt_elbow_open");
    let world = std::fs::read_to_string(world).unwrap();
    let geared = "ratio = 1.0, gear = [2.0, -3.0], zero = [0.5, \"-90deg\"], ";
    let limits = "lower = [\"-150deg\", \"-50deg\"], upper = [\"150deg\", \"90deg\"]";
    let turned = "lower = [-4.7, \"-360deg\"], upper = [5.7, \"60deg\"]";
    place.write("world.toml", world.replace("ratio = 1.0, ", geared).replace(limits, turned));
    place.run(&[&urdf, "world.toml"], "--output plan.json --output plan.csv").exits(0);
    let result = place.json("plan.json");
    let trajectory = &result["trajectory"];
    let rows = trajectory["position"].as_array().unwrap().iter().zip(trajectory["motors"].as_array().unwrap());
    let csv = place.read("plan.csv");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("time,shoulder,elbow,shoulder_velocity,elbow_velocity,motor_1,motor_2"));
    let mut count = 0;
    for ((q, motors), line) in rows.zip(lines) {
        let [q1, q2] = [number(&q[0]), number(&q[1])];
        let expected = [2.0 * q1 + 0.5, -3.0 * (q1 + q2) - std::f64::consts::FRAC_PI_2];
        let written: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        for k in 0..2 {
            assert!((number(&motors[k]) - expected[k]).abs() < 1e-12 && written[5 + k] == number(&motors[k]), "{line}");
        }
        count += 1;
    }
    assert!(count > 100, "{count}");
}

/// Answers for the motor on the base are certified by the checker, found and infeasible; and refuted where the motor has a
/// narrower range.
#[test]
fn the_checker_knows_the_range_of_the_elbow_motor() {
    let place = Place::new();
    let [urdf, world] = files("belt_elbow_open");
    let text = |file: &str| std::fs::read_to_string(file).unwrap();
    let judged = |world: &str, certificate: &str| check(&text(&urdf), world, &place.read(certificate));
    // Judges the evidence of one world in another one, which has a certificate of its own.
    let judged_elsewhere = |world: &str, evidence: &str, own: &str| {
        let digest = |certificate: &str| {
            let value = place.json(certificate);
            value["world"].as_str().unwrap().to_owned()
        };
        check(&text(&urdf), world, &place.read(evidence).replace(&digest(evidence), &digest(own)))
    };
    place.run(&[&urdf, &world], "--output plan.json --certificate found.json").exits(0);
    assert!(judged(&text(&world), "found.json").is_ok(), "{:?}", judged(&text(&world), "found.json"));
    let narrow = text(&world).replace("\"90deg\"]", "\"76deg\"]");
    place.write("narrow.toml", &narrow);
    place.run(&[&urdf, "narrow.toml"], "--certificate narrow.json");
    let refuted = judged_elsewhere(&narrow, "found.json", "narrow.json").unwrap_err().to_string();
    assert!(refuted.contains("the elbow's motor leaves its limits"), "{refuted}");
    // The same for a recording.
    let done = place.run(&["verify", &urdf, "narrow.toml", "plan.json"], "");
    assert!(done.code != 0 && done.stdout.contains("elbow motor: position"), "{}", done.stdout);
    let fast = read(&world).replace("2.5] }", "2.0] }");
    place.write("slow.toml", &fast);
    let done = place.run(&["verify", &urdf, "slow.toml", "plan.json"], "");
    assert!(done.code != 0 && done.stdout.contains("elbow motor: velocity"), "{}", done.stdout);

    let [_, closed] = files("belt_elbow_closed");
    place.run(&[&urdf, &closed], "--certificate closed.json").exits(3);
    assert!(judged(&text(&closed), "closed.json").is_ok(), "{:?}", judged(&text(&closed), "closed.json"));
    let refuted = judged_elsewhere(&text(&world), "closed.json", "found.json").unwrap_err().to_string();
    assert!(refuted.contains("do not separate"), "{refuted}");
    let explained = place.run(&["explain", &urdf, &closed], "--json");
    let explained: Value = serde_json::from_str(&explained.stdout).unwrap();
    assert!(explained.to_string().contains("\"kind\":\"motor\""), "{explained}");
}

#[test]
fn mistakes_in_the_table_of_motors_have_a_place_and_a_hint() {
    let place = Place::new();
    let [urdf, world] = files("shelf");
    let world = std::fs::read_to_string(world).unwrap();
    for (drives, message) in [
        ("\"standard\"", "\"standard\" is unknown"),
        ("{ elbow = \"wrist\" }", "elbow is \"wrist\""),
        ("{ elbow = \"link\", ratio = 2.0 }", "a motor on the link has no ratio"),
        ("{ gear = [1.0, 0.0] }", "the gear of motor 2 must be from 1e-6"),
        ("{ gear = [1.0] }", "gear has 1 numbers, but there are two motors"),
        ("{ motors = { lower = [-1.0, -1.0] } }", "motors need both lower and upper limits"),
        ("{ motors = { lower = [-1.0, 1.0], upper = [1.0, 0.5] } }", "the lower limit of motor 2 is not below"),
        ("{ motors = { velocity = [1.0, 0.0] } }", "velocity: both numbers must be above 0"),
        ("{ motors = { lower = [3.0, -1.0], upper = [4.0, 1.0] } }", "leave joint \"shoulder\" no values"),
        ("{ motors = { speed = [1.0, 2.0] } }", "unknown key `speed`"),
    ] {
        place.write("world.toml", world.replace("[start]", &format!("[robot]\ndrives = {drives}\n[start]")));
        place.run(&[&urdf, "world.toml"], "").exits(1).warns(&[message, "world.toml: line ", "hint"]);
    }
    let gantry = [shipped("robots/gantry.urdf"), shipped("workspaces/gantry_maze.toml")];
    let maze = read(&gantry[1]);
    let at = maze.find("[start]").unwrap();
    place.write("maze.toml", format!("{}[robot]\ndrives = \"direct\"\n{}", &maze[..at], &maze[at..]));
    place.run(&[&gantry[0], "maze.toml"], "").exits(1).warns(&["both joints must turn"]);
}

/// `init` writes the key, and plans the world at once.
#[test]
fn data_sheets_state_where_the_motors_are() {
    let place = Place::new();
    place.run(&["init", "plotter"], "--kind 2r --links 0.2,0.2 --drives standard_scara").exits(0);
    assert!(place.read("plotter/world.toml").contains("\ndrives = \"standard_scara\"\n"));
    let planned = place.run(&["plotter/arm.urdf", "plotter/world.toml"], "--json");
    let result: Value = serde_json::from_str(&planned.stdout).unwrap();
    assert!(planned.code == 0 && result["trajectory"]["motors"].is_array(), "{}", planned.stdout);
    let refused = place.run(&["init", "gantry"], "--kind gantry --drives direct").exits(2);
    refused.warns(&["--drives needs two joints that turn"]);
}

/// Numbers beyond 1e6 are refused, and messages about the range of a motor name it.
#[test]
fn messages_name_the_motor() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    let run = |command: &[&str], drives: &str| {
        let ends = "[start]\njoints = [\"0deg\", \"90deg\"]\n[goal]\njoints = [\"60deg\", \"20deg\"]\n";
        place.write("world.toml", format!("[robot]\ndrives = {{ {drives} }}\n{ends}"));
        place.run(&[command, &[&robot, "world.toml"]].concat(), "")
    };
    for drives in [
        "zero = [1e300, 0]",
        "gear = [1e-300, 1.0]",
        "motors = { lower = [-1e300, -1e300], upper = [1e300, 1e300] }",
        "motors = { velocity = [1e300, 1.0] }",
    ] {
        let done = run(&[], drives);
        assert!(done.code == 1 && done.stderr.contains("1e6"), "{drives}: {} {}", done.code, done.stderr);
    }
    let narrow = "motors = { lower = [\"-150deg\", \"0deg\"], upper = [\"150deg\", \"85deg\"] }";
    let done = run(&[], narrow);
    assert!(done.code == 1 && done.stderr.contains("of motors in [robot] drives"), "{}", done.stderr);
    let done = run(&["explain"], narrow);
    for part in ["The start is beyond the range of the elbow's motor.", "5.00 deg (0.0873 rad) beyond its range"] {
        assert!(done.stdout.contains(part), "{part:?}: {}", done.stdout);
    }
    assert!(!done.stdout.contains("collides"), "{}", done.stdout);
}
