//! Unusable recordings: refused with the file, the place, the fault and a remedy.

use crate::cli::has;
use cplan::input::{load_recording, load_scene};
use std::fs;

/// An arm of two revolute joints that a vertical slide carries. The slide is held.
const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <joint name="lift" type="prismatic">
    <parent link="base"/> <child link="column"/> <axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <link name="column"/>
  <joint name="j1" type="revolute">
    <parent link="column"/> <child link="upper"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="2"/>
  </joint>
  <link name="upper"><collision><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <joint name="j2" type="revolute">
    <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="2"/>
  </joint>
  <link name="fore"><collision><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
</robot>
"#;

const WORLD: &str = "[robot]\njoints = [\"j1\", \"j2\"]\nfixed = { lift = 0.25 }\n";

fn read(name: &str, text: impl AsRef<[u8]>) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().unwrap();
    let at = |file: &str| folder.path().join(file);
    fs::write(at("arm.urdf"), ARM).unwrap();
    fs::write(at("world.toml"), WORLD).unwrap();
    fs::write(at(name), text).unwrap();
    let scene = load_scene(at("arm.urdf"), &at("world.toml")).unwrap_or_else(|e| panic!("{e}"));
    load_recording(&at(name), &scene).map(|loaded| loaded.notes).map_err(|e| e.to_string())
}

fn refused(name: &str, text: impl AsRef<[u8]>, parts: &[&str]) {
    let error = read(name, text).expect_err("should be refused");
    has(&error, &[&[name], parts].concat());
}

#[test]
fn invalid_tables_are_refused() {
    let csv = |text: &str, parts: &[&str]| refused("m.csv", text, parts);
    csv("", &["is empty", "header"]);
    csv("\n\n", &["is empty"]);
    csv("time,j1,j2\n", &["no sample", "at least one"]);
    csv("0,0.1,0.2\n1,0.1,0.3\n", &["line 1", "no header", "time, j1, j2"]);
    csv("time;j1;j2\n0;0\n", &["line 2", "has 2 values, but the header has 3 names"]);
    csv("time,j1\n0,0\n", &["no positions of joint \"j2\"", "\"j1\""]);
    csv("time,J1,J2\n0,0,0\n", &["no positions of joint \"j1\"", "the columns are \"time\", \"J1\", \"J2\""]);
    csv("time,j1_velocity,j2\n0,0,0\n", &["no positions of joint \"j1\""]);
    csv("time,j1,j2\n0,0,0\n1,0\n", &["line 3", "has 2 values, but the header has 3"]);
    csv("time,j1,j2\n0,0,0\n1,0,0,0\n", &["line 3", "has 4 values"]);
    csv("time,j1,j2\n0,0,0\n1,x,0\n", &["line 3, column 3", "\"j1\" is \"x\"", "^"]);
    csv("time,j1,j2\n0,0,\n", &["line 2, column 5", "\"j2\" is \"\""]);
    csv("time,j1,j2\n0,nan,0\n", &["line 2, column 3", "NaN"]);
    csv("time,j1,j2\n0,-inf,0\n", &["line 2, column 3", "-inf"]);
    csv("time,j1,j2\n0,1e300,0\n", &["line 2", "position is 1"]);
    csv("time,j1,j2\n0,0,0\n1,0,0\n1,0,0.1\n", &["line 4", "1 s follows 1 s", "increase"]);
    csv("time,j1,j2\n0,0,0\n1,0,0\n0.5,0,0.1\n", &["line 4", "0.5 s follows 1 s"]);
    csv("j1,j2,j1_velocity,j2_velocity\n0,0,0,0\n", &["velocities, but no times", "add the times"]);
    csv("time,j1,pos_j1,j2\n0,0,0,0\n", &["line 1, column 9", "\"j1\" and \"pos_j1\" have the same meaning"]);
    csv("time,t,j1,j2\n0,0,0,0\n", &["\"time\" and \"t\" have the same meaning"]);
    csv("\"time,j1,j2\n0,0,0\n", &["no positions of joint \"j1\""]);
    refused("m.csv", b"time,j1,j2\n0,\xff,0\n", &["not UTF-8", "byte 13"]);
}

#[test]
fn invalid_documents_are_refused() {
    let json = |text: &str, parts: &[&str]| refused("m.json", text, parts);
    json("", &["line 1", "hint"]);
    json("{\"joints\": [\"j1\", \"j2\"],\n \"path\": [[0, NaN]]}", &["line 2", "finite"]);
    json("{\"joints\": [\"j1\", \"j2\"], \"path\": [[0, 1], [2]]}", &["path[1] has 1 values, but 2 joints"]);
    json("{\"joints\": [\"j1\", \"j2\"], \"path\": []}", &["no sample"]);
    json("{\"joints\": [\"j1\", \"j1\"], \"path\": [[0, 1]]}", &["names joint \"j1\" twice"]);
    json("{\"joints\": [\"a\", \"b\"], \"path\": [[0, 1]]}", &["no positions of joint \"j1\"", "\"a\", \"b\""]);
    json("{\"path\": [[0, 1]]}", &["\"joints\" is missing"]);
    json("{\"status\": \"infeasible\", \"joints\": [\"j1\", \"j2\"]}", &["the status is \"infeasible\""]);
    json("{}", &["neither a path, nor a trajectory"]);
    json("[1, 2]", &["line 1"]);
    let trajectory = |members: &str, parts: &[&str]| {
        json(&format!("{{\"joints\": [\"j1\", \"j2\"], \"trajectory\": {{{members}}}}}"), parts);
    };
    trajectory("\"time\": [0], \"position\": [[0, 0], [1, 1]]", &["2 positions, but 1 times"]);
    trajectory("\"time\": [0, 1], \"position\": [[0, 0], [1, 1]], \"velocity\": [[0, 0]]", &["2 positions, but 1 vel"]);
    trajectory("\"time\": [1, 0], \"position\": [[0, 0], [1, 1]]", &["trajectory.position[1]", "0 s follows 1 s"]);
}

#[test]
fn invalid_messages_are_refused() {
    let yaml = |text: &str, parts: &[&str]| refused("m.yaml", text, parts);
    let points = |points: &str, parts: &[&str]| yaml(&format!("joint_names: [j1, j2]\npoints:\n{points}"), parts);
    yaml("", &["hint"]);
    yaml("joint_names: [j1, j2\npoints: []\n", &["line", "hint"]);
    yaml("points: []\n", &["\"joint_names\" is missing"]);
    yaml("joint_names: []\npoints: []\n", &["\"joint_names\" is missing"]);
    yaml("joint_names: [j1, j2]\npoints: []\n", &["no sample"]);
    yaml("joint_names: [j1]\npoints: [{positions: [0]}]\n", &["no positions of joint \"j2\""]);
    points("- positions: [0]\n", &["positions of points[0] has 1 values, but 2 joints"]);
    points("- velocities: [0, 0]\n", &["positions of points[0] has 0 values"]);
    points("- positions: [0, x]\n", &["line 3", "hint"]);
    points("- positions: [0, .nan]\n", &["points[0]", "position is NaN"]);
    let two = |a: &str, b: &str| format!("- {{positions: [0, 0]{a}}}\n- {{positions: [0, 1]{b}}}\n");
    points(
        &two(", time_from_start: {sec: 1}", ", time_from_start: {sec: 1, nanosec: 0}"),
        &["points[1]", "1 s follows 1"],
    );
    points(&two(", time_from_start: {sec: 1}", ""), &["1 of 2 points have time_from_start"]);
    points(&two("", ", velocities: [0, 0]"), &["1 of 2 points have velocities"]);
    points(&two(", velocities: [0]", ", velocities: [0]"), &["velocities of points[0] has 1 values"]);
    yaml("joint_names: [j1, j2]\npoints: []\n---\njoint_names: [j1, j2]\npoints: []\n", &["hint"]);
}

#[test]
fn files_of_other_kinds_are_refused() {
    refused("m.dat", "0 0\n", &["is unknown", ".json", ".csv", ".yaml"]);
    let folder = tempfile::tempdir().unwrap();
    let at = |file: &str| folder.path().join(file);
    fs::write(at("arm.urdf"), ARM).unwrap();
    fs::write(at("world.toml"), WORLD).unwrap();
    let scene = load_scene(at("arm.urdf"), &at("world.toml")).unwrap();
    let error = load_recording(&at("absent.csv"), &scene).unwrap_err().to_string();
    assert!(error.contains("absent.csv") && error.contains("cannot be read"), "{error}");
    refused("m.db3", "SQLite format 3", &[".mcap files only", "ros2 bag convert"]);
    let error = load_recording(folder.path(), &scene).unwrap_err().to_string();
    assert!(error.contains(".mcap files only") && error.contains("ros2 bag convert"), "{error}");
}

#[test]
fn held_joints_may_move_along_the_normal() {
    let rows = |a: f64, b: f64| format!("time,lift,j1,j2\n0,{a},0,0\n1,{b},0,0.1\n");
    let notes = read("m.csv", rows(0.25, 0.250_001)).unwrap();
    assert!(notes.iter().any(|n| n.contains("\"lift\" stays at 0.25")), "{notes:?}");
    let notes = read("m.csv", rows(0.25, 0.3)).unwrap();
    assert!(notes.iter().any(|n| n.contains("\"lift\" slides between 0.25 and 0.3 m")), "{notes:?}");
    let point = |t: u8, lift: f64| format!("- {{positions: [0, {lift}, 0], time_from_start: {{sec: {t}}}}}\n");
    let message = |lift: f64| format!("joint_names: [j2, lift, j1]\npoints:\n{}{}", point(0, 0.25), point(1, lift));
    for (lift, report) in [(0.25, "\"lift\" stays at 0.25"), (0.5, "\"lift\" slides between 0.25 and 0.5 m")] {
        let notes = read("m.yaml", message(lift)).unwrap();
        assert!(notes.iter().any(|note| note.contains(report)), "{notes:?}");
    }
    // Joints that the arm does not depend on may move.
    let notes = read("m.csv", "time,j1,j2,gripper\n0,0,0,0\n1,0,0.1,0.04\n").unwrap();
    assert!(notes.iter().any(|n| n.contains("unused columns: \"gripper\"")), "{notes:?}");
}

#[test]
fn velocities_of_one_joint_alone_are_not_used() {
    let notes = read("m.csv", "time,j1,j2,j1_velocity\n0,0,0,0\n1,0,0.1,0\n").unwrap();
    assert!(notes.iter().any(|n| n.contains("only one joint")), "{notes:?}");
    assert!(notes.iter().any(|n| n.contains("straight")), "{notes:?}");
}
