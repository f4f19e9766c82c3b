//! Errors in cell files, and cells without motions.

use super::super::{Done, Place};
use super::{answer, read, shipped, title};

/// Two arms with bars at one height, far from each other.
const FREE: &str = r#"
[[arm]]
name = "left"
urdf = "planar_2r.urdf"
base = { at = [-2.0, 0.0] }
start = { joints = [0.5, 0.5] }
goal = { joints = [-0.5, -0.5] }

[[arm]]
name = "right"
urdf = "planar_2r.urdf"
base = { at = [2.0, 0.0], angle = "180deg" }
start = { joints = [0.5, 0.5] }
goal = { joints = [-0.5, -0.5] }
"#;

/// Runs `cplan cell` with a file that differs from [`FREE`] in these places.
#[track_caller]
fn with(changes: &[(&str, &str)], options: &[&str]) -> Done {
    in_place(changes, options).1
}

/// Does the same, and also returns the place of the files.
#[track_caller]
fn in_place(changes: &[(&str, &str)], options: &[&str]) -> (Place, Done) {
    let mut text = FREE.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let place = Place::new().with("planar_2r.urdf", read(shipped("robots/planar_2r.urdf"))).with("cell.toml", text);
    let done = place.run(&[&["cell", "cell.toml", "--quiet"], options].concat(), "");
    (place, done)
}

/// Returns the title of the page that [`with`] these changes writes.
#[track_caller]
fn page_title(changes: &[(&str, &str)]) -> String {
    let (place, done) = in_place(changes, &["--picture", "cell.html", "--picture", "cell.svg"]);
    let page = place.read("cell.html");
    let title = title(&page).to_owned();
    assert!(done.code == 3 && place.read("cell.svg").contains(&title), "{}: {title}", done.code);
    title
}

#[test]
fn the_base_of_the_tests_is_found() {
    let done = with(&[], &["--json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
}

#[test]
fn errors_name_the_line_of_the_cell_file() {
    let second = "[[arm]]\nname = \"right\"";
    for (changes, expected) in [
        (vec![("name = \"right\"", "name = \"left\"")], "cell.toml: line 10, column 8: both arms are named \"left\""),
        (vec![(second, "[[other]]\nname = \"right\"")], "line 9, column 3: unknown key `other`"),
        (
            vec![("base = {", "clearance = 0.01\nbase = {")],
            "cell.toml: line 5, column 13: arm \"left\" has a clearance of its own, but both arms have that of the cell",
        ),
        (vec![("base = {", "place = {")], "line 5, column 1: unknown key `place`"),
        (vec![("goal = { joints = [-0.5, -0.5] }\n", "")], "line 3, column 8: arm \"left\" has no goal"),
        (vec![("start = { joints = [0.5, 0.5] }\n", "")], "line 3, column 8: arm \"left\" has no start"),
        (vec![("urdf = \"planar_2r.urdf\"\n", "")], "missing key `urdf`"),
        (vec![("planar_2r.urdf", "no.urdf")], "line 4, column 8: the robot of arm \"left\" cannot be read"),
        (vec![("angle = \"180deg\"", "angle = \"180 degrees\"")], "line 12, column 35"),
        (vec![("at = [2.0, 0.0]", "at = [2.0, 0.0, 1.0]")], "line 12, column 15"),
        (vec![("start = { joints = [0.5, 0.5] }", "start = { joints = [0.5, 9.5] }")], "line 6, column"),
        (vec![("start = {", "robot = 5\nstart = {")], "line 6, column 9: the robot of arm \"left\" must be a table"),
        (
            vec![("start = {", "robot = { at = [0.0, 0.0] }\nstart = {")],
            "line 6, column 11: the robot of arm \"left\" has `at`",
        ),
        (vec![("start = {", "robot = { tip = \"nose\" }\nstart = {")], "line 6, column 17"),
        (
            vec![("start = {", "step = [{ pick = \"part\" }]\nstart = {")],
            "line 6, column 18: there is no object \"part\"",
        ),
        (
            vec![(second, "[[obstacle]]\ncircle = { center = [0, 0], radius = -1 }\n[[arm]]\nname = \"right\"")],
            "line 10, column 38",
        ),
        (
            vec![(
                second,
                "[[obstacle]]\nname = \"post\"\ncircle = { center = [-1.4, 0.5], radius = 0.2 }\n[[arm]]\nname = \"right\"",
            )],
            "is not free",
        ),
        (
            vec![("at = [-2.0, 0.0]", "at = [2.0, 0.0]"), ("at = [2.0, 0.0], angle = \"180deg\"", "at = [2.0, 0.0]")],
            "both move joint \"shoulder\"",
        ),
    ] {
        let done = with(&changes, &[]);
        assert_eq!(done.code, 1, "{changes:?}: {}{}", done.stdout, done.stderr);
        assert!(done.stderr.contains(expected), "{changes:?}: {}", done.stderr);
        assert!(done.stderr.contains("hint: "), "{changes:?}: {}", done.stderr);
    }
    let one = FREE.split(second).next().unwrap();
    let place = Place::new().with("planar_2r.urdf", read(shipped("robots/planar_2r.urdf"))).with("cell.toml", one);
    let done = place.run(&["cell", "cell.toml"], "");
    assert!(done.code == 1 && done.stderr.contains("a cell has two arms, but the file has 1"), "{}", done.stderr);
}

#[test]
fn bases_must_not_overlap() {
    let place = Place::new().with("scara.urdf", read(shipped("robots/scara.urdf")));
    let cell = read(shipped("workspaces/cells/crossing.toml"))
        .replace("../../robots/", "")
        .replace("at = [0.8, 0.0]", "at = [-0.05, 0.0]");
    let done = place.with("cell.toml", cell).run(&["cell", "cell.toml"], "");
    assert_eq!(done.code, 1, "{}", done.stdout);
    let expected = "cell.toml: line 14, column 8: the bases of arms \"left\" and \"right\" overlap";
    assert!(done.stderr.contains(expected), "{}", done.stderr);
}

#[test]
fn starts_that_collide_are_infeasible() {
    let changes = [("at = [2.0, 0.0]", "at = [-0.4, 0.0]"), ("joints = [0.5, 0.5]", "joints = [0.0, 0.0]")];
    let done = with(&changes, &["--json"]);
    let answer = answer(&done);
    assert_eq!((done.code, &answer["proof"]["kind"]), (3, &"starts".into()), "{answer}");
    let contact = answer["proof"]["contact"].as_str().unwrap().replace('"', "");
    assert_eq!(page_title(&changes), format!("No motions: at the starts, {contact}"));
}

#[test]
fn goals_that_collide_are_infeasible() {
    let changes = [
        ("at = [2.0, 0.0]", "at = [1.0, 0.0]"),
        ("joints = [-0.5, -0.5]", "joints = [0.0, 0.0]"),
        ("goal = { joints = [-0.5, -0.5] }", "goal = { joints = [0.0, 0.0] }"),
    ];
    let done = with(&changes, &["--json"]);
    let answer = answer(&done);
    assert_eq!((done.code, &answer["proof"]["kind"]), (3, &"goals".into()), "{answer}");
    assert_eq!(page_title(&changes), "No motions: the arms collide at every pair of goals");
}

#[test]
fn an_arm_without_a_way_makes_the_cell_infeasible() {
    // A closed fence around the goal of the left arm's tip.
    let fence = "[[obstacle]]\nname = \"fence\"\npolyline = [[-2.0, -2.5], [-0.15, -2.5], [-0.15, 2.5], [-2.0, 2.5], [-2.0, 0.2]]\n";
    let wall = "[[obstacle]]\nname = \"wall\"\npolygon = [[-1.6, -0.06], [-0.2, -0.06], [-0.2, 0.06], [-1.6, 0.06]]\n";
    let text = format!("{fence}{wall}[[arm]]\nname = \"right\"");
    let changes = [("[[arm]]\nname = \"right\"", text.as_str()), ("at = [2.0, 0.0]", "at = [4.0, 0.0]")];
    let done = with(&changes, &["--json"]);
    let answer = answer(&done);
    assert_eq!(
        (done.code, &answer["proof"]["kind"], &answer["proof"]["arm"]),
        (3, &"alone".into(), &"left".into()),
        "{answer}"
    );
    assert_eq!(page_title(&changes), "No motions: left cannot reach its goal, even without right");
}

#[test]
fn boxes_in_four_joints_prove_that_arms_cannot_pass() {
    let done = super::shipped_cell("no_room", &[]);
    let found = answer(&done);
    assert_eq!((done.code, &found["proof"]["kind"]), (3, &"boxes".into()), "{found}");
    let done = super::shipped_cell("no_room", &["--boxes", "0"]);
    let unknown = answer(&done);
    assert_eq!((done.code, &unknown["status"]), (4, &"unknown".into()), "{unknown}");
    assert!(unknown["tried"].as_array().unwrap().len() >= 3, "{unknown}");
}
