//! Tools that a wrist turns along lines, from outside: motions against the tests' own kinematics, files and errors.

use super::*;
use std::f64::consts::{PI, TAU};

/// The pieces of `gasket.gcode`, metres: two points of a line, or centre, radius and both angles of an arc.
enum Piece {
    Line([f64; 2], [f64; 2]),
    Arc([f64; 2], f64, [f64; 2]),
}

const GASKET: [Piece; 7] = [
    Piece::Line([0.28, -0.06], [0.37, -0.06]),
    Piece::Arc([0.37, -0.04], 0.02, [-PI / 2.0, 0.0]),
    Piece::Line([0.39, -0.04], [0.39, 0.04]),
    Piece::Arc([0.37, 0.04], 0.02, [0.0, PI / 2.0]),
    Piece::Line([0.37, 0.06], [0.28, 0.06]),
    Piece::Line([0.28, 0.06], [0.28, -0.06]),
    Piece::Arc([0.335, 0.0], 0.025, [0.0, TAU]),
];

/// The corners at which the tool turns at rest.
const CORNERS: [[f64; 2]; 2] = [[0.28, 0.06], [0.28, -0.06]];

/// Returns distance and direction of a piece at its point nearest to the tip.
fn nearest(piece: &Piece, [x, y]: [f64; 2]) -> (f64, f64) {
    match *piece {
        Piece::Line(a, b) => {
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0].hypot(along[1]);
            let share = (((x - a[0]) * along[0] + (y - a[1]) * along[1]) / length / length).clamp(0.0, 1.0);
            let off = (x - a[0] - share * along[0]).hypot(y - a[1] - share * along[1]);
            (off, along[1].atan2(along[0]))
        }
        Piece::Arc(center, radius, [from, to]) => {
            let away = [x - center[0], y - center[1]];
            let turned = (away[1].atan2(away[0]) - from).rem_euclid(TAU);
            let angle = if turned <= to - from { from + turned } else { f64::NAN };
            ((away[0].hypot(away[1]) - radius).abs() + if angle.is_nan() { 1.0 } else { 0.0 }, angle + PI / 2.0)
        }
    }
}

/// Returns the position of the tip of `scara`.
fn tip([a, b]: [f64; 2]) -> [f64; 2] {
    [0.3 * a.cos() + 0.25 * (a + b).cos(), 0.3 * a.sin() + 0.25 * (a + b).sin()]
}

fn between(angle: f64, other: f64) -> f64 {
    ((angle - other + PI).rem_euclid(TAU) - PI).abs()
}

fn follow(place: &Place, options: &str) -> Done {
    let files = ["robots/scara.urdf", "workspaces/follow/cutting.toml", "workspaces/follow/gasket.gcode"].map(shipped);
    place.run(&["follow", &files[0], &files[1], &files[2]], options)
}

/// Reads a table: for each row, time, the three joints and their velocities.
fn rows(csv: &str, columns: [&str; 7]) -> Vec<[f64; 7]> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let index = columns.map(|name| names.iter().position(|other| *other == name).unwrap());
    let row = |line: &str| {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        index.map(|k| fields[k])
    };
    lines.map(row).collect()
}

const COLUMNS: [&str; 7] =
    ["time", "axis_1", "axis_2", "axis_4", "axis_1_velocity", "axis_2_velocity", "axis_4_velocity"];

/// Plays the rows by cubics. Returns joint values, and whether the arm rests.
fn played(rows: &[[f64; 7]]) -> Vec<([f64; 3], bool)> {
    let state = |pair: &[[f64; 7]], u: f64| {
        let [a, b] = [pair[0], pair[1]];
        let h = b[0] - a[0];
        let [p, q] = [(1.0 + 2.0 * u) * (1.0 - u).powi(2), u * u * (3.0 - 2.0 * u)];
        let [v, w] = [u * (1.0 - u).powi(2) * h, u * u * (u - 1.0) * h];
        let values = [1, 2, 3].map(|k| p * a[k] + q * b[k] + v * a[k + 3] + w * b[k + 3]);
        (values, a[1..3] == b[1..3])
    };
    rows.windows(2).flat_map(|pair| (0..8).map(move |k| state(pair, f64::from(k) / 8.0))).collect()
}

#[test]
fn a_knife_turns_along_the_outline() {
    let place = Place::new();
    let done =
        follow(&place, "--wrist tangent+0.2 --output m.csv --output m.yaml --output m.json --picture m.html").exits(0);
    assert!(done.stdout.contains("joint \"axis_4\" keeps the tool at 0.2 rad to the line, within 0.0"));
    assert!(!done.stdout.contains("\"axis_4\" is held"), "{}", done.stdout);
    let rows = rows(&place.read("m.csv"), COLUMNS);
    assert!(rows.iter().all(|row| row[6].abs() <= 20.0 * (1.0 + 1e-9)), "too fast");
    let (mut on_line, mut at_rest) = (0, 0);
    for ([a, b, c], rests) in played(&rows) {
        let tip = tip([a, b]);
        let angle = a + b + c - 0.2;
        let near = GASKET.iter().map(|piece| nearest(piece, tip)).filter(|(off, _)| *off < 3e-5);
        let least = near.map(|(_, heading)| between(angle, heading)).fold(f64::INFINITY, f64::min);
        let is_corner = CORNERS.iter().any(|corner| (tip[0] - corner[0]).hypot(tip[1] - corner[1]) < 1e-6);
        // The travel leads from the last corner straight to the hole.
        let travel = nearest(&Piece::Line([0.28, -0.06], [0.36, 0.0]), tip).0 < 3e-5;
        on_line += usize::from(least <= 0.0101);
        at_rest += usize::from(rests && is_corner);
        assert!(least <= 0.0101 || (rests && is_corner) || travel, "{tip:?} {angle} {least}");
    }
    assert!(on_line > 10_000 && at_rest > 0, "{on_line} {at_rest}");
    let result = place.json("m.json");
    assert_eq!((&result["wrist"]["joint"], number(&result["wrist"]["tangent"])), (&"axis_4".into(), 0.2));
    assert!(number(&result["wrist"]["deviation"]) <= number(&result["wrist"]["tolerance"]));
    let positions = result["trajectory"]["wrist"]["position"].as_array().unwrap();
    assert!(positions.len() == rows.len() && positions.iter().zip(&rows).all(|(w, row)| number(w) == row[3]));
    assert!(place.read("m.yaml").contains(&format!("{:?}]", rows[100][3])), "the wrist's values");
}

/// Tests the written table alone: on straight cuts at constant speed, no joint reaches its greatest acceleration, and an
/// acceleration changes its sign once per cut at most.
#[test]
fn accelerations_on_straight_cuts_are_those_of_the_line() {
    let place = Place::new();
    follow(&place, "--wrist tangent --output m.csv").exits(0);
    let rows = rows(&place.read("m.csv"), COLUMNS);
    // The limits that cplan assumes: the top speed in a quarter of a second.
    let limits = [28.972, 46.008, 200.0];
    let speed = |row: &[f64; 7]| {
        let ([a, b], [v, w]) = ([row[1], row[1] + row[2]], [row[4], row[4] + row[5]]);
        let across = [0.3 * v * a.sin() + 0.25 * w * b.sin(), 0.3 * v * a.cos() + 0.25 * w * b.cos()];
        across[0].hypot(across[1])
    };
    let (mut time, mut changes, mut cuts) = (0.0, 0, 0);
    let mut signs = [0.0_f64; 3];
    let mut is_in_cut = false;
    for pair in rows.windows(2) {
        let h = pair[1][0] - pair[0][0];
        let is_straight = |row: &[f64; 7]| {
            let lines = GASKET.iter().filter(|piece| matches!(piece, Piece::Line(..)));
            lines.map(|piece| nearest(piece, tip([row[1], row[2]])).0).fold(f64::INFINITY, f64::min) < 1e-8
        };
        if !pair.iter().all(|row| is_straight(row) && (speed(row) - 0.2).abs() < 5e-4) {
            is_in_cut = false;
            continue;
        }
        cuts += usize::from(!is_in_cut);
        signs = if is_in_cut { signs } else { [0.0; 3] };
        (is_in_cut, time) = (true, time + h);
        for k in 0..3 {
            let rate = (pair[1][k + 1] - pair[0][k + 1]) / h;
            let [first, last] = [pair[0][k + 4], pair[1][k + 4]];
            for gain in [(6.0 * rate - 4.0 * first - 2.0 * last) / h, (2.0 * first + 4.0 * last - 6.0 * rate) / h] {
                // The line bends the joints far less than their limits allow.
                assert!(gain.abs() < 0.3 * limits[k], "joint {k} accelerates by {gain} at {}", pair[0][0]);
                if gain.abs() > 1e-3 * limits[k] {
                    changes += usize::from(gain * signs[k] < 0.0);
                    signs[k] = gain;
                }
            }
        }
    }
    // 0.38 m at 0.2 m/s, without the ramps.
    assert!(cuts == 4 && (1.7..1.9).contains(&time), "{cuts} cuts in {time} s");
    assert!(changes <= 3 * cuts, "{changes} changes of signs");
}

/// The angle counts from the x axis of the world to the x axis of the tip's frame, however robot and wrist are mounted.
#[test]
fn a_fixed_angle_counts_in_the_world() {
    let place = Place::new();
    let urdf = read(shipped("robots/scara.urdf"));
    let mounted = urdf.replace(
        "<child link=\"flange\"/>\n    <origin xyz=\"0 0 0\"/>\n    <axis xyz=\"0 0 1\"/>",
        "<child link=\"flange\"/>\n    <origin xyz=\"0 0 0\" rpy=\"0 0 0.3\"/>\n    <axis xyz=\"0 0 -1\"/>",
    );
    assert_ne!(urdf, mounted);
    place.write("robot.urdf", &mounted);
    place.write(
        "world.toml",
        "[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\nat = [0.1, 0.2]\nangle = 0.5\n\
         fixed = { axis_3 = -0.1, axis_4 = 0.25 }\nwrist = { joint = \"axis_4\", velocity = 9 }\n",
    );
    place.write(
        "line.toml",
        "points = [[0.4, 0.3], [0.4, 0.5], [0.3, 0.55]]\nwrist = \"40deg\"\nwrist_tolerance = 1e-5\n",
    );
    for (options, angle) in [("", 40_f64.to_radians()), ("--wrist -1.5 --wrist-tolerance 0.001", -1.5)] {
        let done = place
            .run(&["follow", "robot.urdf", "world.toml", "line.toml"], &format!("{options} --output m.csv"))
            .exits(0);
        done.says(&["joint \"axis_4\" keeps the tool at", "wrist: no acceleration limit given; 36 rad/s2 assumed"]);
        for ([a, b, c], _) in played(&rows(&place.read("m.csv"), COLUMNS)) {
            assert!(between(0.5 + a + b + 0.3 - c, angle) < 1e-9);
        }
    }
}

#[test]
fn errors_name_the_wrist() {
    let place = Place::new();
    let world = |wrist: &str| {
        format!("[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\nfixed = {{ axis_3 = -0.1 }}\n{wrist}\n")
    };
    let line = "points = [[0.4, 0.0], [0.4, 0.1]]\n";
    let named = "wrist = { joint = \"axis_4\", velocity = 9, acceleration = 90 }";
    for (wrist, line, options, parts) in [
        ("", line, "--wrist tangent", ["does not name the wrist's joint", "hint: [robot] wrist = { joint = "]),
        ("wrist = { velocity = 9 }", line, "--wrist 0.5", ["does not name the wrist's joint", "joint"]),
        (
            "wrist = { joint = \"axis_4\", velocity = 9, jerk = 900 }",
            line,
            "--wrist tangent",
            ["limits on the wrist's jerk cannot be kept", "hint: remove the wrist's `jerk`"],
        ),
        (named, line, "--wrist-tolerance 0.01", ["--wrist-tolerance needs an angle", "--wrist"]),
        (named, line, "--wrist tangents", ["signed angle", "tangent+90deg"]),
        (named, line, "--wrist along", ["must be an angle", "tangent"]),
        (named, line, "--wrist inf", ["must be an angle", "tangent"]),
        (named, line, "--wrist 0 --wrist-tolerance 2", ["must be a number of radians", "1"]),
        (named, &format!("{line}wrist = \"along\""), "", ["line 2, column 9", "found \"along\""]),
        (named, &format!("{line}wrist = inf"), "", ["wrist: inf is not a finite number", "hint: "]),
        (named, &format!("{line}wrist = {{ tangents = 1 }}"), "", ["unknown key `tangents`", "hint: "]),
        (named, &format!("{line}wrist = {{ tangent = nan }}"), "", ["wrist, tangent: NaN is not", "hint: "]),
        (named, &format!("{line}wrist_tolerance = 0.1"), "", ["only a line with a `wrist`", "hint: "]),
        (named, &format!("{line}wrist = 1\nwrist_tolerance = 0"), "", ["wrist_tolerance must be from", "hint: "]),
        (
            &format!("{named}\njerk = {{ axis_1 = 100, axis_2 = 100 }}"),
            line,
            "--wrist tangent",
            ["jerks are limited", "a fixed angle"],
        ),
    ] {
        place.write("world.toml", world(wrist));
        place.write("line.toml", line);
        let done = place.run(&["follow", &shipped("robots/scara.urdf"), "world.toml", "line.toml"], options);
        assert!(matches!(done.code, 1 | 2), "{options} {line}: {} {}", done.code, done.stdout);
        parts.iter().for_each(|part| assert!(done.stderr.contains(part), "{options} {line}: {}", done.stderr));
    }
    // A gantry has no wrist.
    place.write("line.toml", line);
    let gantry = [shipped("robots/gantry.urdf"), shipped("workspaces/annulus_open.toml")];
    let done = place.run(&["follow", &gantry[0], &gantry[1], "line.toml"], "--wrist tangent").exits(1);
    done.warns(&["does not name the wrist's joint"]);
}

#[test]
fn a_joint_that_cannot_turn_as_far_makes_the_line_infeasible() {
    let place = Place::new();
    let world = read(shipped("workspaces/follow/cutting.toml"));
    place.write("world.toml", world.replace("fixed = {", "limits = { axis_4 = [-3.5, 3.5] }\nfixed = {"));
    place.write("circle.gcode", "G21 G0 X360 Y0\nG3 I-25 F6000\nG3 I-25\n");
    let arguments = ["follow", &shipped("robots/scara.urdf"), "world.toml", "circle.gcode"];
    let done = place.run(&arguments, "--wrist tangent --certificate c.json").exits(3);
    done.says(&["the wrist cannot turn far enough for the tool's angle"]);
    done.warns(&["certificates of lines do not cover the wrist"]);
    // Without the tool's angle, the line can be followed.
    place.run(&arguments, "").exits(0);
}

/// Returns a task with a line for the tool, and other steps around it.
fn task(lines: &str) -> String {
    format!(
        "[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\npayload = \"level\"\nfixed = {{ axis_3 = -0.05 }}\n\
         stroke = {{ joint = \"axis_3\", travel = 0.05 }}\n\
         wrist = {{ joint = \"axis_4\", velocity = 20.0, acceleration = 200.0 }}\n[start]\njoints = [-0.9, 1.6]\n\
         [[object]]\nname = \"part\"\ncircle = {{ center = [0.0, 0.0], radius = 0.02 }}\nheight = [0.0, 0.002]\n\
         at = [0.1, -0.3]\nlift = 0.05\n{lines}"
    )
}

const PICK: &str = "[[step]]\npick = \"part\"\n";
const PLACE: &str = "[[step]]\nplace = { at = [0.2, -0.3], angle = 1.0 }\n";

#[test]
fn steps_of_tasks_turn_the_tool_and_verify_judges_it() {
    let place = Place::new();
    let lines = "[[step]]\nfollow = { points = [[0.3, 0.0], [0.4, 0.0], [0.4, 0.15]], speed = 0.3, wrist = { tangent = 0.3 } }\n\
                 [[step]]\nfollow = { arc = [[0.3, 0.1], [0.25, 0.15], [0.2, 0.1]], wrist = \"30deg\" }\n\
                 [[step]]\nmove = { joints = [-0.9, 1.6] }\n";
    place.write("world.toml", task(&format!("{PICK}{PLACE}{lines}")));
    let robot = shipped("robots/scara.urdf");
    place.run(&["plan", &robot, "world.toml"], "--output m.json --output m.csv").exits(0);
    // The wrist's value is continuous over the whole task, and never too fast.
    let rows = rows(&place.read("m.csv"), COLUMNS);
    for pair in rows.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        assert!((b[3] - a[3]).abs() <= 20.0 * (1.0 + 1e-6) * (b[0] - a[0]) + 1e-12, "{a:?} {b:?}");
        assert!(b[6].abs() <= 20.0 * (1.0 + 1e-6), "{b:?}");
        assert!((b[6] - a[6]).abs() <= 200.0 * (1.0 + 1e-4) * (b[0] - a[0]) + 1e-9, "{a:?} {b:?}");
    }
    // On the second line, the tool is at 30 degrees.
    let result = place.json("m.json");
    let steps = result["steps"].as_array().unwrap();
    let line = steps.iter().rfind(|step| step["action"] == "follow").unwrap();
    let [begin, end] = ["begin", "arrival"].map(|key| number(&line[key]));
    let moves = |row: &&[f64; 7]| (begin..=end).contains(&row[0]) && row[4..6] != [0.0, 0.0];
    let moving: Vec<_> = rows.iter().filter(moves).collect();
    assert!(moving.len() > 50, "{}", moving.len());
    assert!(moving.iter().all(|row| between(row[1] + row[2] + row[3], 30_f64.to_radians()) < 1e-9));
    let verify = |result: &Value| {
        place.write("changed.json", result.to_string());
        place.run(&["verify", &robot, "world.toml", "changed.json"], "")
    };
    verify(&result).exits(0).says(&["free: the whole task"]);
    // Faults of the wrist are found.
    let index = steps.iter().position(|step| step["action"] == "follow").unwrap();
    let count = steps[index]["wrist_motion"]["position"].as_array().unwrap().len();
    type Change = fn(&mut Value, usize);
    let changes: [(Change, &str); 6] = [
        (
            |wrist, k| wrist["position"][k / 2] = (wrist["position"][k / 2].as_f64().unwrap() + 0.05).into(),
            "the angle of the tool may be wrong by",
        ),
        (|wrist, k| wrist["velocity"][k / 2] = 30.0.into(), "exceeds its top speed"),
        (|wrist, k| wrist["acceleration"][k / 2] = 300.0.into(), "exceeds its greatest acceleration"),
        (|wrist, _| wrist["velocity"][0] = 1.0.into(), "rest at both ends"),
        (
            |wrist, _| {
                let turned = |w: &Value| Value::from(w.as_f64().unwrap() + 4.0 * TAU);
                wrist["position"] = wrist["position"].as_array().unwrap().iter().map(turned).collect();
            },
            "exceeds its range",
        ),
        (|wrist, _| *wrist = Value::Null, "does not state the motion of the wrist"),
    ];
    for (change, message) in changes {
        let mut changed = result.clone();
        change(&mut changed["steps"][index]["wrist_motion"], count);
        let done = verify(&changed);
        assert!(done.code != 0 && done.stdout.contains(message), "{message}: {}", done.stdout);
    }
    let mut changed = result.clone();
    changed["steps"][index]["wrist_motion"]["position"].as_array_mut().unwrap().pop();
    verify(&changed).exits(1).warns(&["wrist_motion has"]);
}

#[test]
fn a_payload_must_not_be_turned_along_a_line() {
    let place = Place::new();
    let line = |wrist: &str| format!("[[step]]\nfollow = {{ points = [[0.3, 0.0], [0.4, 0.0]], wrist = {wrist} }}\n");
    let plan = |text: &str| {
        place.write("world.toml", text);
        place.run(&["plan", &shipped("robots/scara.urdf"), "world.toml"], "--quiet")
    };
    let end = "[[step]]\nplace = { at = [0.2, -0.3] }\n";
    let turned = "[[step]]\nplace = { at = [0.2, -0.3], angle = 1 }\n";
    let tangent = task(&format!("{PICK}{}{end}", line("\"tangent\"")));
    let rigid = tangent.replace("payload = \"level\"", "payload = \"rigid\"");
    for (text, message) in [
        (tangent.clone(), "step 3: object \"part\" is carried level, so the tool cannot turn"),
        (rigid, "object \"part\" is held rigidly, so the wrist must not turn it"),
        (task(&format!("{PICK}{}{end}", line("0.5"))), "carried level at 0 rad, but the line requires 0.5 rad"),
        (task(&format!("{PICK}{}{turned}", line("0"))), "is turned to 1 rad, but step 3 keeps it"),
        (tangent.replace("joint = \"axis_4\", ", ""), "does not name the wrist's joint"),
        (tangent.replace("acceleration = 200.0 }", "jerk = 900.0 }"), "limits on the wrist's jerk cannot be kept"),
    ] {
        plan(&text).exits(1).warns(&[message]);
    }
    // A level object keeps its angle anyway.
    plan(&task(&format!("{PICK}{}{end}", line("0")))).exits(0);
}
