//! Tables as spreadsheets and loggers write them: the same motion with any separator.

use super::*;
const PLAIN: &str = "time,shoulder,elbow\n0,-0.9,0.4\n1,-0.8,0.4\n2,-0.7,0.5\n";

/// Returns the findings about a table.
fn verify(table: &str) -> Result<Value, InputError> {
    let place = Place::new().with("world.toml", "start.joints = [-0.9, 0.4]\ngoal.joints = [-0.7, 0.5]\n");
    judged(&[root("robots/planar_2r.urdf"), place.path("world.toml")], "m.csv", table, &Question::default())
}

/// Returns the findings without the notes.
fn findings(table: &str) -> Value {
    let mut found = verify(table).unwrap_or_else(|error| panic!("{table}: {error}"));
    assert_eq!(found["verdict"], "free", "{table}: {found:#}");
    found.as_object_mut().unwrap().remove("notes");
    found
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
fn accepted_oddities_are_noted_and_unclear_tables_refused() {
    let found = verify(&PLAIN.replace("1,-0.8,0.4\n", "1,-0.8,0.4\n1,-0.8,0.4\n").replace(',', ";")).unwrap();
    for part in ["1 sample repeats the previous one; ignored", "separated by semicolons"] {
        assert!(found["notes"].to_string().contains(part), "no {part:?} in {found:#}");
    }
    // There are two samples at one time, commas for decimals, and two kinds of separators.
    for (table, part) in [
        (PLAIN.replace("2,-0.7", "1,-0.7"), "line 4"),
        (PLAIN.replace(',', ";").replace('.', ","), "not a number"),
        (PLAIN.replacen(',', ";", 1), "time;shoulder"),
    ] {
        let error = verify(&table).unwrap_err();
        let first = &error.diagnostics()[0];
        assert!(error.to_string().contains(part) && first.help.is_some(), "{part:?} is not in {error}");
    }
}

/// Checks tables with the headers of PlotJuggler and of loggers. Times that are dates keep their nanoseconds.
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
        // The table has two sources, which log at different moments.
        "__time,/a/shoulder/position,/a/elbow/position,/b/load\n0,-0.9,0.4,\n0.5,,,7\n1,-0.8,0.4,\n2,-0.7,0.5,\n2,,,7\n".into(),
    ] {
        assert_eq!(findings(&table), plain, "{table}");
    }
    let mut late = findings(&dated("__time,shoulder,elbow"));
    late["nearest"]["time"] = plain["nearest"]["time"].clone();
    assert_eq!((&late["duration"], &late["samples"]), (&plain["duration"], &plain["samples"]), "{late:#}");
    let degrees = "time,shoulder [deg],elbow [deg]\n0,-51.56620156177409,22.918311805232928\n2,-40.1070456591576,28.64788975654116\n";
    let found = verify(degrees).unwrap();
    assert_eq!(found["verdict"], "free", "{found:#}");
    assert!(found["notes"].to_string().contains("converted to radians, metres and seconds"), "{found:#}");
}

#[test]
fn units_and_columns_that_do_not_fit_are_named() {
    for (header, part) in [
        ("time,shoulder [m],elbow", "column \"shoulder [m]\" cannot have the unit \"m\""),
        ("time,shoulder [turns],elbow", "the unit \"turns\" of column \"shoulder [turns]\" is unknown"),
        ("time [rad],shoulder,elbow", "cannot have the unit \"rad\""),
        (
            "__time,/joint_states/position[0],/tool",
            "the columns are \"__time\", \"/joint_states/position[0]\", \"/tool\"",
        ),
    ] {
        let error = verify(&PLAIN.replacen("time,shoulder,elbow", header, 1)).unwrap_err();
        let first = &error.diagnostics()[0];
        assert!(first.message.contains(part), "{part:?} is not in {error}");
        assert_eq!(first.position.map(|position| position.line), Some(1), "{error}");
    }
}
