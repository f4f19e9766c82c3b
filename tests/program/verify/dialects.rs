//! Tables as spreadsheets and loggers write them: the same motion, whatever separates its values.

use std::process::Command;

const PLAIN: &str = "time,shoulder,elbow\n0,-0.9,0.4\n1,-0.8,0.4\n2,-0.7,0.5\n";

/// What `verify` makes of a table: exit code, and the JSON or the message.
fn verify(table: &str) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("world.toml"), "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [-0.7, 0.5]\n")
        .unwrap();
    std::fs::write(folder.path().join("m.csv"), table).unwrap();
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/robots/planar_2r.urdf");
    let done = Command::new(env!("CARGO_BIN_EXE_cplan"))
        .current_dir(folder.path())
        .args(["verify", robot, "world.toml", "m.csv", "--json"])
        .output()
        .unwrap();
    (done.status.code().unwrap(), String::from_utf8(done.stdout).unwrap())
}

/// The findings without the notes.
fn findings(table: &str) -> serde_json::Value {
    let (code, json) = verify(table);
    assert_eq!(code, 0, "{table}: {json}");
    let mut json: serde_json::Value = serde_json::from_str(&json).unwrap();
    json.as_object_mut().unwrap().remove("notes");
    json
}

#[test]
fn separators_and_comments_make_no_difference() {
    let plain = findings(PLAIN);
    let comments = PLAIN.replace('\n', "\n# as logged\n");
    for table in [
        PLAIN.replace(',', ";"),
        PLAIN.replace(',', "\t"),
        PLAIN.replace(',', " ; ").replace('\n', "\r\n"),
        comments.clone(),
        format!("# logged, by hand\n{comments}"),
        format!("# {PLAIN}"),
        format!("# a log\n# {}", PLAIN.replace(',', "\t")),
        PLAIN.replace("1,-0.8,0.4\n", "1,-0.8,0.4\n1,-0.8,0.4\n1,-0.8,0.4\n"),
    ] {
        assert_eq!(findings(&table), plain, "{table}");
    }
}

#[test]
fn what_is_taken_is_said_and_what_is_not_clear_is_refused() {
    let (_, json) = verify(&PLAIN.replace("1,-0.8,0.4\n", "1,-0.8,0.4\n1,-0.8,0.4\n").replace(',', ";"));
    for part in ["1 sample repeats the one before it; taken once", "separated by semicolons"] {
        assert!(json.contains(part), "no {part:?} in {json}");
    }
    // Two places at one time, commas for decimals, and two kinds of separators.
    for (table, part) in [
        (PLAIN.replace("2,-0.7", "1,-0.7"), "line 4"),
        (PLAIN.replace(',', ";").replace('.', ","), "no number"),
        (PLAIN.replacen(',', ";", 1), "time;shoulder"),
    ] {
        let (code, json) = verify(&table);
        assert_eq!(code, 1, "{table}: {json}");
        let error: serde_json::Value = serde_json::from_str(&json).unwrap();
        let whole = format!("line {}: {} {}", error["line"], error["message"], error["cure"]);
        assert!(whole.contains(part) && error["cure"].is_string(), "{part:?} is not in {whole}");
    }
}

/// Headers as PlotJuggler and loggers write them; dates keep their nanoseconds.
#[test]
fn names_of_topics_and_units_make_no_difference() {
    let plain = findings(PLAIN);
    let header = |header: &str| PLAIN.replacen("time,shoulder,elbow", header, 1);
    let dated = |header: &str| {
        let rows = [
            ("1764225000.123456789", "-0.9,0.4"),
            ("1764225001.123456789", "-0.8,0.4"),
            ("1764225002.123456789", "-0.7,0.5"),
        ];
        rows.iter().fold(format!("{header}\n"), |table, (time, row)| format!("{table}{time},{row}\n"))
    };
    for table in [
        header("__time,/joint_states/shoulder/position,/joint_states/elbow/position"),
        header("time [s],shoulder [rad],elbow(rad)"),
        header("time [s],/joint_states/shoulder/position [rad],elbow_position [rad]"),
        "time [ms],shoulder,elbow\n0,-0.9,0.4\n1000,-0.8,0.4\n2000,-0.7,0.5\n".into(),
        // Two sources in one table, which log at different moments.
        "__time,/a/shoulder/position,/a/elbow/position,/b/load\n0,-0.9,0.4,\n0.5,,,7\n1,-0.8,0.4,\n2,-0.7,0.5,\n2,,,7\n".into(),
    ] {
        assert_eq!(findings(&table), plain, "{table}");
    }
    let mut late = findings(&dated("__time,shoulder,elbow"));
    late["nearest"]["time"] = plain["nearest"]["time"].clone();
    assert_eq!((&late["duration"], &late["samples"]), (&plain["duration"], &plain["samples"]), "{late:#}");
    let degrees = "time,shoulder [deg],elbow [deg]\n0,-51.56620156177409,22.918311805232928\n2,-40.1070456591576,28.64788975654116\n";
    let (code, json) = verify(degrees);
    assert!(code == 0 && json.contains("converted to radians, metres and seconds"), "{json}");
}

#[test]
fn units_and_columns_that_do_not_fit_are_named() {
    for (header, part) in [
        ("time,shoulder [m],elbow", "column \"shoulder [m]\" cannot have the unit \"m\""),
        ("time,shoulder [turns],elbow", "the unit \"turns\" of column \"shoulder [turns]\" is unknown"),
        ("time [rad],shoulder,elbow", "cannot have the unit \"rad\""),
        (
            "__time,/joint_states/position[0],/tool",
            "its columns are \"__time\", \"/joint_states/position[0]\", \"/tool\"",
        ),
    ] {
        let (code, json) = verify(&PLAIN.replacen("time,shoulder,elbow", header, 1));
        let error: serde_json::Value = serde_json::from_str(&json).unwrap();
        let message = error["message"].as_str().unwrap();
        assert!(code == 1 && message.contains(part) && error["line"] == 1, "{part:?} is not in {error:#}");
    }
}
