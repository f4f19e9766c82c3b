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
        (PLAIN.replacen(',', ";", 1), "line 2"),
    ] {
        let (code, json) = verify(&table);
        assert_eq!(code, 1, "{table}: {json}");
        let error: serde_json::Value = serde_json::from_str(&json).unwrap();
        let whole = format!("line {}: {} {}", error["line"], error["message"], error["cure"]);
        assert!(whole.contains(part) && error["cure"].is_string(), "{part:?} is not in {whole}");
    }
}
