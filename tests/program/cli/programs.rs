//! Programs for controllers: the shipped templates, templates of users, and the certificate of the written digits.
//!
//! The readers of programs, the kinematics and the distances here share no code with cplan.

use super::controller_languages::{Statement, numbers, read_rapid, read_spel, targets};
use super::*;
use cplan_cases::plane::polygon_distance;

/// Runs cplan for a world in the place's folder or of the repository.
fn program(place: &Place, robot: &str, world: &str, options: &str) -> super::Done {
    place.run(&[shipped(&format!("robots/{robot}.urdf")), world.to_owned()], options)
}

/// Tip of the SCARA, metres, for joint values in degrees.
fn scara_tip(values: &[f64]) -> [f64; 2] {
    let (first, second) = (values[0].to_radians(), (values[0] + values[1]).to_radians());
    [0.3 * first.cos() + 0.25 * second.cos(), 0.3 * first.sin() + 0.25 * second.sin()]
}

/// Checks that a point is one of `places`, and removes that one.
#[track_caller]
fn take(places: &mut Vec<[f64; 2]>, tip: [f64; 2]) {
    let off = |place: &[f64; 2]| (place[0] - tip[0]).hypot(place[1] - tip[1]);
    let nearest = (0..places.len()).min_by(|a, b| off(&places[*a]).total_cmp(&off(&places[*b]))).expect("a free place");
    assert!(off(&places[nearest]) < 2e-5, "{tip:?} is {} m from {:?}", off(&places[nearest]), places[nearest]);
    places.remove(nearest);
}

#[test]
fn a_kit_is_filled_by_lifting_travelling_and_lowering() {
    let place = Place::new();
    let options = "--template epson --output kit.prg";
    let done = program(&place, "scara", &shipped("workspaces/tasks/kitting_cell.toml"), options).exits(0);
    done.says(&["program    ", "certified: straight moves in joint space"]);
    let text = place.read("kit.prg");
    has(
        &text,
        &["' kitting cell: scara", "keep 0.0", "within a tolerance of 0.05 deg, 0.05 mm", "SHA-256", "not certified"],
    );
    let column = |x: f64, y: f64| (0..4).map(move |row| [x, y + 0.05 * f64::from(row)]);
    let mut feeders: Vec<[f64; 2]> = [0.14, 0.20, 0.26].into_iter().flat_map(|x| column(x, 0.26)).collect();
    let mut slots: Vec<[f64; 2]> = [0.28, 0.35, 0.42].into_iter().flat_map(|x| column(x, -0.22)).collect();
    let mut at = vec![0.0, 1.2_f64.to_degrees(), 0.0, 0.0];
    let (mut carried, mut waits, mut is_first) = (None::<f64>, 0, true);
    for statement in read_spel(&text) {
        match statement {
            Statement::Move(to) => {
                let travels = (to[0] - at[0]).abs() + (to[1] - at[1]).abs() > 1e-3;
                let strokes = (to[2] - at[2]).abs() > 1e-3;
                assert!(is_first || travels != strokes, "{at:?} to {to:?}");
                assert!(!travels || (to[2], at[2]) == (0.0, 0.0), "the quill is raised while the arm moves: {to:?}");
                let angle = to[0] + to[1] + to[3];
                assert!(carried.is_none_or(|carried| (carried - angle).abs() < 2e-4), "the part turns: {to:?}");
                (at, is_first) = (to, false);
            }
            Statement::Grip(closes) => {
                assert_eq!((at[2], carried.is_some()), (-150.0, !closes));
                take(if closes { &mut feeders } else { &mut slots }, scara_tip(&at));
                carried = closes.then(|| at[0] + at[1] + at[3]);
            }
            Statement::Wait(seconds) => {
                assert_eq!(seconds, 0.15);
                waits += 1;
            }
            Statement::Speed(percent) => assert_eq!(percent, 100.0),
            Statement::SetSignal(_) | Statement::WaitForSignal(_) => panic!("there is no other arm"),
        }
    }
    assert_eq!((feeders.len(), slots.len(), waits), (0, 0, 24));
}

/// Corners of a link's box: its left end is at `from`, and its axis points in the direction `angle`.
fn link(from: [f64; 2], angle: f64, length: f64) -> Vec<[f64; 2]> {
    let (c, s) = (angle.cos(), angle.sin());
    let corners = [[0.0, -0.05], [length, -0.05], [length, 0.05], [0.0, 0.05]];
    corners.iter().map(|[x, y]| [from[0] + c * x - s * y, from[1] + s * x + c * y]).collect()
}

#[test]
fn the_clearance_holds_for_all_motions_within_the_tolerance() {
    let place = Place::new();
    let shelf = shipped("workspaces/shelf.toml");
    let options = "--clearance 0.004 --template rapid --joint-tolerance 0.1deg --output shelf.mod";
    program(&place, "planar_2r", &shelf, options).exits(0);
    let obstacles = [
        vec![[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]],
        vec![[0.5, -1.6], [0.8, -1.6], [0.8, -1.3], [0.5, -1.3]],
    ];
    let targets = targets(&read_rapid(&place.read("shelf.mod")));
    let ends = [&targets[0], &targets[targets.len() - 1]].map(|q| [q[0].to_radians(), q[1].to_radians()]);
    for (is, asked) in ends.iter().flatten().zip([-0.9, 0.4, 1.55, -0.35]) {
        assert!((is - asked).abs() < 1e-6, "{is} instead of {asked}");
    }
    let mut least = f64::INFINITY;
    for line in targets.windows(2) {
        for k in 0..=400 {
            let t = f64::from(k) / 400.0;
            for off in [[0.0, 0.0], [0.1, 0.1], [0.1, -0.1], [-0.1, 0.1], [-0.1, -0.1]] {
                let [first, second] =
                    [0, 1].map(|j| (line[0][j] + t * (line[1][j] - line[0][j]) + off[j]).to_radians());
                let elbow = [first.cos(), first.sin()];
                let links = [link([0.0, 0.0], first, 1.0), link(elbow, first + second, 0.8)];
                for (link, obstacle) in links.iter().flat_map(|link| obstacles.iter().map(move |one| (link, one))) {
                    least = least.min(polygon_distance(link, obstacle));
                }
            }
        }
    }
    assert!(least >= 0.004, "a motion within the tolerance comes as near as {least} m");
    assert!(least < 0.009, "the tolerance costs too much: {least} m");
}

#[test]
fn a_list_has_degrees_and_millimetres_of_all_joints() {
    let place = Place::new();
    let options = "--template list --output box.txt --output box.json";
    program(&place, "scara", &shipped("workspaces/arch/into_the_box.toml"), options).exits(0);
    let text = place.read("box.txt");
    let mut rows = text.lines().filter(|line| !line.starts_with('#'));
    let head = "target,step,kind,axis_1 [deg],axis_2 [deg],axis_3 [mm],axis_4 [deg],grip,dwell [s]";
    assert_eq!(rows.next(), Some(head));
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    let kinds: Vec<&str> = rows.iter().map(|row| row[2]).collect();
    let travels = kinds.iter().filter(|kind| **kind == "travel").count();
    assert_eq!([&["start", "raise"], &vec!["travel"; travels][..], &["lower"]].concat(), kinds);
    let values = |row: &[&str]| row[3..7].iter().map(|value| value.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let (first, last) = (values(&rows[0]), values(&rows[rows.len() - 1]));
    assert_eq!(first, [-57.2958, -51.5662, -150.0, 0.0]);
    assert_eq!(last[2..], [-150.0, 90.0]);
    let [x, y] = scara_tip(&last);
    assert!((x + 0.27).hypot(y - 0.24) < 2e-6, "({x}, {y})");
    // `verify` judges the heights and angles of each moment from the table alone.
    let box_world = shipped("workspaces/arch/into_the_box.toml");
    let verified = place.run(&["verify", &shipped("robots/scara.urdf"), &box_world, "box.txt"], "").exits(0);
    verified.says(&["free by 10 mm: the whole motion, proven"]);
    // All of the program's waypoints are those of the plan, whose other files have the same motion.
    let plan: serde_json::Value = place.json("box.json");
    let path = plan["steps"][0]["path"].as_array().unwrap();
    for (row, waypoint) in rows[1..].iter().zip(path) {
        for (is, planned) in values(row).iter().zip(waypoint.as_array().unwrap()) {
            assert!((is - planned.as_f64().unwrap().to_degrees()).abs() < 1e-4, "{row:?}, {waypoint}");
        }
    }
}

#[test]
fn a_wrist_that_the_program_cannot_turn_is_stated() {
    let place = Place::new();
    let text = |world: &str, robot: &str| {
        program(&place, robot, &shipped(world), "--template list --output a.txt").exits(0);
        place.read("a.txt")
    };
    let statement = "# The program does not turn the wrist. The controller must keep the orientation of objects.";
    assert!(text("workspaces/tasks/slot_level.toml", "scara").contains(statement));
    assert!(!text("workspaces/tasks/kitting_cell.toml", "scara").contains(statement));
}

#[test]
fn signs_zeros_and_units_are_those_of_the_template() {
    let place = Place::new();
    let template = "{% for move in moves %}{{ move.joint.axis_1 | negated | plus(90) | digits(3) }} {{ move.joint.axis_2.urdf }} \
                    {{ move.joints[2] | plus(-5) | negated }}\n{% endfor %}";
    place.write("own.j2", template);
    let world = shipped("workspaces/scara_cell.toml");
    let run = |options: &str| assert_eq!(program(&place, "scara", &world, options).code, 0);
    run("--template own.j2 --output own.txt");
    run("--template epson --output cell.prg");
    let own = place.read("own.txt");
    let written = own.lines().map(|line| numbers(&line.replace(' ', ",")));
    let plain = targets(&read_spel(&place.read("cell.prg")));
    assert_eq!(written.clone().count(), plain.len());
    for (own, plain) in written.zip(plain) {
        assert!((own[0] - (90.0 - plain[0])).abs() < 1e-3, "{own:?}, {plain:?}");
        assert!((own[1].to_degrees() - plain[1]).abs() < 1e-3, "{own:?}, {plain:?}");
        assert_eq!(own[2], 155.0);
    }
}

#[test]
fn the_written_text_is_certified_and_not_the_plan() {
    let place = Place::new();
    let world = shipped("workspaces/shelf.toml");
    let all = |one: &str| format!("% a program\n{{% for move in moves %}}\n{one}\n{{% endfor %}}\n");
    let joints = "{{ move.joints | join(\", \") }}";
    let cases = [
        (all("{{ move.joints[0] | digits(1) }}, {{ move.joints[1] }}"), "\"shoulder\" of target 1 (step 1, "),
        (all("{{ move.joints[0] }}"), "does not write joint \"elbow\" of target 1 (step 1"),
        (all(&format!("{joints} {joints}")), "writes joint \"shoulder\" of target 1 (step 1, move to the goal) twice"),
        (all("{{ move.joints | join(\", \") | replace(\".\", \",\") }}"), "is not a number"),
        (all(joints).replace("in moves", "in moves | reverse"), "too early"),
        (all(joints).replace("in moves", "in moves[:3]"), "does not write target 4"),
        (all(joints).replace("in moves", "in moves[1:]"), "does not write joint \"shoulder\" of target 1"),
        (all(&format!("{{% if move.kind == \"start\" %}}{joints}{{% endif %}}")), "does not write target 2"),
        (all("{{ (move.joints | join(\", \"))[:9] }}"), "writes only a part of a joint value"),
        (all(&format!("\u{e001}{joints}")), "private-use"),
        ("no targets\n".into(), "does not write joint \"shoulder\" of target 1"),
    ];
    for (template, part) in cases {
        place.write("own.j2", &template);
        let done = program(&place, "planar_2r", &world, "--template own.j2 --output own.txt --output own.json");
        let refused = [part, if template.contains("digits") { "not certified" } else { "own.j2: " }, "hint: "];
        done.refused(1, &refused);
        assert!(!place.path("own.txt").exists() && !place.path("own.json").exists(), "{template}");
    }
}

#[test]
fn defects_of_a_template_are_reported_with_their_line() {
    let place = Place::new();
    let world = shipped("workspaces/shelf.toml");
    for (template, parts) in [
        (
            "a\n{% for move in moves %}\n{{ move.jont }}\n{% endfor %}",
            ["own.j2: line 3, column", "`move.jont` is undefined"],
        ),
        ("a\n\n{% for move in %}", ["own.j2: line 3, column", "unexpected"]),
        ("{{ head.world | digits(3) }}", ["own.j2: line 1, column", "digits needs a joint value"]),
        ("{{ moves[0].joints[0] | digits(99) }}", ["own.j2: line 1, column", "decimals from 0 to 15"]),
        ("{{ moves[0].joints[0] + 90 }}", ["own.j2: line 1, column", "hint: docs/programs.md"]),
    ] {
        place.write("own.j2", template);
        let done = program(&place, "planar_2r", &world, "--template own.j2 --output own.txt");
        done.refused(1, &[parts[0], parts[1], "hint: docs/programs.md lists the data"]);
    }
    let done = program(&place, "planar_2r", &world, "--template fanuc --output own.txt");
    done.refused(1, &["fanuc: there is no such template", "hint: ", "epson, rapid, list"]);
    place.write("own.j2", "x");
    let done = program(&place, "planar_2r", &world, "--template own.j2 --output own.j2");
    done.refused(1, &["the output own.j2 is the input file own.j2"]);
}

#[test]
fn options_that_contradict_a_program_are_refused() {
    let place = Place::new();
    let shelf = shipped("workspaces/shelf.toml");
    let refuse = |options: &str, code: i32, parts: &[&str]| {
        program(&place, "planar_2r", &shelf, options).refused(code, parts);
    };
    refuse(
        "--output a.prg",
        2,
        &["the format of \"a.prg\" is unknown", "hint: to write a program for a controller, add --template"],
    );
    refuse("--template epson", 2, &["--template needs an --output file"]);
    refuse("--template epson --output a.json", 2, &["--template needs an --output file"]);
    refuse("--template epson --output a.prg --blend 0.1", 2, &["leave out --blend"]);
    for tolerance in ["20deg", "-0.1", "0.5m", "nan", "inf", "0.1in", "1mm,"] {
        refuse(&format!("--template epson --output a.prg --joint-tolerance={tolerance}"), 2, &["0.05deg,0.1mm"]);
    }
    refuse("--joint-tolerance 0.1deg --output a.json", 2, &["--template"]);
    let done =
        program(&place, "planar_2r", &shipped("workspaces/moving/crossing.toml"), "--template epson --output a.prg");
    done.refused(1, &["obstacles move", "hint: write .yaml or .csv files"]);
    let done =
        program(&place, "planar_2r", &shipped("workspaces/follow/badge.toml"), "--template epson --output a.prg");
    done.refused(1, &["step 2 follows a line", "hint: write .yaml or .csv files"]);
    let turned = shipped("workspaces/tasks/board_turned.toml");
    let done = program(&place, "gantry", &turned, "--template epson --output a.prg");
    done.refused(1, &["turns its object, but the world does not name the wrist's joint", "hint: [robot] wrist"]);
    // The tolerance counts as clearance, also at the start and in proofs that there is no path.
    let kit = shipped("workspaces/tasks/kitting_cell.toml");
    let done = program(&place, "scara", &kit, "--template epson --output a.prg --joint-tolerance 2deg");
    done.refused(1, &["the start", "joint tolerance of 2 deg, 0.05 mm adds", "hint: cplan explain"]);
    let done =
        program(&place, "rail_arm", &shipped("workspaces/slot_open.toml"), "--template epson --output a.prg").exits(3);
    done.says(&["program    not written; the program's joint tolerance"]);
    done.warns(&["a.prg is not written: the result has no motion"]);
    assert!(!place.path("a.prg").exists());
}

#[test]
fn the_height_of_the_quill_has_a_tolerance() {
    let place = Place::new();
    // The raised flange passes 0.02 mm above the lid.
    let world = r#"[robot]
joints = ["axis_1", "axis_2"]
tip = "flange"
stroke = { joint = "axis_3" }
[start]
joints = [0.5, 0.4]
[[obstacle]]
name = "lid"
polygon = [[0.45, -0.05], [0.6, -0.05], [0.6, 0.05], [0.45, 0.05]]
height = [0.0, 0.17998]
[[step]]
move = { joints = [-0.5, -0.4] }
"#;
    place.write("lid.toml", world);
    let run =
        |options: &str| program(&place, "scara", "lid.toml", &format!("--template epson --output a.prg {options}"));
    run("")
        .refused(1, &["not certified", "\"lid\" can touch within the tolerance of the heights", "--joint-tolerance"]);
    assert!(!place.path("a.prg").exists());
    assert_eq!(run("--joint-tolerance 0.01mm").code, 0);
    assert_eq!(targets(&read_spel(&place.read("a.prg"))).len(), 2);
}

#[test]
fn an_object_that_the_wrist_turns_keeps_the_tolerance_of_the_heights() {
    let place = Place::new();
    // The bar passes 0.02 mm above a pin wherever the wrist turns it.
    let world = r#"[robot]
joints = ["axis_1", "axis_2"]
tip = "flange"
payload = "level"
wrist = { joint = "axis_4", velocity = 41.888 }
stroke = { joint = "axis_3", acceleration = 10.0 }
[start]
joints = [0.0, 1.2]
[[obstacle]]
name = "pin at the feeder"
circle = { center = [0.3712, -0.1788], radius = 0.004 }
height = [0.0, 0.14998]
[[obstacle]]
name = "pin at the tray"
circle = { center = [0.3712, 0.1212], radius = 0.004 }
height = [0.0, 0.14998]
[[object]]
name = "bar"
polygon = [[-0.04, -0.004], [0.04, -0.004], [0.04, 0.004], [-0.04, 0.004]]
at = [0.35, -0.2]
height = [0.0, 0.01]
lift = 0.15
[[step]]
pick = "bar"
[[step]]
place = { at = [0.35, 0.1], angle = "90deg" }
"#;
    place.write("bar.toml", world);
    let run =
        |options: &str| program(&place, "scara", "bar.toml", &format!("--template rapid --output a.mod {options}"));
    run("")
        .refused(1, &["not certified: at the turn of the wrist for step 2, ", "within the tolerance of the heights"]);
    run("--joint-tolerance 0.01mm").exits(0);
    let targets = targets(&read_rapid(&place.read("a.mod")));
    let sums: Vec<f64> = targets.iter().map(|to| to[0] + to[1] + to[3]).collect();
    let turns = targets.windows(2).zip(sums.windows(2)).filter(|(to, _)| to[0][..3] == to[1][..3]);
    let turns: Vec<f64> = turns.map(|(_, sums)| sums[1] - sums[0]).collect();
    assert!(turns.len() == 1 && (turns[0] - 90.0).abs() < 1e-3, "{turns:?}");
}

/// The table of a task has no steps. Its quill is judged among the obstacles: there it may not come down on the way.
#[test]
fn the_quill_of_a_table_of_a_task_is_judged() {
    let place = Place::new();
    let world = shipped("workspaces/tasks/kitting_cell.toml");
    assert_eq!(program(&place, "scara", &world, "--quiet --template list --output kit.txt --output kit.csv").code, 0);
    assert!(place.read("kit.csv").starts_with("time,axis_1,axis_2,axis_3,axis_4,"));
    let verify = |file: &str| place.run(&["verify", &shipped("robots/scara.urdf"), &world, file], "--anywhere");
    for file in ["kit.txt", "kit.csv"] {
        let done = verify(file);
        assert!(
            done.code == 0 && done.stdout.contains("moving tool is judged only among obstacles"),
            "{}",
            done.stdout
        );
    }
    let text = place.read("kit.txt");
    let header = text.lines().find(|line| line.contains("axis_3 [mm]")).expect("a header").to_owned();
    let column = header.split(',').position(|name| name.contains("axis_3")).expect("a column");
    let lowered = |line: &str| {
        let mut fields: Vec<&str> = line.split(',').collect();
        if fields.len() > column && fields[column].trim().parse::<f64>().is_ok() {
            fields[column] = "-150";
        }
        fields.join(",")
    };
    place.write("low.txt", text.lines().map(lowered).collect::<Vec<_>>().join("\n"));
    let done = verify("low.txt");
    assert!(done.code == 3 && done.stdout.contains("contact "), "{} {}", done.code, done.stdout);
}

#[test]
fn templates_end_and_keep_numbers_apart() {
    let place = Place::new();
    let loops = "{% for a in range(10000) %}{% for b in range(10000) %}{% endfor %}{% endfor %}";
    let value = |before: &str, after: &str| {
        format!(
            "{{% for move in moves %}}{{% for v in move.joints %}}{before}{{{{ v }}}}{after}\n{{% endfor %}}{{% endfor %}}"
        )
    };
    for (template, expected) in [
        (loops.to_owned(), "the template takes more than 50000000 instructions"),
        (value("-", ""), "directly beside a joint value of"),
        (value("9", ""), "directly beside a joint value of"),
        (value("", "00"), "directly beside a joint value of"),
        (value("", "e1"), "directly beside a joint value of"),
    ] {
        place.write("own.j2", &template);
        let done = program(&place, "planar_2r", &shipped("workspaces/shelf.toml"), "--template own.j2 --output a.job");
        assert!(done.code == 1 && done.stderr.contains(expected), "{template}: {} {}", done.code, done.stderr);
        assert!(!place.path("a.job").exists());
    }
    for tolerance in ["0.05deg,0.05deg", "1,2", "1mm,2mm"] {
        let options = format!("--template list --output a.txt --joint-tolerance {tolerance}");
        let done = program(&place, "planar_2r", &shipped("workspaces/shelf.toml"), &options);
        assert!(done.code == 2 && done.stderr.contains("must have one angle and one length"), "{}", done.stderr);
    }
}
