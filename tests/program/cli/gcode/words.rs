//! The words of lines in written programs, options and errors.

use super::*;
/// Runs a program on both sides of the bar of `labels.toml`.
fn run(place: &Place, text: &str, options: &str) -> Done {
    place.write("job.gcode", text);
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml"].map(shipped);
    place.run(&["gcode", &files[0], &files[1], "job.gcode"], options)
}

/// Returns the lines of the written program.
fn written(text: &str, options: &str) -> Vec<String> {
    let place = Place::new();
    run(&place, text, &format!("--output safe.gcode --quiet {options}")).exits(0);
    place.read("safe.gcode").lines().map(str::to_owned).collect()
}

#[test]
fn a_travel_keeps_the_words_of_its_line() {
    let text = "G21 G90\nG0 X240 Y265\nG1 Y275 F3000\nN7 G0 X-240 M106 S3 F9000 (over) ; there\nG1 Y265\n";
    let lines = written(text, "--dialect grbl");
    assert_eq!(lines[3], "(cplan: the travel of line 4 of the original, in 2 moves)");
    assert!(lines[4].starts_with("N7 G0 X") && lines[4].ends_with(" M106 S3 F9000 (over) ; there"), "{lines:?}");
    // The original line states only X, so both coordinates are written.
    assert_eq!((lines[4].matches(" Y").count(), lines[5].as_str()), (1, "G0 X-240 Y275"));
    assert_eq!([&lines[..3], &lines[6..]].concat(), ["G21 G90", "G0 X240 Y265", "G1 Y275 F3000", "G1 Y265"]);
}

#[test]
fn the_tool_comes_down_last_and_rises_first() {
    let text = |z: &str| format!("G21 G90\nG0 Z2\nG0 X240 Y265\nG1 Y275\nG0 X-240 {z} Y275\nG1 Y265\n");
    let lowered = written(&text("Z0.5"), "--dialect duet");
    assert!(!lowered[5].contains('Z') && lowered.iter().any(|line| line == "G0 X-240 Y275 Z0.5"), "{lowered:?}");
    let raised = written(&text("Z5"), "--dialect duet");
    assert!(raised[5].contains(" Z5") && raised.iter().any(|line| line == "G0 X-240 Y275"), "{raised:?}");
    // The original is kept if nothing is in the way.
    let free = "G21 G90\nG0 X240 Y265\nG1 Y275\nG0 X200 Z1\nG1 Y265\n";
    assert_eq!(written(free, "").join("\n") + "\n", free);
}

#[test]
fn displacements_units_origins_and_line_endings_stay() {
    let relative = "G21 G90\r\nG0 X240 Y265\r\nG91\r\nG0 X-480\r\nG1 Y10\r\n";
    let place = Place::new();
    assert_eq!(run(&place, relative, "--output safe.gcode --dialect grbl").code, 0);
    let safe = place.read("safe.gcode");
    assert!(safe.lines().count() == safe.matches("\r\n").count() && safe.contains("(cplan: "), "{safe:?}");
    let moves: Vec<&str> = safe.lines().filter(|line| line.starts_with("G0")).skip(1).collect();
    let sum = |letter: char| -> f64 {
        let value = |line: &&str| line.split(' ').find_map(|word| word.strip_prefix(letter)?.parse::<f64>().ok());
        moves.iter().filter_map(value).sum()
    };
    assert!((sum('X') + 480.0).abs() < 1e-9 && sum('Y').abs() < 1e-9, "{safe}");
    // Inches, with a moved origin, and no line ending at the end.
    let inches = "G20 G90\nG0 X10 Y10\nG92 X0 Y0\nG1 X-0.5 Y0.5\nG0 X-19.5";
    let lines = written(inches, "--dialect linuxcnc");
    assert!(lines.len() > 6 && lines[lines.len() - 1] == "G0 X-19.5 Y0.5", "{lines:?}");
}

/// Plotters often travel by G1, with words that lift the pen.
#[test]
fn words_that_lift_the_pen_make_travels() {
    let text = "G21 G90\nG1 X240 Y265\nM300 S30.00 (pen down)\nG1 Y275\nm300 s50 ; up\nG1 X-240 Y265 F3500\nM300S30\nG1 Y275\n";
    let place = Place::new();
    assert_eq!(run(&place, text, "--check --json --dialect klipper").json()["lines"]["travels"], 0);
    place.write("job.gcode", text);
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml"].map(shipped);
    let pen = ["--dialect", "klipper", "--pen-up", "M300 S50", "--pen-down", "M300 S30"];
    let arguments = [&["gcode", &files[0], &files[1], "job.gcode"][..], &pen].concat();
    let done = place.run(&arguments, "--output safe.gcode --json");
    assert_eq!((done.code, &done.json()["lines"]["travels"]), (0, &1.into()), "{}", done.stderr);
    let safe = place.read("safe.gcode");
    assert!(!safe.contains("G0") && safe.contains("\nG1 X-240 Y265\nM300S30\n"), "{safe}");
    place.run(&[&["gcode", &files[0], &files[1], "safe.gcode"][..], &pen].concat(), "--check").exits(0);
    run(&place, text, "--check --pen-up M300").refused(2, &["--pen-down"]);
    run(&place, text, "--check --pen-up up --pen-down M5").refused(2, &["a letter and a number"]);
}

#[test]
fn homing_makes_the_place_unknown() {
    let place = Place::new();
    let text = "G28\nG21 G90\nG0 X240 Y265\nG1 Y275\nG28 X Y\nG0 X-240 Y265\nG1 Y275\n$H\nG0 X240 Y265\n";
    let done = run(&place, text, "--check --json").exits(0);
    assert_eq!(done.json()["lines"]["unstated"], serde_json::json!([3, 6, 9]));
    // With a known home, the travels from there are judged, and the one to the other side of the bar is not safe.
    let done = run(&place, text, "--check --json --home 0.4,0 --dialect marlin");
    let lines = &done.json()["lines"];
    assert_eq!((done.code, &lines["travels"], &lines["unstated"]), (3, &3.into(), &serde_json::json!([])));
    assert_eq!((lines["failed"].as_array().unwrap().len(), &lines["failed"][0]["line"]), (1, &6.into()));
    assert_eq!(run(&place, text, "--output safe.gcode --quiet --home 0.4,0 --dialect marlin").code, 0);
    assert!(place.read("safe.gcode").contains("G28 X Y\n; cplan: the travel of line 6 of the original, in "));
}

#[test]
fn firmware_segments_can_be_judged_by_themselves() {
    let place = Place::new();
    // In one segment, the joints lead the pen along a curve below the bar.
    let text = "G21 G90\nG0 X100 Y265\nG1 X-100 Y265\n";
    let whole = run(&place, text, "--check --elbow right --dialect linuxcnc --segment 1");
    let fine = run(&place, text, "--check --elbow right --dialect linuxcnc --segment 1mm --json").exits(3);
    assert_eq!(fine.json()["lines"]["failed"][0]["cause"], "joint_motion");
    assert!([0, 3].contains(&whole.code), "{}{}", whole.stdout, whole.stderr);
}

#[test]
fn wrong_command_lines_and_files_are_refused() {
    let place = Place::new();
    let text = "G21 G90\nG0 X240 Y265\nG1 Y275\nG0 X-240 Y265\nG1 Y275\n";
    run(&place, text, "").refused(2, &["--check"]);
    run(&place, text, "--check --output safe.gcode").refused(2, &["--output"]);
    run(&place, text, "--check --dialect fanuc").refused(2, &["marlin", "linuxcnc"]);
    run(&place, text, "--check --elbow up").refused(2, &["left", "right"]);
    run(&place, text, "--output job.gcode").refused(1, &["job.gcode"]);
    run(&place, "G21 G18\nG0 X0 Y0\nG1 X1\n", "--check").refused(1, &["job.gcode", "line 1", "G18"]);
    run(&place, "G21\n", "--check").refused(1, &["job.gcode", "no line"]);
    let checked = text.replace("G0 X-240 Y265", &with_checksum("N4 G0 X-240 Y265"));
    run(&place, &checked, "--output safe.gcode").refused(1, &["line 4 has a checksum"]);
    assert!(!place.path("safe.gcode").exists());
    let gantry = ["robots/gantry.urdf", "workspaces/gantry_maze.toml"].map(shipped);
    place.run(&["gcode", &gantry[0], &gantry[1], "job.gcode"], "--check --elbow left").refused(2, &["elbow"]);
}

/// Returns a line with its checksum: the exclusive or of its bytes.
fn with_checksum(line: &str) -> String {
    format!("{line}*{}", line.bytes().fold(0, |sum, byte| sum ^ byte))
}

#[test]
fn wrong_checksums_and_numbers_out_of_order_are_named_by_line() {
    let place = Place::new();
    let program = |lines: &[&str]| lines.iter().map(|line| with_checksum(line) + "\n").collect::<String>();
    let numbered = program(&["N1 G21", "N2 G90", "N3 G0 X240 Y265", "N4 G1 Y275"]);
    for dialect in ["marlin", "duet", "klipper"] {
        assert_eq!(run(&place, &numbered, &format!("--check --dialect {dialect}")).code, 0, "{dialect}");
        let wrong = numbered.replace("Y275", "Y276");
        let sum = with_checksum("N4 G1 Y276");
        let message = format!("line 4, column 11: the checksum is *{}", &with_checksum("N4 G1 Y275")[11..]);
        run(&place, &wrong, &format!("--check --dialect {dialect}")).refused(1, &[&message, &sum[10..]]);
    }
    let swapped = program(&["N1 G21", "N3 G0 X240 Y265", "N2 G90", "N4 G1 Y275"]);
    run(&place, &swapped, "--check")
        .refused(1, &["line 2, column 1: N3 comes after N1, and marlin refuses numbers out of order"]);
    // Without checksums, numbers may have gaps, and only their order counts.
    let gaps = "N10 G21\nN20 G90\nN30 G0 X240 Y265\nN40 G1 Y275\n";
    assert_eq!(run(&place, gaps, "--check").code, 0);
    run(&place, &gaps.replace("N40", "N30"), "--check").refused(1, &["line 4, column 1: N30 comes after N30"]);
    assert_eq!(run(&place, &gaps.replace("N40", "N30"), "--check --dialect linuxcnc").code, 0);
    // M110 states the number of its line, or that of the last one.
    let set = program(&["N9 M110 N0", "N1 G21", "N2 G0 X240 Y265", "N3 G1 Y275"]);
    assert_eq!(run(&place, &set, "--check").code, 0, "{set}");
    // Comments have no checksums.
    assert_eq!(run(&place, "G21 G90 ; 2*3\nG0 X240 Y265\nG1 Y275 ; *9\n", "--check").code, 0);
}

#[test]
fn programs_name_their_dialect() {
    let place = Place::new();
    let drawing = "G21 G90\nG0 X240 Y265\nG1 Y275\n";
    let dialect = |before: &str, options: &str| {
        let done = run(&place, &format!("{before}\n{drawing}"), &format!("--check --json {options}")).exits(0);
        let result = done.json();
        let notes = result["notes"].as_array().unwrap();
        let is_noted = notes.iter().any(|note| note.as_str().unwrap().contains("of the program names it"));
        (result["dialect"].as_str().unwrap().to_owned(), is_noted)
    };
    for (before, expected) in [
        (";FLAVOR:Marlin", "marlin"),
        (";FLAVOR:RepRap", "duet"),
        ("; gcode_flavor = klipper", "klipper"),
        ("; generated by PrusaSlicer\n; for RepRapFirmware 3", "duet"),
        ("SET_VELOCITY_LIMIT ACCEL=500", "klipper"),
        ("$X", "grbl"),
        ("(post: FluidNC)", "fluidnc"),
        ("%", "linuxcnc"),
    ] {
        assert_eq!(dialect(before, ""), (expected.to_owned(), true), "{before}");
        assert_eq!(dialect(before, "--dialect duet"), ("duet".to_owned(), false), "{before}");
    }
    for before in ["", "; made by hand", "; for Marlin or Klipper", "; grblings", "M117 Hello"] {
        assert_eq!(dialect(before, ""), ("marlin".to_owned(), false), "{before}");
    }
}

#[test]
fn pictures_show_replaced_travels_and_failed_moves() {
    let place = Place::new();
    let text = "G21 G90\nG0 X240 Y265\nG1 Y275\nG0 X-240 Y265\nG1 Y275\n";
    assert_eq!(
        run(&place, text, "--output safe.gcode --picture safe.svg --picture safe.html --picture safe.png").code,
        0
    );
    let picture = place.read("safe.svg");
    has(&picture, &["drawing moves", "replaced travel", "found: the machine can run all moves"]);
    assert!(!picture.contains("move that fails") && place.path("safe.png").exists());
    // The page has both lines of the new travel, from one tray to the other.
    let page = place.read("safe.html");
    let (_, marked) = page.split_once("\"marked\":").expect("marked moves");
    assert!(marked.starts_with("[[\"#0072b2\",[0.24,0.275,"), "{}", &marked[..100]);
    assert_eq!(run(&place, text, "--check --picture fails.svg").code, 3);
    assert!(
        place.read("fails.svg").contains("move that fails") && !place.read("fails.svg").contains("replaced travel")
    );
    run(&place, text, "--check --picture a.gif").refused(2, &["a picture of a program must be .svg, .png or .html"]);
    run(&place, text, "--output a.svg --picture ./a.svg").refused(1, &["are the same file"]);
}

/// Without the words of the pen, its travels by G1 fail as drawing moves, and a note says so.
#[test]
fn a_note_states_the_words_that_may_lift_the_pen() {
    let place = Place::new();
    let text = "G21 G90\nM280 P0 S60\nG1 X240 Y265 F3000\nM280 P0 S60\nG1 X-240 Y265\n";
    let note = "if M280 lifts the pen before line 5, name the words by --pen-up and --pen-down";
    run(&place, text, "--check").exits(3).says(&[note]);
    place.write("job.gcode", text);
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml"].map(shipped);
    let words = ["gcode", &files[0], &files[1], "job.gcode", "--pen-up", "M280 S60", "--pen-down", "M280 S10"];
    let done = place.run(&words, "--check").exits(3);
    assert!(!done.stdout.contains("--pen-up"), "{}", done.stdout);
}
