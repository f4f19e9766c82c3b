//! `cplan polygons`: the penetration test and the Minkowski difference of two polygons.

use super::*;

/// Returns the findings about two polygons.
fn findings(place: &Place, a: &str, b: &str, options: &str) -> Value {
    let done = place.run(&["polygons", a, b], &format!("{options} --json")).exits(0);
    serde_json::from_str(&done.stdout).unwrap()
}

const SQUARE: &str = "0,0 1,0 1,1 0,1";

#[test]
fn each_condition_of_the_penetration_test_is_reported() {
    let place = Place::new();
    let corner = findings(&place, SQUARE, "0.75,0.5 3,0.5 3,3 0.75,3", "");
    assert_eq!((&corner["meet"], &corner["depth"], &corner["distance"]), (&json!(true), &json!(0.25), &json!(0.0)));
    assert_eq!(corner["a_corners_in_b"], json!([{ "corner": 3, "at": [1.0, 1.0], "depth": 0.25 }]));
    assert_eq!(corner["b_corners_in_a"], json!([{ "corner": 1, "at": [0.75, 0.5], "depth": 0.25 }]));
    assert_eq!(corner["crossing_sides"], json!([{ "a": 2, "b": 1 }, { "a": 3, "b": 4 }]));
    // Two crossing bars: no corner is inside.
    let bars = findings(&place, "-3,-1 3,-1 3,1 -3,1", "-1,-3 1,-3 1,3 -1,3", "");
    assert_eq!((bars["depth"].as_f64(), &bars["a_corners_in_b"]), (Some(4.0), &json!([])));
    assert_eq!((bars["crossing_sides"].as_array().map(Vec::len), &bars["b_corners_in_a"]), (Some(4), &json!([])));
    let touching = findings(&place, SQUARE, "1,1 2,1 2,2", "");
    assert_eq!((&touching["meet"], &touching["depth"]), (&json!(true), &json!(0.0)));
    let apart = findings(&place, SQUARE, "4,5 6,5 6,6", "");
    let facts = (&apart["meet"], &apart["depth"], &apart["distance"], &apart["crossing_sides"]);
    assert_eq!(facts, (&json!(false), &Value::Null, &json!(5.0), &json!([])));
}

#[test]
fn the_difference_has_the_corners_of_the_vertex_sweep() {
    let place = Place::new();
    let found = findings(&place, "0,0 1,0 0,1", "2,2 4,2 4,3", "");
    let part = &found["difference"][0];
    assert_eq!(part["corners"], json!([[2.0, 1.0], [4.0, 1.0], [4.0, 3.0], [3.0, 3.0], [1.0, 2.0]]));
    assert_eq!(part["of"], json!([[1, 3], [2, 3], [3, 1], [3, 2], [1, 2]]));
    let done = place.run(&["polygons", "0,0 1,0 0,1", "2,2 4,2 4,3"], "");
    done.says(&[
        "b1 - a3 = (2, 1), b2 - a3 = (4, 1), b3 - a1 = (4, 3)",
        "A and B are 2.12132 apart; the origin is outside B - A",
    ]);
    // A turned square: the section of the C-obstacle at this angle.
    let turned = findings(&place, "-1,-1 1,-1 1,1 -1,1", SQUARE, "--turn 45deg");
    assert_eq!(turned["difference"][0]["corners"].as_array().map(Vec::len), Some(8));
}

#[test]
fn polygons_that_are_not_convex_have_a_difference_in_parts() {
    let place = Place::new();
    let found = findings(&place, "0,0 3,0 3,3 2,3 2,1 1,1 1,3 0,3", "1.25,2 1.75,2 1.75,5 1.25,5", "");
    // The bar is between the arms of the U.
    assert_eq!((&found["meet"], &found["distance"]), (&json!(false), &json!(0.25)));
    assert_eq!((&found["a"]["convex"], &found["depth_is_exact"]), (&json!(false), &json!(false)));
    assert!(found["difference"].as_array().unwrap().len() > 1);
    let done = place.run(&["polygons", "0,0 3,0 3,3 2,3 2,1 1,1 1,3 0,3", "1.25,0.5 1.75,0.5 1.75,5 1.25,5"], "");
    done.says(&["A and B meet; penetration depth: at least 0.5"]);
}

#[test]
fn polygons_are_read_from_files_and_drawn() {
    let place = Place::new()
        .with("a.txt", "# a square, clockwise, closed\n0 0\n0 1\n1 1\n1 0\n0 0\n")
        .with("b.csv", "x,y\n0.75,0.5\n3,0.5\n3,3\n0.75,3\n")
        .with("c.toml", "polygon = [[0.75, 0.5], [3, 0.5], [3, 3], [0.75, 3]]\n");
    let found = findings(&place, "a.txt", "b.csv", "--picture both.svg --picture both.png --picture both.html");
    assert_eq!(found["depth"], json!(0.25));
    assert_eq!(found["notes"].as_array().map(Vec::len), Some(2), "{found}");
    assert_eq!(found["b"], findings(&place, "a.txt", "c.toml", "")["b"]);
    let svg = place.read("both.svg");
    has(&svg, &["a1", "b4", "origin", "B \u{2212} A", "penetration depth: 0.25"]);
    assert!(place.path("both.png").exists() && place.read("both.html").contains("<svg"));
    place.run(&["polygons", "a.txt", "b.csv"], "--picture b.csv").refused(2, &["must end in"]);
}

#[test]
fn bad_polygons_are_refused_with_place_and_hint() {
    let place = Place::new()
        .with("word.txt", "0,0\n1,zero\n1,1\n")
        .with("odd.txt", "0,0\n1,0,2\n1,1\n")
        .with("cross.txt", "0,0\n2,2\n2,0\n0,2\n")
        .with("key.toml", "points = [[0, 0], [1, 0], [1, 1]]\n")
        .with("three.toml", "polygon = [[0, 0],\n[1, 0, 2], [1, 1]]\n");
    for (a, parts) in [
        ("word.txt", ["word.txt: line 2, column 3", "\"zero\" is not a number", "hint: write each point as x,y"]),
        ("odd.txt", ["odd.txt: line 2, column 1", "a point needs two numbers, but here are 3", "hint: "]),
        ("cross.txt", ["cross.txt: line 3", "sides 1 and 3 cross", "hint: list the corners in order"]),
        ("key.toml", ["key.toml: line 1", "unknown field `points`", "hint: write the corners as polygon = "]),
        ("three.toml", ["three.toml: line 2, column 1", "but here are 3", "hint: "]),
        ("0,0 1,0", ["polygon A: line 1", "at least three corners, this one has 2", "hint: "]),
        ("0,0 1,0 1e999,1", ["polygon A: line 1, column 9", "not a finite number", "hint: "]),
        ("missing.txt", ["missing.txt", "there is no such file", "hint: name a file, or write the corners of A"]),
    ] {
        place.run(&["polygons", a, SQUARE], "").refused(1, &parts);
    }
    let done = place.run(&["polygons", "missing.txt", SQUARE], "--json");
    let error: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!((&error["status"], &error["file"], done.code), (&json!("error"), &json!("missing.txt"), 1));
    place.run(&["polygons", SQUARE], "").refused(2, &["<B>"]);
}
