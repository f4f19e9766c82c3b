//! Output: streams, files, formats, exit codes.

use super::*;
use std::process::Stdio;

/// Checks the members of a result on which scripts rely, and which every result has.
fn contract(done: &Done) -> Value {
    let result = done.json();
    let found = result["status"] == "found";
    assert!(result["planner"].is_string() && result["joints"].as_array().is_some_and(|j| j.len() == 2));
    assert_eq!(result["certified"], json!(found));
    for key in ["path", "length", "clearance", "trajectory"] {
        assert!(result.as_object().unwrap().contains_key(key), "{key}");
        assert_eq!(result[key].is_null(), !found, "{key}");
    }
    result
}

#[test]
fn each_outcome_has_its_exit_code_and_json() {
    let place = Place::new();
    let found = place.run(&shelf(), "--json");
    let result = contract(&found);
    assert_eq!((found.code, found.stderr.as_str()), (0, ""));
    let path: Vec<[f64; 2]> = serde_json::from_value(result["path"].clone()).unwrap();
    assert_eq!((path[0], path[path.len() - 1]), ([-0.9, 0.4], [1.55, -0.35]));
    let length: f64 = path.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    assert!((result["length"].as_f64().unwrap() - length).abs() < 1e-12);
    let samples = result["trajectory"]["time"].as_array().unwrap().len();
    for key in ["position", "velocity", "acceleration"] {
        assert_eq!(result["trajectory"][key].as_array().unwrap().len(), samples);
    }
    for (k, top) in [2.0, 3.0].into_iter().enumerate() {
        let speeds = result["trajectory"]["velocity"].as_array().unwrap().iter().map(|v| v[k].as_f64().unwrap().abs());
        assert!(speeds.fold(0.0, f64::max) <= top * (1.0 + 1e-12));
    }

    let arm = shipped("robots/planar_2r.urdf");
    let walled_in = place.run(&[&arm, &shipped("workspaces/no_path.toml")], "--json --quiet");
    assert_eq!((walled_in.code, &contract(&walled_in)["status"]), (3, &json!("infeasible")));
    let slot = [&arm, &shipped("workspaces/narrow_slot.toml")];
    let unknown = place.run(&slot, "--json --quiet --planner wavefront --levels 1 --cells 8");
    assert_eq!((unknown.code, &contract(&unknown)["status"]), (4, &json!("unknown")));
    assert_eq!((unknown.stderr.as_str(), unknown.json()["reason"].is_string()), ("", true));
}

#[test]
fn a_motion_to_the_start_has_length_zero() {
    let done = Place::new().plan(FREE, "--goal=-0.9,0.4 --json");
    assert_eq!((done.code, done.json()["path"].clone()), (0, json!([[-0.9, 0.4]])));
    // Serialised, -0.0 and 0.0 differ.
    done.says(&["\"length\": 0.0"]);
}

#[test]
fn continuous_joints_continue_from_the_value_of_the_start() {
    let files = [shipped("robots/planar_2r_continuous.urdf"), shipped("workspaces/wrap_around.toml")];
    let result = Place::new().run(&files, "--start 7.0,0.3 --json").json();
    let path: Vec<[f64; 2]> = serde_json::from_value(result["path"].clone()).unwrap();
    assert_eq!(path[0], [7.0, 0.3]);
    let steps = path.windows(2).map(|w| (w[1][0] - w[0][0]).abs().max((w[1][1] - w[0][1]).abs()));
    assert!(steps.fold(0.0, f64::max) < std::f64::consts::PI, "{path:?}");
    let turns = (path[path.len() - 1][0] - 0.7) / std::f64::consts::TAU;
    assert!((turns - turns.round()).abs() < 1e-12, "{path:?}");
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let place = Place::new();
    let names = ["a.json", "a.csv", "a.yaml", "a.yml", "b.json"];
    let outputs: String = names.iter().map(|n| format!("--output {n} ")).collect();
    let options = format!("{outputs} --picture a.svg --picture a.html");
    let first = place.run(&shelf(), &options).exits(0);
    let all = || names.iter().chain(&["a.svg", "a.html"]).map(|n| place.read(n)).collect::<Vec<_>>();
    assert!(names.iter().all(|n| first.stdout.contains(n)), "{}", first.stdout);
    let before = all();
    assert_eq!((before[0] == before[4], before[2] == before[3]), (true, true));
    let json = place.run(&shelf(), &format!("{options} --json"));
    assert_eq!((all() == before, json.stdout == before[0]), (true, true));
    let timed = place.run(&shelf(), "--json --timings").json();
    assert!(timed["timings"]["query"].is_number() && !before[0].contains("timings"));
}

#[test]
fn the_message_and_the_table_agree() {
    let place = Place::new();
    let result = place.run(&shelf(), "--json --output a.csv --output a.yaml").json();
    let rows: Vec<Vec<f64>> = place
        .read("a.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let message: Value = serde_saphyr::from_str(&place.read("a.yaml")).unwrap();
    let points = message["points"].as_array().unwrap();
    assert_eq!((points.len(), message["joint_names"].clone()), (rows.len(), result["joints"].clone()));
    for (k, (row, point)) in rows.iter().zip(points).enumerate() {
        let position = &result["trajectory"]["position"][k];
        assert_eq!((&json!([row[1], row[2]]), &point["positions"]), (position, position));
        let since = &point["time_from_start"];
        let seconds = since["sec"].as_f64().unwrap() + 1e-9 * since["nanosec"].as_f64().unwrap();
        assert!((seconds - row[0]).abs() <= 1e-9);
    }
}

#[test]
fn files_that_cannot_be_written_are_known_before_any_work() {
    let place = Place::new();
    std::fs::create_dir(place.path("folder.json")).unwrap();
    for (option, part) in [
        ("--output folder.json", "is not a file"),
        ("--output absent/a.json", "the folder absent does not exist"),
        ("--picture absent/a.svg", "the folder absent does not exist"),
        ("--output first.json --output absent/a.json", "the folder absent does not exist"),
    ] {
        place.run(&shelf(), option).refused(1, &[part]);
    }
    let left = std::fs::read_dir(place.0.path()).unwrap().count();
    assert_eq!(left, 1, "only the folder that was there");
}

#[test]
fn without_a_trajectory_tables_stay_as_they_were() {
    let place = Place::new().with("a.csv", "old");
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/no_path.toml")];
    let done = place.run(&files, "--output a.csv --output a.json");
    assert_eq!((done.code, place.read("a.csv").as_str()), (3, "old"));
    assert!(done.stderr.contains("a.csv is not written") && place.read("a.json").contains("infeasible"));
}

#[cfg(feature = "mcap")]
#[test]
fn recordings_hold_every_sample_and_are_the_same_each_time() {
    let place = Place::new();
    let result = place.run(&shelf(), "--json --output a.mcap").json();
    place.run(&shelf(), "--timings --output b.MCAP");
    let file = std::fs::read(place.path("a.mcap")).unwrap();
    assert!(file == std::fs::read(place.path("b.MCAP")).unwrap());
    let samples = result["trajectory"]["time"].as_array().unwrap().len() as u64;
    let summary = mcap::Summary::read(&file).unwrap().expect("a summary");
    let statistics = summary.stats.as_ref().expect("statistics");
    let count = |topic: &str| {
        let (number, _) = summary.channels.iter().find(|(_, channel)| channel.topic == topic).unwrap();
        statistics.channel_message_counts[number]
    };
    // There is one message per state and per set of link frames, and one that holds them all.
    assert_eq!(["/joint_states", "/tf", "/joint_trajectory"].map(count), [samples, samples, 1]);
    let end = result["duration"].as_f64().unwrap();
    assert!((statistics.message_end_time as f64 * 1e-9 - end).abs() <= 0.6e-9);

    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/no_path.toml")];
    let none = place.run(&files, "--output none.mcap").exits(3);
    assert!(none.stderr.contains("none.mcap is not written") && !place.path("none.mcap").exists(), "{}", none.stderr);
}

#[cfg(not(feature = "png"))]
#[test]
fn a_program_without_png_says_so_before_any_work() {
    let place = Place::new();
    for picture in ["a.png", "a.gif"] {
        let done = place.run(&shelf(), &format!("--output a.json --picture {picture}"));
        done.refused(1, &[picture, "built without pixels", ".svg"]);
        assert!(!place.path("a.json").exists());
    }
}

#[cfg(feature = "png")]
#[test]
fn a_picture_that_moves_is_written_beside_others() {
    let place = Place::new();
    let done =
        place.run(&shelf(), "--planner first --picture plan.gif --picture plan.svg --picture plan.html").exits(0);
    let bytes = std::fs::read(place.path("plan.gif")).unwrap();
    let (count, pixels) = crate::draw::moving::last_picture(&bytes, 960);
    assert!(count > 40 && pixels.len() == 960 * 494, "{count} pictures");
    // Formats that play motions contain the replay; still pictures do not.
    let page = std::fs::read_to_string(place.path("plan.html")).unwrap();
    assert!(page.contains("\"replay\":[{\"caption\":") && done.stdout.contains("plan.gif"));
    // If the start is the goal, nothing moves.
    place.run(&shelf(), "--goal=-0.9,0.4 --picture still.gif").exits(0);
    assert!(place.path("still.gif").exists());
}

#[cfg(not(feature = "mcap"))]
#[test]
fn a_program_without_mcap_says_so_before_any_work() {
    let place = Place::new();
    place.run(&shelf(), "--output a.json --output a.mcap").refused(1, &["a.mcap", "built without MCAP", ".yaml"]);
    assert!(!place.path("a.json").exists());
}

#[cfg(not(feature = "gpu"))]
#[test]
fn a_program_without_gpu_says_so_before_any_work() {
    let place = Place::new();
    let done = place.run(&shelf(), "--output a.json --planner harmonic --on gpu");
    done.refused(1, &["--on gpu", "built without GPU", "--features gpu"]);
    assert!(!place.path("a.json").exists());
    // Contradictory options are a wrong command line, with or without it.
    let done = place.run(&shelf(), "--planner harmonic --on gpu --relaxation sor --order rows");
    done.refused(2, &["--on gpu", "red-black"]);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let place = Place::new();
    let mut child = place.command().args(shelf()).arg("--json").stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn full_devices_are_an_error_and_no_panic() {
    let place = Place::new();
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let out = place.command().args(shelf()).stdout(full()).output().unwrap();
    assert_eq!(out.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&out.stderr).starts_with("error: stdout"));
    let code = place.command().args(["no.urdf", "no.toml"]).stderr(full()).status().unwrap().code();
    assert_eq!(code, Some(1));
}

#[test]
fn paths_come_with_a_bound_on_the_optimum() {
    let here = Place::new();
    let optimum = |options: &str| {
        let result = here.run(&shelf(), &format!("--json {options}")).exits(0).json();
        let optimum = result["optimum"].clone();
        let [length, lower] = ["length", "lower_bound"].map(|key| optimum[key].as_f64().unwrap());
        assert!(0.0 < lower && lower <= length, "{optimum}");
        assert!((optimum["gap"].as_f64().unwrap() - (length / lower - 1.0)).abs() < 1e-12, "{optimum}");
        (optimum, result["length"].as_f64().unwrap())
    };
    let (plain, length) = optimum("");
    assert_eq!((plain["metric"].as_str(), plain["length"].as_f64()), (Some("euclidean"), Some(length)));
    assert!(plain["gap"].as_f64().unwrap() <= 1e-4, "{plain}");
    let (tight, shorter) = optimum("--gap 0.00001");
    assert!(tight["gap"].as_f64().unwrap() <= 1e-5 && shorter < length, "{tight}");
    let (graph, longer) = optimum("--planner visibility --gap 0.001");
    assert!(graph["gap"].as_f64().unwrap() <= 1e-3 && longer > shorter, "{graph}");
    // The shoulder and the elbow have speeds of 2 and 3 rad/s: the slower joint alone must turn by 2.45 rad.
    let (time, _) = optimum("--metric time --gap 0.01");
    assert!(time["metric"] == "time" && time["length"].as_f64().unwrap() >= 2.45 / 2.0, "{time}");
    let (weighted, euclidean) = optimum("--metric weighted --weights 2,2");
    assert_eq!(weighted["weights"], serde_json::json!([2.0, 2.0]));
    assert!((weighted["length"].as_f64().unwrap() - 2.0 * euclidean).abs() < 1e-9, "{weighted}");
    let text = here.run(&shelf(), "--metric time").stdout;
    assert!(text.contains("optimum") && text.contains("s at top speed; every path has at least"), "{text}");
}

#[test]
fn an_unreachable_gap_is_reported() {
    let here = Place::new();
    let slot = ["robots/polar.urdf", "workspaces/thin_wall_open.toml"].map(shipped);
    here.run(&slot, "--gap 1e-9 --levels 1 --json").exits(0).warns(&["warning: the requested gap of", "--levels"]);
}

/// Checks that lengths in joint space have their unit wherever they are printed and drawn, and the digits of the result.
#[test]
fn lengths_of_paths_have_units() {
    let cases =
        [("planar_2r", "shelf", "rad"), ("gantry", "gantry_maze", "m"), ("polar", "polar_gate", "in joint space")];
    let here = Place::new();
    for (robot, world, unit) in cases {
        let files = [format!("robots/{robot}.urdf"), format!("workspaces/{world}.toml")].map(|file| shipped(&file));
        let result = here.run(&files, "--json --picture plan.svg").exits(0).json();
        let length = format!("length {:.4} {unit}", result["length"].as_f64().unwrap());
        here.run(&files, "").says(&[&length, &format!("optimum    {length}; every path has at least")]);
        let picture = here.read("plan.svg");
        assert!(picture.contains(&format!("{length}, proven clearance")), "{length}: {picture}");
        let explained = here.run(&[&["explain".to_owned()][..], &files].concat(), "").stdout;
        assert!(explained.contains(&format!("shortest   {length}")), "{length}: {explained}");
    }
    // Times and lengths in motor angles have units of their own.
    let world = std::fs::read_to_string(shipped("workspaces/shelf.toml")).unwrap();
    let world = world + "\n[robot]\ndrives = { elbow = \"base\", ratio = 1.0 }\n";
    let motors = here.run_in(&shipped("robots/planar_2r.urdf"), world, "--metric motor");
    let line = motors.stdout.lines().find(|line| line.starts_with("optimum")).unwrap().to_owned();
    assert!(
        line.starts_with("optimum    length in motor angles") && line.contains(" rad; every path has at least"),
        "{line}"
    );
}
