//! Problems as JSON lines: each answer equals that of the main job.

use super::*;
use std::io::{BufRead, BufReader, Write};

/// Runs `batch` on these lines.
fn run_batch(place: &Place, lines: &[Value], options: &str) -> Done {
    place.write("problems.jsonl", lines.iter().map(|line| format!("{line}\n")).collect::<String>());
    place.run(&["batch", "problems.jsonl"], options)
}

impl Done {
    fn rows(&self) -> Vec<Value> {
        self.stdout.lines().map(|row| serde_json::from_str(row).unwrap()).collect()
    }
}

#[test]
fn rows_equal_the_results_of_plan() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let walled = shipped("workspaces/singular_closed.toml");
    place.write("world.toml", FREE);
    // Compares options of the main job, a line, and the main job's files.
    let jobs = [
        (vec![], json!({"id": 1, "urdf": urdf, "world": world}), [&urdf, &world]),
        (
            vec!["--planner=wavefront", "--cells=60x50"],
            json!({"urdf": urdf, "world": world, "options": {"planner": "wavefront", "cells": [60, 50]}, "id": "second"}),
            [&urdf, &world],
        ),
        (
            vec!["--start=-0.5,0.25", "--goal-tip=0.5,1", "--clearance=0.01"],
            json!({"urdf": urdf, "world": world, "id": [3, null],
                "options": ["--start=-0.5,0.25", "--goal-tip=0.5,1", "--clearance=0.01"]}),
            [&urdf, &world],
        ),
        (vec![], json!({"urdf_text": read(&urdf), "world": walled, "id": null}), [&urdf, &walled]),
    ];
    let lines: Vec<Value> = jobs.iter().map(|job| job.1.clone()).collect();
    let done = run_batch(&place, &lines, "").exits(0);
    let rows = done.rows();
    assert_eq!(rows.len(), jobs.len());
    for ((words, line, files), mut row) in jobs.iter().zip(rows) {
        assert_eq!(row.as_object_mut().unwrap().remove("id"), line.get("id").cloned());
        let alone = place.run(files, &[words.join(" "), "--json".into()].join(" "));
        assert_eq!(row, alone.json(), "{line}");
    }
    // The same bytes, whoever answers which.
    for jobs in [2, 5] {
        let again = run_batch(&place, &vec![lines.clone(); 5].concat(), &format!("--jobs {jobs}"));
        assert_eq!(again.stdout, done.stdout.repeat(5), "{jobs}");
    }
}

#[test]
fn worlds_are_files_texts_and_objects() {
    let place = Place::new();
    let urdf = shipped("robots/planar_2r.urdf");
    place.write("world.toml", FREE);
    let keys = json!({"start": {"joints": [-0.9, 0.4]}, "goal": {"joints": [1.55, -0.35]}});
    let lines = [
        json!({"urdf": urdf, "world": "world.toml"}),
        json!({"urdf": urdf, "world_text": FREE}),
        json!({"urdf": urdf, "world": keys}),
        // Other limits are another robot.
        json!({"urdf": urdf, "world_text": format!("{FREE}[robot]\nvelocity = {{ shoulder = 0.1 }}\n")}),
        json!({"urdf": urdf, "world": "world.toml"}),
    ];
    let rows = run_batch(&place, &lines, "--fields trajectory,name,status").rows();
    assert_eq!(rows[0]["name"], "world");
    assert_eq!(rows[0].as_object().unwrap().keys().collect::<Vec<_>>(), ["name", "status", "trajectory"]);
    assert!([1, 2, 4].iter().all(|&k| rows[k] == rows[0]), "{rows:?}");
    assert_ne!(rows[3], rows[0]);
}

#[test]
fn rows_equal_the_findings_of_verify() {
    let place = Place::new();
    let [urdf, world] = shelf();
    place.run(&shelf(), "--quiet --output plan.json --output plan.csv").exits(0);
    let kit = [shipped("robots/scara.urdf"), shipped("workspaces/tasks/kitting_cell.toml")];
    place.run(&kit, "--quiet --output kit.json").exits(0);
    place.write("cut.csv", "shoulder,elbow\n-0.9,0.4\n1.55,-0.35\n");
    let jobs = [
        ("plan.json", vec![], [&urdf, &world]),
        ("plan.csv", vec![], [&urdf, &world]),
        ("cut.csv", vec![], [&urdf, &world]),
        ("cut.csv", vec!["--anywhere", "--clearance=0.01"], [&urdf, &world]),
        ("plan.json", vec!["--goal=1,1", "--unwrap"], [&urdf, &world]),
        ("kit.json", vec![], [&kit[0], &kit[1]]),
    ];
    let lines = jobs.clone().map(|(motion, options, [urdf, world])| {
        json!({"id": motion, "urdf": urdf, "world": world, "verify": motion, "options": options})
    });
    let rows = run_batch(&place, &lines, "--jobs 2").exits(0).rows();
    let mut verdicts = Vec::new();
    for ((motion, options, [urdf, world]), mut row) in jobs.iter().zip(rows.clone()) {
        assert_eq!(row.as_object_mut().unwrap().remove("id"), Some(json!(motion)));
        let words = [vec!["--json"], options.clone()].concat().join(" ");
        let alone = place.run(&["verify", urdf, world, motion], &words).json();
        assert_eq!(row, alone, "{motion} {options:?}");
        verdicts.push(row["verdict"].as_str().unwrap().to_owned());
    }
    assert_eq!(verdicts, ["free", "free", "collision", "collision", "ends", "free"]);
    // Every field can be selected.
    let names: std::collections::BTreeSet<_> =
        rows.iter().flat_map(|row| row.as_object().unwrap().keys()).filter(|name| *name != "id").collect();
    let names = names.into_iter().map(String::as_str).collect::<Vec<_>>().join(",");
    assert_eq!(run_batch(&place, &lines, &format!("--fields {names}")).rows(), rows);
    let short = run_batch(&place, &lines, "--fields samples,status,verdict").stdout;
    assert!(short.starts_with("{\"id\":\"plan.json\",\"verdict\":\"free\",\"samples\":"), "{short}");
    // A motion as an object, and lines that plan beside lines that judge.
    let path: Value = serde_json::from_str::<Value>(&place.read("plan.json")).unwrap()["path"].clone();
    let mut cut = path.clone();
    cut.as_array_mut().unwrap().drain(1..path.as_array().unwrap().len() - 1);
    let judged = |motion: Value| json!({"urdf": urdf, "world": world, "verify": motion});
    let lines = [
        judged(json!({"path": path})),
        json!({"urdf": urdf, "world": world}),
        judged(json!({"path": cut})),
        judged(json!(7)),
        judged(json!("none.csv")),
        json!({"urdf": urdf, "world": world, "verify": "plan.csv", "options": ["--planner=wavefront"]}),
    ];
    let rows = run_batch(&place, &lines, "--fields status,verdict").exits(0).rows();
    assert_eq!(rows[..3], [json!({"verdict": "free"}), json!({"status": "found"}), json!({"verdict": "collision"})]);
    let messages = rows[3..].iter().map(|row| row["message"].as_str().unwrap());
    for (message, part) in messages.zip(["`verify` must be a path", "cannot be read", "--planner"]) {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn a_bad_line_is_a_row() {
    let place = Place::new();
    let [urdf, world] = shelf();
    place.write("world.toml", format!("{FREE}clearanse = 1\n"));
    let bad: [(&str, &str, &[&str]); 11] = [
        ("{", "input", &["not JSON", "EOF"]),
        ("[1, 2]", "input", &["not a JSON object"]),
        ("\u{1b}", "input", &["not JSON"]),
        (r#"{"id": 1}"#, "input", &["give either `urdf` or `urdf_text`"]),
        (r#"{"urdf": "U", "id": 2}"#, "input", &["give either `world` or `world_text`"]),
        (r#"{"urdf": "U", "world": "W", "wrold": 1}"#, "input", &["unknown field `wrold`"]),
        (r#"{"urdf": "U", "world": 7}"#, "input", &["`world` must be a path"]),
        (r#"{"urdf": "U", "world": {"start": null}}"#, "input", &["cannot be written as TOML"]),
        (r#"{"urdf": "U", "world": "W", "options": ["--planer=x"]}"#, "usage", &["--planer"]),
        (r#"{"urdf": "U", "world": "W", "options": {"cells": {"a": 1}}}"#, "input", &["cells cannot be"]),
        (r#"{"urdf": "U", "world": "world.toml"}"#, "input", &["unknown key", "clearanse"]),
    ];
    let good = json!({"urdf": urdf, "world": world, "id": "good"}).to_string();
    let mut text = String::new();
    for (line, ..) in &bad {
        text += &format!(
            "{}\n  \n{good}\n",
            line.replace("\"U\"", &json!(urdf).to_string()).replace("\"W\"", &json!(world).to_string())
        );
    }
    place.write("problems.jsonl", &text);
    let done = place.run(&["batch", "problems.jsonl"], "--fields length").succeeds_silently();
    let rows = done.rows();
    assert_eq!(rows.len(), 2 * bad.len());
    for ((number, (line, kind, parts)), pair) in bad.iter().enumerate().zip(rows.chunks(2)) {
        let [error, good] = pair else { unreachable!() };
        assert_eq!((&error["status"], &error["kind"]), (&"error".into(), &(*kind).into()), "{line}: {error}");
        let message = error["message"].as_str().unwrap();
        assert!(parts.iter().all(|part| message.contains(part)), "{line}: {message}");
        if error["file"] == "problems.jsonl" {
            assert_eq!(error["line"], 3 * number + 1, "{error}");
            assert!(error["cure"].is_string(), "{error}");
        }
        assert!(good["id"] == "good" && good["length"].is_f64(), "{good}");
    }
    assert_eq!((&rows[8]["id"], &rows[20]["file"]), (&json!(2), &json!("world.toml")));
    place.write("problems.jsonl", "[start]\njoints = [1, 2]\n");
    let done = place.run(&["batch", "problems.jsonl"], "");
    assert_eq!((done.code, done.rows().len()), (1, 2));
    assert!(done.stderr.contains("problems.jsonl: no line is a JSON object") && done.stderr.contains("hint:"));
    let done = place.run(&["batch"], "");
    assert_eq!((done.code, done.stdout, done.stderr), (0, String::new(), String::new()));
    place.run(&["batch", "none.jsonl"], "").refused(1, &["none.jsonl", "cannot be read", "hint:"]);
    place.run(&["batch"], "--fields lenght").refused(2, &["lenght", "length"]);
}

#[test]
fn an_id_comes_back_as_it_is_written() {
    let place = Place::new();
    let [urdf, world] = shelf().map(|path| json!(path).to_string());
    let ids = ["123456789012345678901234567890", "1e400", "-0.10", "[1e999, {\"a\": 1.0}]", "\"\\u00e4\"", "null"];
    let lines = ids.map(|id| format!("{{\"id\": {id}, \"urdf\": {urdf}, \"world\": {world}}}\n")).concat();
    // A byte order mark is not part of the first line, and a blank line behind it is skipped.
    for mark in ["", "\u{feff}", "\u{feff}\n"] {
        place.write("problems.jsonl", format!("{mark}{lines}{{\"id\": 1e400}}\n{{\"id\": 1, \"urdf\": 1e400}}\n"));
        let done = place.run(&["batch", "problems.jsonl"], "--fields status").succeeds_silently();
        let rows: Vec<&str> = done.stdout.lines().collect();
        let found = ids.map(|id| format!("{{\"id\":{id},\"status\":\"found\"}}"));
        assert_eq!(rows[..ids.len()], found);
        assert!(
            rows[6].starts_with("{\"id\":1e400,\"status\":\"error\"") && rows[6].contains("give either `urdf`"),
            "{}",
            rows[6]
        );
        assert!(rows[7].starts_with("{\"id\":1,\"status\":\"error\"") && rows[7].contains("at column"), "{}", rows[7]);
    }
    place.run(&["batch", "."], "").refused(1, &[".: cannot be read: it is a folder", "hint: give a file"]);
    place.write("bytes.jsonl", "\u{feff}\u{feff}{}\n");
    place.run(&["batch", "bytes.jsonl"], "").exits(1);
}

#[test]
fn answers_come_while_lines_do_and_end_with_their_reader() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let line = json!({"urdf": urdf, "world": world}).to_string() + "\n";
    let mut command = place.command();
    command.args(["batch", "--jobs=2", "--fields=status"]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    let (mut to, mut from) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
    for _ in 0..3 {
        to.write_all(line.as_bytes()).unwrap();
        let mut row = String::new();
        from.read_line(&mut row).unwrap();
        assert_eq!(row, "{\"status\":\"found\"}\n");
    }
    drop(from);
    // The program ends at the first answer that it cannot write, and reads no further lines.
    while to.write_all(line.as_bytes()).is_ok() {}
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr), (Some(0), Vec::new()));
}

/// Checks that a problem that exceeds its time limit is answered, and so are the problems after it.
#[test]
fn each_problem_has_an_answer_in_time() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let lines: Vec<Value> = (0..3).map(|id| json!({"id": id, "urdf": urdf, "world": world})).collect();
    let done = run_batch(&place, &lines, "--time 1e-9").exits(0);
    let stopped = |id: i32| json!({"id": id, "status": "unknown", "reason": "stopped after 0.000000001 s"});
    assert_eq!(done.rows(), [stopped(0), stopped(1), stopped(2)]);
    let unhurried = run_batch(&place, &lines, "--time 1000 --jobs 2");
    assert_eq!(unhurried.stdout, run_batch(&place, &lines, "").stdout);
    assert_eq!(run_batch(&place, &lines, "--time 0").code, 2);
}

/// Checks worlds whose own start and goal are blocked. They can be used, because each line requests another start and
/// goal.
#[test]
fn worlds_whose_own_ends_are_blocked_are_answered_line_by_line() {
    let place = Place::new();
    let [urdf, _] = shelf();
    let crate_at =
        "[[obstacle]]\nname = \"crate\"\npolygon = [[0.85, -0.15], [1.15, -0.15], [1.15, 0.15], [0.85, 0.15]]\n";
    place.write("world.toml", format!("start.joints = [0, 0]\ngoal.joints = [0.05, 0]\n{crate_at}"));
    let ends = [([0.0, 0.0], [1.2, 0.0]), ([1.2, 0.0], [0.0, 0.0]), ([1.2, 0.3], [2.0, 0.1]), ([1.0, 0.0], [2.0, 0.5])];
    let line = |(id, (start, goal)): (usize, &([f64; 2], [f64; 2]))| json!({"id": id, "urdf": urdf, "world": "world.toml", "options": {"start": start, "goal": goal}});
    let mut lines: Vec<Value> = ends.iter().enumerate().map(line).collect();
    lines.push(json!({"id": 4, "urdf": urdf, "world": "world.toml"}));
    let done = run_batch(&place, &lines, "--fields status").exits(0);
    let report: Vec<Value> = done.rows().iter().map(|row| json!([row["id"], row["status"], row["kind"]])).collect();
    let found = |id: i32| json!([id, "found", null]);
    let refused = |id: i32, kind: &str| json!([id, "error", kind]);
    assert_eq!(report, [refused(0, "start"), refused(1, "goal"), found(2), found(3), refused(4, "start")]);
}
