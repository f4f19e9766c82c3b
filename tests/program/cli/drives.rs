//! Motors: files with their angles, recordings and certificates that their limits refute, and mistakes in their table.

use super::*;
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
        ("{ elbow = \"link\", ratio = 2.0 }", "elbow = \"link\" cannot have a ratio"),
        ("{ gear = [1.0, 0.0] }", "the gear of motor 2 must be from 1e-6"),
        ("{ gear = [1.0] }", "gear has 1 numbers, but there are two motors"),
        ("{ motors = { lower = [-1.0, -1.0] } }", "motors need both lower and upper limits"),
        ("{ motors = { lower = [-1.0, 1.0], upper = [1.0, 0.5] } }", "the lower limit of motor 2 is not below"),
        ("{ motors = { velocity = [1.0, 0.0] } }", "velocity: both numbers must be above 0"),
        ("{ motors = { lower = [3.0, -1.0], upper = [4.0, 1.0] } }", "no value of joint \"shoulder\""),
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

/// Returns rows of pairs of a result's trajectory.
fn rows(result: &Value, key: &str) -> Vec<[f64; 2]> {
    let pair = |row: &Value| [0, 1].map(|k| number(&row[k]));
    result["trajectory"][key].as_array().unwrap_or_else(|| panic!("{key}")).iter().map(pair).collect()
}

/// The torques of both shafts, by the transpose of the inverse of `m = G (K q)`, stay within the efforts of the motors, and
/// reach them. Recordings are judged by them.
#[test]
fn torques_of_motors_are_limited() {
    let place = Place::new();
    let robot = shipped("robots/rrbot_vertical.urdf");
    let world = read(shipped("workspaces/upright.toml"));
    let with = |drives: &str| world.replace("[robot]\n", &format!("[robot]\ndrives = {{ {drives} }}\n"));
    let gear = [2.0, -3.0];
    place.write("free.toml", with("ratio = 1.0, gear = [2.0, -3.0]"));
    let free = place.run(&[&robot, "free.toml"], "--output free.json").exits(0);
    assert!(free.stderr.is_empty(), "{}", free.stderr);
    let shafts = |result: &Value| -> [f64; 2] {
        let torques = rows(result, "torque");
        let of = |[one, two]: [f64; 2]| [(one - two) / gear[0], two / gear[1]];
        [0, 1].map(|k| torques.iter().map(|row| of(*row)[k].abs()).fold(0.0, f64::max))
    };
    let [first, second] = shafts(&place.json("free.json"));
    // Weaker than the motion without motors requires, but strong enough to hold the arm.
    let efforts = [0.97 * first, 0.97 * second];
    let limited = format!("ratio = 1.0, gear = [2.0, -3.0], motors = {{ effort = [{}, {}] }}", efforts[0], efforts[1]);
    place.write("limited.toml", with(&limited));
    place.run(&[&robot, "limited.toml"], "--output limited.json").exits(0);
    let result = place.json("limited.json");
    let reached = shafts(&result);
    for k in 0..2 {
        assert!(reached[k] <= efforts[k] * (1.0 + 1e-6), "{k}: {reached:?} {efforts:?}");
    }
    assert!((0..2).any(|k| reached[k] >= 0.93 * efforts[k]), "{reached:?} {efforts:?}");
    place.run(&["verify", &robot, "limited.toml", "limited.json"], "").exits(0);
    let first_alone = format!("ratio = 1.0, gear = [2.0, -3.0], motors = {{ effort = [{}, 1e5] }}", 0.9 * first);
    place.write("first.toml", with(&first_alone));
    place.run(&["verify", &robot, "first.toml", "free.json"], "").exits(3).says(&["first motor: torque"]);
    // A motor that cannot hold the arm.
    place.write("weak.toml", with("ratio = 1.0, motors = { effort = [3.0, 1e5] }"));
    place.run(&[&robot, "weak.toml"], "").exits(1).warns(&["motor 1 has an effort of 3 N m", "raise the effort"]);
}

/// The jerk of the elbow's motor limits straight moves and rounded corners, and recordings are judged by it.
#[test]
fn jerks_of_motors_are_limited() {
    let place = Place::new();
    let [robot, world] = files("belt_elbow_open");
    let world = read(world);
    let with = |limits: &str| world.replace("velocity = [2.0, 2.5] }", &format!("velocity = [2.0, 2.5], {limits} }}"));
    let most = 40.0;
    for (name, options) in [("stops", "--blend none"), ("blends", "")] {
        place.write("jerk.toml", with("jerk = [60.0, 40.0]"));
        place.run(&[&robot, "jerk.toml"], &format!("--output m.json {options}")).exits(0);
        let result = place.json("m.json");
        let times: Vec<f64> = result["trajectory"]["time"].as_array().unwrap().iter().map(number).collect();
        let sums: Vec<f64> = rows(&result, "acceleration").iter().map(|[a, b]| a + b).collect();
        let firsts: Vec<f64> = rows(&result, "acceleration").iter().map(|[a, _]| *a).collect();
        let greatest = |values: &[f64]| {
            let steps = times.windows(2).zip(values.windows(2)).filter(|(t, _)| t[1] - t[0] > 1e-6);
            steps.map(|(t, a)| ((a[1] - a[0]) / (t[1] - t[0])).abs()).fold(0.0, f64::max)
        };
        let [sum, first] = [greatest(&sums), greatest(&firsts)];
        assert!(sum <= most * (1.0 + 1e-3) && first <= 60.0 * (1.0 + 1e-3), "{name}: {sum} {first}");
        assert!(sum >= 0.8 * most || first >= 48.0, "{name}: {sum} {first}");
        place.run(&["verify", &robot, "jerk.toml", "m.json"], "").exits(0);
        place.write("less.toml", with(&format!("jerk = [60.0, {}]", 0.8 * sum)));
        let verified = place.run(&["verify", &robot, "less.toml", "m.json"], "").exits(3);
        verified.says(&["elbow motor: jerk"]);
    }
}

/// With the elbow's motor on the link, limits of motors are those of the joints: both descriptions give the same motion.
#[test]
fn direct_motors_equal_joints() {
    let place = Place::new();
    let motion = |robot: &str, world: &str| {
        place.write("world.toml", world);
        let done = place.run(&[robot, "world.toml"], "--json").exits(0);
        let result = done.json();
        (result["path"].clone(), result["trajectory"]["position"].clone(), result["trajectory"]["time"].clone())
    };
    let robot = shipped("robots/rrbot_vertical.urdf");
    let world = read(shipped("workspaces/upright.toml"));
    assert!(world.contains("effort = { shoulder = 36, elbow = 12 }"), "{world}");
    let motors = "drives = { elbow = \"link\", gear = [2.0, -4.0], motors = { effort = [18, 3] } }\neffort = { shoulder = 99, elbow = 99 }";
    assert_eq!(
        motion(&robot, &world),
        motion(&robot, &world.replace("effort = { shoulder = 36, elbow = 12 }", motors))
    );
    let robot = shipped("robots/planar_2r.urdf");
    let world =
        |keys: &str| read(shipped("workspaces/shelf.toml")).replace("[start]", &format!("[robot]\n{keys}\n[start]"));
    let joints = world("jerk = { shoulder = 50, elbow = 80 }");
    let motors = world("drives = { elbow = \"link\", gear = [2.0, -0.5], motors = { jerk = [100, 40] } }");
    assert_eq!(motion(&robot, &joints), motion(&robot, &motors));
}

/// Among no obstacles, the lengths in motor angles and in time are closed forms, and so are the bounds.
#[test]
fn lengths_and_times_count_the_motors() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    for (k, ratio) in [1.0, -1.5, 0.5, 2.0].into_iter().enumerate() {
        let (d1, d2) = ([0.9, -1.2, 0.4, 1.1][k], [0.7, 1.0, -1.3, 0.8][k]);
        let drives = format!("ratio = {ratio:?}, motors = {{ velocity = [1.5, 0.8], acceleration = [8.0, 5.0] }}");
        let world = format!(
            "[robot]\ndrives = {{ {drives} }}\n[start]\njoints = [0.1, 0.2]\n[goal]\njoints = [{}, {}]\n",
            0.1 + d1,
            0.2 + d2
        );
        place.write("world.toml", &world);
        let sum: f64 = ratio * d1 + d2;
        let at_top_speed = f64::max(d1.abs() / 1.5, d2.abs() / 3.0).max(sum.abs() / 0.8);
        for (metric, length) in [("motor", f64::hypot(d1, sum)), ("time", at_top_speed)] {
            let options = format!("--metric {metric} --certificate c.json --json");
            let result = place.run(&[&robot, "world.toml"], &options).exits(0).json();
            let optimum = &result["optimum"];
            let [found, bound] = ["length", "lower_bound"].map(|key| number(&optimum[key]));
            assert_eq!(optimum["metric"], metric);
            assert!((found - length).abs() < 1e-9 && bound <= length && bound > 0.999 * length, "{ratio}: {optimum}");
            let certificate = place.json("c.json");
            let report = check(&read(&robot), &world, &certificate.to_string()).unwrap();
            assert!(report.contains("is shorter than"), "{report}");
            // A greater length is refuted.
            let mut wrong = certificate.clone();
            wrong["bound"]["length"] = (1.001 * length).into();
            assert!(matches!(check(&read(&robot), &world, &wrong.to_string()), Err(CheckError::Fails(_))), "{ratio}");
        }
        // From rest to rest, no motion of the sum is faster than with its greatest speed and acceleration.
        let result = place.run(&[&robot, "world.toml"], "--optimize time --json").exits(0).json();
        let [duration, bound] = ["duration", "lower_bound"].map(|key| number(&result["fastest"][key]));
        let alone = |length: f64, speed: f64, acceleration: f64| match length.abs() >= speed * speed / acceleration {
            true => length.abs() / speed + speed / acceleration,
            false => 2.0 * (length.abs() / acceleration).sqrt(),
        };
        assert!(bound <= duration && bound > 0.8 * alone(sum, 0.8, 5.0), "{ratio}: {bound} {duration}");
    }
    let world = read(shipped("workspaces/shelf.toml"));
    place.write("world.toml", world);
    let refused = place.run(&[&robot, "world.toml"], "--metric motor");
    refused.refused(1, &["--metric motor needs two joints that turn, with motors", "[robot] drives"]);
}

/// Past the shelf, bounds in both metrics have certificates, and the paths are compared with those of other metrics.
#[test]
fn bounds_among_obstacles_count_the_motors() {
    let place = Place::new();
    let [robot, world] = files("belt_elbow_open");
    let mut lengths = Vec::new();
    for metric in ["motor", "euclidean", "time"] {
        place.run(&[&robot, &world], &format!("--metric {metric} --output m.json --certificate c.json")).exits(0);
        let result = place.json("m.json");
        let path = result["path"].as_array().unwrap();
        let motor = path.windows(2).map(|ends| {
            let d = [0, 1].map(|k| number(&ends[1][k]) - number(&ends[0][k]));
            d[0].hypot(d[0] + d[1])
        });
        lengths.push(motor.sum::<f64>());
        let report = check(&read(&robot), &read(&world), &place.read("c.json")).unwrap();
        assert!(report.contains("is shorter than"), "{metric}: {report}");
        place.run(&["verify", &robot, &world, "m.json"], "").exits(0);
    }
    assert!(lengths[0] <= lengths[1] + 1e-9 && lengths[0] <= lengths[2] + 1e-9, "{lengths:?}");
}

/// Templates get the angles of both shafts.
#[test]
fn templates_have_the_angles_of_the_shafts() {
    let place = Place::new();
    let [robot, world] = files("belt_elbow_open");
    let text =
        "{% for move in moves %}\n{{ move.joints | join(\" \") }} M {{ move.motors | join(\" \") }}\n{% endfor %}\n";
    place.write("own.j2", text);
    let geared = read(&world).replace("ratio = 1.0, ", "ratio = 1.0, gear = [2.0, -1.0], zero = [0.0, \"90deg\"], ");
    let geared =
        geared.replace("lower = [\"-150deg\", \"-50deg\"], upper = [\"150deg\", \"90deg\"]", "velocity = [4.0, 2.5]");
    place.write("world.toml", geared.replace("velocity = [4.0, 2.5], velocity = [2.0, 2.5]", "velocity = [4.0, 2.5]"));
    place.run(&[&robot, "world.toml"], "--template own.j2 --output own.txt").exits(0);
    let mut count = 0;
    for line in place.read("own.txt").lines() {
        let (joints, motors) = line.split_once(" M ").unwrap();
        let [q1, q2]: [f64; 2] = numbers(joints);
        let expected = [2.0 * q1, 90.0 - (q1 + q2)];
        for (angle, expected) in numbers(motors).into_iter().zip(expected) {
            assert!((angle - expected).abs() < 3e-4, "{line}");
        }
        count += 1;
    }
    assert!(count > 2, "{count}");
    // Without motors, there is nothing.
    place.write("none.j2", text.replace("move.motors | join(\" \")", "move.motors or 'none'"));
    place.run(&shelf(), "--template none.j2 --output own.txt").exits(0);
    assert!(place.read("own.txt").lines().all(|line| line.ends_with(" M none")));
}

fn numbers(list: &str) -> [f64; 2] {
    let values: Vec<f64> = list.split_whitespace().map(|value| value.parse().unwrap()).collect();
    values.try_into().unwrap()
}

/// The report on a robot has the joint values that the motors leave, compared with all pairs of a fine grid.
#[test]
fn the_report_states_what_the_motors_leave() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    for (ratio, least, most) in [(1.0, -1.0, 0.5), (-2.0, -2.0, 7.0), (0.5, 3.5, 4.0)] {
        let limits = format!("lower = [-1e3, {least:?}], upper = [1e3, {most:?}], velocity = [4.0, 2.5]");
        let drives = format!("[robot]\ndrives = {{ ratio = {ratio:?}, motors = {{ {limits} }} }}\n");
        place.write("world.toml", drives + FREE);
        let report = place.run(&["inspect", &robot, "world.toml"], "--json").exits(0).json();
        let grid = |k: i32| -2.9 + 5.8 * f64::from(k) / 1000.0;
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for (i, j) in (0..=1000).flat_map(|i| (0..=1000).map(move |j| (i, j))) {
            let q = [grid(i), grid(j)];
            if (least..=most).contains(&(ratio * q[0] + q[1])) {
                ranges = [0, 1].map(|k| [ranges[k][0].min(q[k]), ranges[k][1].max(q[k])]);
            }
        }
        for (k, range) in ranges.into_iter().enumerate() {
            let stated = [0, 1].map(|end| number(&report["motors"]["ranges"][k][end]));
            assert!((0..2).all(|end| (stated[end] - range[end]).abs() < 0.012), "{ratio} {k}: {stated:?} {range:?}");
        }
        let told = place.run(&["inspect", &robot, "world.toml"], "").exits(0);
        told.says(&["motors", "shoulder + elbow", "top speed 2.5 rad/s"]);
        let narrows = ranges.iter().any(|range| range[0] > -2.88 || range[1] < 2.88);
        assert_eq!(told.stdout.contains("they leave"), narrows, "{}", told.stdout);
    }
    let plain = place.run(&["inspect", &robot], "--json").exits(0).json();
    assert!(plain["motors"].is_null());
}
