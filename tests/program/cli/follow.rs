//! `cplan follow` from outside: motions against the tests' own kinematics, answers, files and errors.

use super::*;
fn follow(place: &Place, line: &str, options: &str) -> Done {
    let [robot, world] = files("follow/engraving");
    place.run(&["follow", &robot, &world, line], options)
}

/// Writes a program that begins at a point, millimetres, and follows it.
fn follow_program(place: &Place, text: &str, options: &str) -> Done {
    place.write("line.gcode", text);
    follow(place, "line.gcode", options)
}

#[test]
fn the_shipped_plate_is_engraved_at_its_speeds() {
    let place = Place::new();
    let done = follow(&place, &shipped("workspaces/follow/plate.gcode"), "--output m.csv --picture m.svg --quiet");
    assert_eq!((done.code, done.stdout.as_str()), (0, ""), "{}", done.stderr);
    let csv = place.read("m.csv");
    let rows = place.table("m.csv");
    assert_eq!(csv.lines().next(), Some("time,shoulder,elbow,shoulder_velocity,elbow_velocity,tool"));
    let [first, last] = [&rows[0], &rows[rows.len() - 1]].map(|row| tip([row[1], row[2]]));
    assert!((first[0] - 1.1).hypot(first[1] + 0.15) < 1e-9 && (last[0] - 1.25).hypot(last[1] - 0.06) < 1e-9);
    // The circle is engraved last, at 50 mm/s.
    let on_circle = |q: [f64; 2]| {
        let [x, y] = tip(q);
        ((x - 1.2).hypot(y - 0.06) - 0.05).abs() < 1e-5
    };
    let end = rows[rows.len() - 1][0];
    let circle: Vec<_> = rows.windows(2).filter(|pair| pair[0][0] > end - 6.2).collect();
    assert!(circle.len() > 100);
    for pair in circle {
        let [a, b] = [&pair[0], &pair[1]].map(|row| tip([row[1], row[2]]));
        assert!(on_circle([pair[0][1], pair[0][2]]), "{a:?}");
        let speed = (b[0] - a[0]).hypot(b[1] - a[1]) / (pair[1][0] - pair[0][0]);
        assert!(speed < 0.0501, "{speed}");
    }
    let picture = place.read("m.svg");
    has(&picture, &["Workspace", "The tip follows the line within", "line to follow"]);
}

#[test]
fn the_answer_is_json_with_a_bound_on_the_distance() {
    let place = Place::new();
    let done = follow_program(&place, "G21 G0 X1100 Y-150\nG1 X1200 F3000\n", "--json --output m.json").exits(0);
    let result: Value = done.json();
    assert_eq!(result["status"], "found");
    assert!(number(&result["deviation"]) <= 1e-5 && number(&result["tolerance"]) == 1e-5);
    assert!((number(&result["line"]["length"]) - 0.1).abs() < 1e-12);
    // 100 mm at 50 mm/s.
    assert!((2.0..2.1).contains(&number(&result["duration"])), "{}", result["duration"]);
    assert_eq!(result, place.json("m.json"));
    for position in result["trajectory"]["position"].as_array().unwrap() {
        let [x, y] = tip([0, 1].map(|k| number(&position[k])));
        assert!((y + 0.15).abs() < 1e-5 && (1.1 - 1e-9..1.2 + 1e-9).contains(&x), "{x} {y}");
    }
}

/// The tool is off from the arrival where a travel begins to the arrival where it ends, and the arm rests there for the pen.
#[test]
fn files_mark_travels_and_the_arm_waits_for_the_pen() {
    let place = Place::new();
    let text = "G21 G0 X1100 Y-150\nG1 X1200 F3000\nG0 Y-100\nG1 X1100\n";
    let rows = |options: &str| -> Vec<Vec<f64>> {
        assert_eq!(follow_program(&place, text, &format!("--output m.csv --output m.json --quiet {options}")).code, 0);
        place.table("m.csv")
    };
    let fast = rows("");
    for options in ["", "--pen-time 0.25"] {
        let rows = rows(options);
        let result = place.json("m.json");
        let tool: Vec<f64> = rows.iter().map(|row| row[5]).collect();
        assert!(result["tool"].as_array().unwrap().iter().zip(&tool).all(|(json, csv)| json.as_f64() == Some(*csv)));
        let off: Vec<usize> = (0..tool.len()).filter(|k| tool[*k] == 0.0).collect();
        assert!(off.len() > 5 && off[off.len() - 1] - off[0] == off.len() - 1, "one travel");
        for row in &rows {
            let [x, y] = tip([row[1], row[2]]);
            let is_stroke = (y + 0.15).abs() < 2e-5 || (y + 0.1).abs() < 2e-5;
            assert!(if row[5] == 1.0 { is_stroke } else { (x - 1.2).abs() < 2e-5 }, "{row:?}");
        }
        // The arm rests after the pen begins to rise, and after it begins to come down.
        let rest = |from: usize| rows[from..].iter().take_while(|row| row[1..3] == rows[from][1..3]).count();
        let rests = [off[0], off[off.len() - 1] + 1].map(|k| rows[k + rest(k) - 1][0] - rows[k][0]);
        assert!(
            rests.iter().all(|rest| (rest - if options.is_empty() { 0.0 } else { 0.25 }).abs() < 0.011),
            "{rests:?}"
        );
        let more = rows[rows.len() - 1][0] - fast[fast.len() - 1][0];
        assert!((more - if options.is_empty() { 0.0 } else { 0.5 }).abs() < 0.02, "{more}");
    }
    // Without a travel, the files have no column.
    let done = follow_program(&place, "G21 G0 X1100 Y-150\nG1 X1200 F3000\n", "--output m.csv --json");
    assert!(!place.read("m.csv").contains("tool") && done.json().get("tool").is_none());
}

#[test]
fn a_line_out_of_reach_is_infeasible_at_a_place() {
    let place = Place::new();
    let text = "G21 G0 X1100 Y0\nG1 X1400\nG1 X1900\n";
    let done = follow_program(&place, text, "--json --picture m.svg --output m.csv").exits(3);
    let result = done.json();
    assert_eq!((result["status"].as_str(), result["cause"].as_str()), (Some("infeasible"), Some("out_of_reach")));
    assert_eq!(result["place"]["line"], 3);
    assert!(place.read("m.svg").contains("x: the tip cannot follow the line here"));
    assert!(!place.path("m.csv").exists() && done.stderr.contains("m.csv is not written"), "{}", done.stderr);
    follow_program(&place, text, "").says(&["infeasible: the line is", "line 3 of the file"]);
}

#[test]
fn obstacles_at_both_solutions_are_named() {
    let place = Place::new();
    let world = "[[obstacle]]\nname = \"above\"\npolygon = [[0.2, 0.3], [1.0, 0.3], [1.0, 0.6], [0.2, 0.6]]\n\
                 [[obstacle]]\nname = \"below\"\npolygon = [[0.2, -0.6], [1.0, -0.6], [1.0, -0.3], [0.2, -0.3]]\n";
    place.write("world.toml", world);
    place.write("line.gcode", "G21 G0 X1000 Y-100\nG1 Y100\n");
    let done = place.run(&["follow", &robot(), "world.toml", "line.gcode"], "").exits(3);
    done.says(&["no IK solution is possible at", "hits obstacle \"above\"", "hits obstacle \"below\""]);
}

#[test]
fn placements_units_and_speeds_apply() {
    let place = Place::new();
    let options = "--unit cm --scale 2 --turn 90deg --move 1.2,-0.2 --speed 0.02 --json";
    let result = follow_program(&place, "G0 X0 Y0\nG1 X5 F99999\n", options).exits(0).json();
    assert!((number(&result["line"]["length"]) - 0.1).abs() < 1e-12);
    assert!((5.0..5.1).contains(&number(&result["duration"])));
    let positions = result["trajectory"]["position"].as_array().unwrap();
    let last = tip([0, 1].map(|k| number(&positions[positions.len() - 1][k])));
    assert!((last[0] - 1.2).hypot(last[1] + 0.1) < 1e-8, "{last:?}");
    // Without the option, the drawing's own unit counts.
    place.write(
        "line.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='500mm' height='500mm' viewBox='0 0 500 500'>\
                 <path d='M 0 500 L 100 500' fill='none'/></svg>",
    );
    let done = follow(&place, "line.svg", "--move 1.1,0 --json");
    assert!((number(&done.json()["line"]["length"]) - 0.1).abs() < 1e-12, "{}", done.stderr);
}

#[test]
fn ros_messages_and_pages_are_written() {
    let place = Place::new();
    let done =
        follow_program(&place, "G21 G0 X1100 Y-150\nG1 X1200\n", "--output m.yaml --picture m.html --verbose").exits(0);
    done.says(&["found and certified: the tip is at most", "line 2: straight of"]);
    let message = place.read("m.yaml");
    assert!(message.contains("joint_names") && message.contains("elbow") && message.contains("velocities"));
    let page = place.read("m.html");
    assert!(page.contains("\"line\":{\"strokes\":[[1.1,-0.15,1.2,-0.15]],\"curves\":"), "the page has the line");
}

/// The line continues at the place where G92 states another origin, the motion rests for the dwell, and one note lists the words
/// without an effect.
#[test]
fn origins_and_dwells_are_followed_and_other_words_are_noted() {
    let place = Place::new();
    let text = "G21 G90\nSET_VELOCITY_LIMIT ACCEL=500\nG0 X1100 Y0\nG1 X1150 F6000\nG92 X0 Y0 (here is the new origin)\n\
        G1 X20 Y0\nG4 X2\nM3 S5\nG1 X20 Y20 Z3\n";
    let done = follow_program(&place, text, "--output m.csv").exits(0);
    let note = "words without effect on the line: M3 (1), S (1), SET_VELOCITY_LIMIT (1), Z (1 height)";
    done.says(&[note, "1 stop of 2 s in all (G4)"]);
    let rows = place.table("m.csv");
    let at = |row: &Vec<f64>| tip([row[1], row[2]]);
    let end = at(&rows[rows.len() - 1]);
    assert!((end[0] - 1.17).hypot(end[1] - 0.02) < 1e-5, "{end:?}");
    let is_rest = |pair: &&[Vec<f64>]| (pair[1][0] - pair[0][0] - 2.0).abs() < 1e-6 && pair[0][1..3] == pair[1][1..3];
    let rests: Vec<[f64; 2]> = rows.windows(2).filter(is_rest).map(|pair| at(&pair[0])).collect();
    assert!(rests.len() == 1 && (rests[0][0] - 1.17).hypot(rests[0][1]) < 1e-5, "{rests:?}");
}

#[test]
fn defects_of_the_line_have_their_place_and_a_hint() {
    let place = Place::new();
    let done = follow_program(&place, "G21 G0 X1100 Y-150\nG1 X1200 A90\nG41\n", "");
    let list = "line.gcode: line 2, column 10: A turns the tool (line 2); G41 offsets the line by the tool's radius";
    done.refused(1, &[list, "hint: write a file for the axes X, Y and Z; let the program that writes the file"]);
    let done = follow_program(&place, "G21\nG18\n", "--json");
    let error = done.json();
    assert_eq!(
        (error["status"].as_str(), error["line"].as_u64(), error["column"].as_u64()),
        (Some("error"), Some(2), Some(1))
    );
    assert_eq!(done.code, 1);
    place.write("empty.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>");
    follow(&place, "empty.svg", "").refused(1, &["empty.svg: the file has no line"]);
    follow(&place, "missing.gcode", "").refused(1, &["missing.gcode"]);
    follow(&place, "line.txt", "")
        .refused(2, &["line.txt: the name of a line must end in .gcode, .nc, .ngc, .tap, .svg or .toml"]);
}

#[test]
fn unusable_options_are_refused_before_any_work() {
    let place = Place::new().with("line.gcode", "G21 G0 X1100 Y-150\nG1 X1200\n");
    for (options, message) in [
        ("--tolerance 0", "at least 0.000001"),
        ("--tolerance nan", "at least 0.000001"),
        ("--speed 0", "--speed"),
        ("--scale 0", "--scale"),
        ("--unit furlong", "\"furlong\" is not a known unit"),
        ("--move 1", "two numbers separated by a comma"),
        ("--output m.txt", "must end in .json, .csv, .yaml or .yml"),
        ("--picture m.gif", "a picture of a line must be .svg, .png or .html"),
    ] {
        follow(&place, "line.gcode", options).refused(2, &[message]);
    }
    follow(&place, "line.gcode", "--output line.svg.json --output ./line.svg.json").refused(1, &["are the same file"]);
    let moving = shipped("workspaces/moving");
    let mover = std::fs::read_dir(moving).unwrap().map(|entry| entry.unwrap().path()).find(|path| {
        path.extension().is_some_and(|end| end == "toml")
            && std::fs::read_to_string(path).unwrap().contains("planar_2r")
    });
    let mover = mover.expect("a world with a moving obstacle").display().to_string();
    place
        .run(&["follow", &robot(), &mover, "line.gcode"], "")
        .refused(1, &["lines can be followed only if all obstacles are static"]);
}

/// The end of the line is out of reach by less than the tolerance, and by hardly less.
#[test]
fn places_beside_the_reach_are_followed_or_named_with_a_tolerance_that_works() {
    let place = Place::new().with("world.toml", "");
    let follow = |end: f64, options: &str| {
        place.write("line.gcode", format!("G21 G90 F6000\nG0 X1000 Y0\nG1 X{end}\n"));
        place.run(&["follow", &robot(), "world.toml", "line.gcode"], options)
    };
    assert_eq!(follow(1800.008, "").code, 0);
    assert_eq!(follow(1800.011, "").code, 3);
    let unknown = follow(1_800.009_999_9, "").exits(4);
    let (before, after) = unknown.stdout.split_once("; a motion is found with `").expect("advice");
    assert!(before.contains("800.0 mm of the line (line 3 of the file) is 0.010 mm out of reach"), "{before}");
    let (advice, _) = after.split_once('`').expect("advice");
    assert_eq!(follow(1_800.009_999_9, advice).code, 0, "{advice}");
}
