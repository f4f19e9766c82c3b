//! The three commands and their options.

use super::help;
use super::*;
use cplan::engine::Method;

#[test]
fn wrong_command_lines_end_with_2() {
    let place = Place::new();
    let planners = Method::ALL.map(Method::name).join(", ");
    let cases = [
        ("--planner magic", planners.as_str()),
        ("--start 1", "two values"),
        ("--start nan,0", "finite"),
        ("--start 1e300,0", "too large"),
        ("--goal 1,2 --goal-tip 1,2", "cannot be used with"),
        ("--goal-tip 1,2deg", "not a number"),
        ("--clearance -1", "not negative"),
        ("--clearance nan", "such as 0.02 or 20mm"),
        ("--margin -0.1", "from 0 to 0.1"),
        ("--blend 0", "greater than 0"),
        ("--blend=-0.1", "greater than 0"),
        ("--blend inf", "none, auto"),
        ("--blend round", "none, auto"),
        ("--tip-speed 0", "greater than 0"),
        ("--tip-speed nan", "greater than 0"),
        ("--jerk 200", "two values"),
        ("--jerk 200,none,200", "two values"),
        ("--jerk 200,0", "greater than 0"),
        ("--jerk=-1,200", "greater than 0"),
        ("--jerk nan,200", "greater than 0"),
        ("--jerk none,inf", "greater than 0"),
        ("--period 0", "at least"),
        ("--period -1", "at least"),
        ("--cells 3", "3 is not a number from 8 to 2048, or two such numbers"),
        ("--levels 0", "1..=12"),
        ("--output result.txt", ".json, .csv, .yaml"),
        ("--output .json", ".json, .csv, .yaml"),
        ("--picture drawing.pdf", ".svg, .png, .gif or .html"),
        ("--gap 0", "greater than 0"),
        ("--gap nan", "greater than 0"),
        ("--gap 0.1 --planner wavefront", "needs --planner shortest or visibility"),
        ("--metric time --planner harmonic", "needs --planner shortest or visibility"),
        ("--metric weighted", "--weights"),
        ("--metric weighted --weights 1,-1", "two positive numbers"),
        ("--metric weighted --weights 1,2,3", "two positive numbers"),
        ("--weights 1,2", "--metric weighted"),
        ("--frobnicate", "unexpected argument"),
    ];
    for (options, part) in cases {
        // The files do not exist: the command line is checked first.
        place.run(&["no.urdf", "no.toml"], options).refused(2, &[part]);
    }
    place.run(&["check", "no.urdf", "no.toml"], "").refused(2, &["--at"]);
    place.run(&["check", "no.urdf", "no.toml"], "--at 0,0 --clearance inf").refused(2, &["finite"]);
    let done = place.run(&["compare", "no.urdf", "no.toml"], "--json --csv");
    assert_eq!((done.code, &done.json()["kind"]), (2, &serde_json::json!("usage")));
    done.warns(&["--csv"]);
}

#[test]
fn help_names_files_that_exist_and_all_exit_codes() {
    let place = Place::new();
    let help = place.run(&["--help"], "").exits(0);
    let files: Vec<&str> =
        help.stdout.split_whitespace().filter(|word| word.contains('/') && word.contains('.')).collect();
    assert!(files.len() >= 6, "{files:?}");
    for file in files {
        assert!(std::path::Path::new(&shipped(file)).is_file(), "{file}");
    }
    for part in ["compare", "check", "recheck", "0 found", "1 bad input", "2 wrong", "3 proven", "4 unknown"] {
        assert!(help.stdout.replace('\n', " ").contains(part), "{part}");
    }
    place.run(&["check", "--help"], "").exits(0);
    place.run(&["compare", "--help"], "").exits(0);
}

#[test]
fn planning_is_also_a_command() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let [short, long] =
        [&[urdf.as_str(), &world][..], &["plan", &urdf, &world]].map(|words| place.run(words, "--json"));
    assert_eq!((short.code, &short.stdout, &short.stderr), (0, &long.stdout, &long.stderr));
}

/// Checks that the suggested command explains the same query.
#[test]
fn infeasible_results_and_blocked_ends_suggest_an_explanation() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/no_path.toml")];
    for (options, code) in
        [("", 3), ("--start 0.14,0", 1), ("--goal 8deg,0 --clearance 0.01", 1), ("--goal-tip 5,0", 1)]
    {
        let done = place.run(&files, options).exits(code);
        let report = if code == 1 { done.stderr } else { done.stdout };
        let hint = report.lines().rfind(|line| line.trim_start().starts_with("hint")).expect("a hint");
        let (_, command) = hint.split_once("cplan ").expect("a command");
        place.run(&help::words(command), "").exits(3);
    }
    assert!(!place.run(&shelf(), "").stdout.contains("hint "));
}

#[test]
fn options_that_the_planner_ignores_are_noted() {
    let place = Place::new();
    let warned = |options: &str| {
        let done = place.run(&shelf(), options).exits(0);
        done.stderr.lines().filter(|line| line.contains("has no effect")).count()
    };
    assert_eq!(warned("--cells 64 --levels 2"), 1);
    assert_eq!(warned("--planner first --margin 0.01 --levels 2"), 2);
    assert_eq!(warned("--cells 64 --quiet"), 0);
    assert_eq!(warned("--planner wavefront --cells 64 --levels 2"), 0);
}

#[test]
fn options_override_the_world_file() {
    let place = Place::new();
    let world = format!("clearance = 0.02\n{FREE}");
    let path = |options: &str| place.plan(&world, &format!("--json --quiet {options}")).json()["path"].clone();
    assert_eq!(path("")[0], serde_json::json!([-0.9, 0.4]));
    assert_eq!(path("--start 0.1,0")[0], serde_json::json!([0.1, 0.0]));
    assert_eq!(path("--goal=-0.25,90deg")[1], serde_json::json!([-0.25, std::f64::consts::FRAC_PI_2]));
    let reached = path("--goal-tip 0.5,1.2");
    assert_ne!(reached[1], serde_json::json!([1.55, -0.35]), "{reached}");
}

#[test]
fn corners_are_rounded_up_to_the_requested_radius() {
    let place = Place::new();
    let run = |options: &str| {
        let done = place.run(&shelf(), &format!("{options} --output plan.json")).exits(0);
        let result = place.json("plan.json");
        let [urdf, world] = shelf();
        place.run(&["verify", &urdf, &world, "plan.json"], "").exits(0);
        (done.stdout, result)
    };
    let number = |result: &Value, key: &str| result[key].as_f64().unwrap();
    let radius = |result: &Value| result["blends"]["largest_radius"].as_f64().unwrap();
    let (text, stops) = run("--blend none");
    assert!(text.contains("; stops at 10 corners"), "{text}");
    assert_eq!((&stops["blends"]["count"], radius(&stops)), (&serde_json::json!(0), 0.0));
    let (text, blended) = run("");
    assert!(text.contains("; 10 of 10 corners blended, radius up to 0.0"), "{text}");
    assert_eq!((&blended["path"], &blended["length"]), (&stops["path"], &stops["length"]));
    assert!(number(&blended, "duration") < 0.7 * number(&stops, "duration"));
    assert!(number(&blended, "clearance") >= 0.5 * number(&stops, "clearance"));
    let (_, small) = run("--blend 0.002");
    assert!(radius(&small) <= 0.002 && radius(&small) < radius(&blended));
    assert!(number(&small, "duration") > number(&blended, "duration"));
    assert!(number(&small, "duration") < number(&stops, "duration"));
}

#[test]
fn limits_of_the_jerk_are_kept_in_every_format() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let text = read(&world);
    place.write("smooth.toml", format!("{text}\n[robot]\njerk = {{ shoulder = 200.0, elbow = 300.0 }}\n"));
    let smooth = [urdf.as_str(), "smooth.toml"];
    let done = place.run(&smooth, "--verbose --output m.json --output m.yaml --output m.csv").exits(0);
    done.says(&["2 rad/s, 8 rad/s2, 200 rad/s3", "3 rad/s, 12 rad/s2, 300 rad/s3", "; 10 of 10 corners blended"]);
    let result = place.json("m.json");
    // With a stop at each corner, the motion would take 3.5 s.
    assert!(result["blends"]["count"] == 10 && result["duration"].as_f64().unwrap() < 2.1, "{}", result["duration"]);
    assert!(result["interpolation"].as_str().unwrap().ends_with("the jerk is constant"));
    let verify = |file: &str| place.run(&["verify", &urdf, "smooth.toml", file], "");
    for file in ["m.json", "m.yaml", "m.csv"] {
        verify(file).exits(0);
    }
    // The command line overrides the world, in either direction.
    let option = place.run(&shelf(), "--jerk 200,300 --json --quiet");
    assert_eq!(option.json(), result);
    place.run(&smooth, "--jerk none,none --blend none --output jumps.yaml").exits(0);
    let jumps = verify("jumps.yaml").exits(3);
    jumps.says(&["shoulder: acceleration jumps by"]);
}

#[test]
fn the_least_time_has_a_bound_and_another_shape() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let run = |options: &str| {
        let done =
            place.run(&shelf(), &format!("{options} --output m.json --output m.csv --certificate c.json")).exits(0);
        for file in ["m.json", "m.csv"] {
            place.run(&["verify", &urdf, &world, file], "").exits(0);
        }
        let text = |path: &str| std::fs::read_to_string(path).unwrap();
        let judged = cplan_check_files::check(&text(&urdf), &text(&world), &place.read("c.json"));
        assert!(judged.is_ok(), "{options}: {judged:?}");
        let result = place.json("m.json");
        (done.stdout, result)
    };
    let number = |result: &Value, pointer: &str| result.pointer(pointer).and_then(Value::as_f64).unwrap();
    let (text, length) = run("--optimize length");
    assert!(!text.contains("fastest") && length["fastest"].is_null());
    for options in ["--optimize time", "--optimize time --jerk 200,300", "--optimize time --metric time"] {
        let (text, time) = run(options);
        assert!(text.contains("fastest    every motion takes at least 1."), "{text}");
        let [duration, bound] = ["/fastest/duration", "/fastest/lower_bound"].map(|pointer| number(&time, pointer));
        assert_eq!(duration, number(&time, "/duration"));
        assert!(duration < 0.95 * number(&length, "/duration") && bound < duration && bound > 0.8 * duration);
        assert!((number(&time, "/fastest/gap") - (duration / bound - 1.0)).abs() < 1e-12);
        // The reported values are those of the driven path.
        assert!(number(&time, "/length") > number(&length, "/length"));
        assert!(number(&time, "/optimum/lower_bound") < number(&time, "/optimum/length"));
    }
    place.run(&shelf(), "--optimize time --blend none").says(&["; stops at"]);
    place.run(&shelf(), "--optimize speed").exits(2);
}

#[test]
fn check_states_the_reason() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let files = ["check".into(), urdf, world];
    let free = place.run(&files, "--at 10deg,45deg");
    assert_eq!((free.code, free.stdout.contains("result     free")), (0, true), "{}", free.stdout);
    let hit = place.run(&files, "--at 0.14,0.35").exits(0);
    hit.says(&["plane", "link \"forearm\", obstacle \"shelf\": penetrates by", "crosses obstacle side", "not free"]);
    let json = place.run(&files, "--at 0.14,0.35 --json").json();
    assert_eq!((&json["free"], &json["within_limits"]), (&Value::Bool(false), &serde_json::json!([true, true])));
    // The shortest escape is along the link's normal, past the shelf's upper left corner.
    let angle = 0.49_f64;
    let elbow = [0.14_f64.cos(), 0.14_f64.sin()];
    let corner = [1.15 - elbow[0], 0.3 - elbow[1]];
    let beyond = corner[1] * angle.cos() - corner[0] * angle.sin();
    let depth = json["contacts"][0]["depth"].as_f64().unwrap();
    assert!((depth - (0.05 + beyond)).abs() < 1e-9, "{depth} {beyond}");
    place.run(&files, "--at 9,0").exits(0).says(&["OUTSIDE", "not free"]);
    for (at, expected, code, answer) in [
        ("10deg,45deg", "free", 0, "expected   yes"),
        ("10deg,45deg", "blocked", 3, "expected   no"),
        ("0.14,0.35", "free", 3, "expected   no"),
        ("0.14,0.35", "blocked", 0, "expected   yes"),
        ("9,0", "blocked", 0, "expected   yes"),
    ] {
        place.run(&files, &format!("--at {at} --expect {expected}")).exits(code).says(&[answer]);
        place.run(&files, &format!("--at {at} --expect {expected} --json")).exits(code);
    }
    place.run(&files, "--at 0,0 --expect fre").refused(2, &["fre", "free"]);
    place.run(&files, "--at 10deg,45deg --clearance 0.05").says(&["less than the clearance of 50 mm"]);
}

#[test]
fn compare_lists_every_planner() {
    let place = Place::new().with("world.toml", FREE);
    let files = ["compare".into(), shipped("robots/planar_2r.urdf"), "world.toml".into()];
    let planners = ["visibility", "trapezoid", "wavefront"];
    let options = "--planner visibility --planner trapezoid --planner wavefront --quiet";
    let text = place.run(&files, options).succeeds_silently();
    assert!(planners.iter().all(|p| text.stdout.contains(p)), "{}", text.stdout);
    let json = place.run(&files, &format!("{options} --json --picture all.svg")).json();
    for (row, name) in json["planners"].as_array().unwrap().iter().zip(planners) {
        assert_eq!((row["planner"].as_str(), row["outcome"].as_str()), (Some(name), Some("found")));
        assert!(row["ratio"].as_f64().unwrap() >= 1.0);
    }
    assert!(place.read("all.svg").contains("</svg>"));
    let csv = place.run(&files, &format!("{options} --csv")).stdout;
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns, [columns[0]; 4]);
}

#[test]
fn recheck_accepts_true_bounds_and_no_others() {
    let place = Place::new();
    let worlds = [
        ("planar_2r", "shelf", "--metric weighted --weights 1,0.4"),
        ("gantry", "annulus_open", ""),
        ("polar", "thin_wall_open", "--metric time"),
    ];
    for (robot, world, options) in worlds {
        let files = [format!("robots/{robot}.urdf"), format!("workspaces/{world}.toml")].map(|file| shipped(&file));
        let mut made = place.run(&files, &format!("{options} --json --output made.json")).json();
        let recheck = [&["recheck".to_owned()], &files[..]].concat();
        let holds = place.run(&recheck, "--proof made.json");
        assert_eq!((holds.code, holds.stdout.starts_with("the bound holds")), (0, true), "{world}: {}", holds.stderr);
        // One bound is too high, one is without a length, and one is that of another world.
        let lower = made["optimum"]["lower_bound"].as_f64().unwrap();
        for (wrong, report) in [(lower * (1.0 + 2e-4), "are not valid bounds"), (lower * 1.01, "not confirmed")] {
            made["optimum"]["lower_bound"] = wrong.into();
            place.write("wrong.json", made.to_string());
            place.run(&recheck, "--proof wrong.json").refused(1, &["wrong.json", report]);
            made["optimum"]["length"] = (lower * 1.02).into();
        }
    }
    let shelf = [shipped("robots/planar_2r.urdf"), shipped("workspaces/shelf.toml")];
    place.run(&shelf, "--quiet --output shelf.json");
    let elsewhere = ["recheck".into(), shelf[0].clone(), shipped("workspaces/two_branches.toml")];
    place.run(&elsewhere, "--proof shelf.json").refused(1, &["not confirmed"]);
}

#[test]
fn recheck_accepts_true_proofs_and_no_others() {
    let place = Place::new();
    let [urdf, closed, open] =
        ["robots/planar_2r.urdf", "workspaces/limits_closed.toml", "workspaces/limits_open.toml"].map(shipped);
    let made =
        place.run(&[&urdf, &closed], "--planner subdivision --json --quiet --output proof.json --picture proof.svg");
    assert_eq!((made.code, made.stderr.as_str()), (3, ""));
    let boxes = made.json()["proof"].as_array().unwrap().len();
    assert!(place.read("proof.svg").contains("proof: separating boxes"));
    let judge = |world: &str, options: &str| place.run(&["recheck", &urdf, world], &format!("--proof {options}"));
    let holds = judge(&closed, "proof.json");
    assert_eq!((holds.code, holds.stdout.contains(&format!("every goal ({boxes} box"))), (0, true), "{}", holds.stderr);
    // The proof belongs to another problem, the goal is on the start's side, the proof has a hole, or it is missing.
    judge(&open, "proof.json").refused(1, &["proof.json", "does not hold"]);
    judge(&closed, "proof.json --goal 0.4,0").refused(1, &["do not separate"]);
    let mut lesser = made.json();
    lesser["proof"].as_array_mut().unwrap().truncate(boxes / 2);
    place.write("lesser.json", lesser.to_string());
    judge(&closed, "lesser.json").refused(1, &["do not separate"]);
    place.write("none.json", r#"{"status": "found"}"#);
    judge(&closed, "none.json").refused(1, &["holds no proof", "no bound"]);
    judge(&closed, "absent.json").refused(1, &["absent.json"]);
    place.run(&["recheck", &urdf, &closed], "").refused(2, &["--proof"]);
}

/// Checks that gaps below the resolution of doubles cause no further search.
#[test]
fn gaps_below_the_rounding_of_doubles_end() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    let shelf = shipped("workspaces/shelf.toml");
    for options in ["--gap 1e-14", "--planner visibility --gap 1e-300", "--metric weighted --weights 1e-12,1e-12"] {
        let done = place.run(&[&robot, &shelf], &format!("{options} --quiet --json"));
        assert_eq!((done.code, &done.json()["status"]), (0, &serde_json::json!("found")), "{options}");
    }
}

/// Checks that the first of more than two words is reported as a misspelled command, not as a file.
#[test]
fn a_misspelled_command_is_reported_as_such() {
    let done = Place::new().run(&["verfy", "no.urdf", "no.toml", "plan.csv"], "");
    done.refused(2, &["there is no command and no file \"verfy\""]);
}
