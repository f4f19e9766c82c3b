//! Invalid input of every kind. It is refused with the file, the line, the defect, and a hint.

use cplan::input::{InputError, LoadedProblem, Overrides, load, robot};
use cplan::model::Region;
use std::fs;

/// A valid two-link arm in the (x, y) plane.
pub const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <joint name="j1" type="revolute">
    <parent link="base"/> <child link="upper"/>
    <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="2"/>
  </joint>
  <link name="upper">
    <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="j2" type="revolute">
    <parent link="upper"/> <child link="fore"/>
    <origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="2"/>
  </joint>
  <link name="fore">
    <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="end" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="1 0 0"/></joint>
  <link name="tool"/>
</robot>
"#;

/// A valid world.
pub const WORLD: &str = r#"name = "test"
[start]
joints = [0.0, 0.5]
[goal]
joints = [1.0, -0.5]
[[obstacle]]
name = "post"
circle = { center = [-1.5, 0], radius = 0.2 }
"#;

pub fn load_files(
    urdf_name: &str,
    urdf: &str,
    world: &str,
    overrides: &Overrides,
) -> Result<LoadedProblem, InputError> {
    let folder = tempfile::tempdir().unwrap();
    let (u, w) = (folder.path().join(urdf_name), folder.path().join("world.toml"));
    fs::write(&u, urdf).unwrap();
    fs::write(&w, world).unwrap();
    load(robot(&u), &w, overrides)
}

fn refused(result: Result<LoadedProblem, InputError>, parts: &[&str]) {
    let error = result.expect_err("should be refused").to_string();
    for part in parts {
        assert!(error.contains(part), "no \"{part}\" in:\n{error}");
    }
}

/// Checks that the arm with one piece of text replaced is refused with these parts in the message.
fn bad_arm(from: &str, to: &str, parts: &[&str]) {
    assert!(ARM.contains(from), "{from}");
    let urdf = ARM.replacen(from, to, 1);
    refused(load_files("arm.urdf", &urdf, WORLD, &Overrides::default()), &[&["arm.urdf"], parts].concat());
}

fn bad_world(from: &str, to: &str, parts: &[&str]) {
    assert!(WORLD.contains(from), "{from}");
    let world = WORLD.replacen(from, to, 1);
    refused(load_files("arm.urdf", ARM, &world, &Overrides::default()), &[&["world.toml"], parts].concat());
}

fn with_robot(table: &str, parts: &[&str]) {
    bad_world("[start]", &format!("[robot]\n{table}\n[start]"), parts);
}

#[test]
fn the_healthy_files_load() {
    let loaded = load_files("arm.urdf", ARM, WORLD, &Overrides::default()).unwrap();
    assert_eq!(loaded.problem.scene().arm().tip_name, "tool");
    assert!(loaded.robot.geometry.iter().any(|n| n.contains("heights along z")));
    assert!(loaded.robot.notes.iter().any(|n| n.contains("top speed in 0.25 s")));
    assert!(loaded.robot.warnings.is_empty());
}

#[test]
fn invalid_numbers_are_refused() {
    bad_arm("xyz=\"0.5 0 0\"", "xyz=\"0.5 nan 0\"", &["line 9", "link \"upper\"", "not finite"]);
    bad_arm("lower=\"-3\"", "lower=\"-inf\"", &["line 6", "joint \"j1\"", "too long", "continuous"]);
    bad_arm("lower=\"-3\"", "lower=\"nan\"", &["line 6", "joint \"j1\"", "not finite", "continuous"]);
    bad_arm("xyz=\"0.5 0 0\"", "xyz=\"0.5 0\"", &["line 9", "has 2 numbers, not 3"]);
    bad_arm("upper=\"3\"", "upper=\"three\"", &["line 6", "upper=\"three\" is not a number"]);
    bad_arm("size=\"1 0.1 0.1\"", "size=\"1 -0.1 0.1\"", &["line 9", "must be positive"]);
}

#[test]
fn joints_that_cannot_move_are_refused() {
    bad_arm(
        "<axis xyz=\"0 0 1\"/>",
        "<axis xyz=\"0 0 0\"/>",
        &["line 5", "joint \"j1\"", "is zero", "hint: give the axis"],
    );
    bad_arm("lower=\"-3\" upper=\"3\"", "lower=\"3\" upper=\"-3\"", &["line 6", "reversed", "swap"]);
    bad_arm("lower=\"-3\" upper=\"3\"", "", &["line 6", "unset", "[robot] limits = { j1 = [-3.1, 3.1] }"]);
    bad_arm("velocity=\"2\"", "velocity=\"-2\"", &["line 6", "negative"]);
    bad_arm("lower=\"-3\" upper=\"3\"", "lower=\"-1\" upper=\"1e16\"", &["line 6", "too long", "continuous"]);
    bad_arm("type=\"revolute\"", "type=\"hinge\"", &["line 3", "type \"hinge\" is unknown", "revolute"]);
    let soft = "<safety_controller soft_lower_limit=\"4\" soft_upper_limit=\"5\" k_velocity=\"1\"/></joint>";
    bad_arm("</joint>", soft, &["line 7", "soft limits [4, 5] do not overlap", "limits = { j1 = [-3, 3] }"]);
}

#[test]
fn links_that_form_no_tree_are_refused() {
    bad_arm(
        "<parent link=\"upper\"/>",
        "<parent link=\"uper\"/>",
        &["line 12", "\"uper\" does not exist", "\"upper\""],
    );
    bad_arm(
        "<child link=\"tool\"/>",
        "<child link=\"fore\"/>",
        &["line 20", "two joints, \"j2\" (line 11)", "not a tree"],
    );
    bad_arm("<link name=\"tool\"/>", "<link name=\"fore\"/>", &["line 21", "second link is named \"fore\"", "line 17"]);
    bad_arm("<joint name=\"j2\"", "<joint name=\"j1\"", &["line 11", "second joint is named \"j1\"", "line 3"]);
    bad_arm("<parent link=\"base\"/>", "<parent link=\"tool\"/>", &["cycle", "\"j1\"", "\"j2\"", "\"end\"", "line "]);
    bad_arm(
        "<link name=\"tool\"/>",
        "<link name=\"tool\"/><link name=\"stray\"/>",
        &["line 21", "\"base\", \"stray\"", "one root link"],
    );
    bad_arm("<link name=\"base\"/>", "<link/>", &["line 2", "has no name"]);
    bad_arm("<child link=\"upper\"/>", "", &["line 3", "<child> is missing"]);
}

#[test]
fn files_other_than_urdf_are_refused() {
    bad_arm("<link name=\"tool\"/>", "<link name=\"tool\">", &["line 22", "not well-formed XML"]);
    bad_arm("</robot>", "", &["not well-formed XML", "never closed"]);
    bad_arm("</robot>", "<xacro:include filename=\"a\"/></robot>", &["line 22", "not declared", "xmlns:xacro="]);
    bad_arm(
        "name=\"arm\"",
        "name=\"arm\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\" v=\"${x}\"",
        &["line 1", "no property \"x\""],
    );
    bad_arm("xyz=\"1 0 0\"", "xyz=\"${l1} 0 0\"", &["line 13", "no property \"l1\"", "xacro:property"]);
    let run = |name: &str, text: &str| load_files(name, text, WORLD, &Overrides::default());
    let arm = |name: &str, text: &str| run(name, text).unwrap().problem.scene().arm().clone();
    let plain = arm("arm.urdf", ARM);
    assert_eq!(arm("arm.urdf.xacro", ARM), plain);
    refused(run("arm.sdf", "<sdf version=\"1.6\"><model name=\"m\"/></sdf>"), &["line 1", "SDF", "URDF"]);
    refused(run("arm.urdf", WORLD), &["not well-formed XML"]);
    refused(run("arm.urdf", ""), &["arm.urdf", "not well-formed XML"]);
    refused(run("arm.urdf", "<html/>"), &["root element is <html>"]);
    // A file is no xacro just because it declares the namespace.
    let declared = ARM.replace("<robot", "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"");
    assert_eq!(arm("arm.urdf", &declared), plain);
    let folder = tempfile::tempdir().unwrap();
    let (urdf, world) = (folder.path().join("arm.urdf"), folder.path().join("world.toml"));
    fs::write(&urdf, ARM).unwrap();
    fs::write(&world, WORLD).unwrap();
    refused(load(&world, &urdf, &Overrides::default()), &["arm.urdf", "XML", "the URDF first"]);
    let missing = load("/nowhere/arm.urdf", "/nowhere/world.toml".as_ref(), &Overrides::default());
    refused(missing, &["/nowhere/world.toml", "cannot be read"]);
}

#[test]
fn robots_without_a_planar_arm_are_refused() {
    bad_arm("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>", &["line 14", "common plane", "about (0, 1, 0)", "90.00"]);
    bad_arm("type=\"revolute\"", "type=\"fixed\"", &["two joints", "only one movable joint, \"j2\" (revolute)"]);
    bad_arm("type=\"revolute\"", "type=\"floating\"", &["two joints", "only one"]);
    let upright = "<joint name=\"j3\" type=\"continuous\"><parent link=\"fore\"/><child link=\"w\"/><axis xyz=\"0 1 0\"/></joint>\
                   <joint name=\"j4\" type=\"continuous\"><parent link=\"w\"/><child link=\"v\"/><axis xyz=\"0 1 0\"/></joint>\
                   <link name=\"w\"/><link name=\"v\"/></robot>";
    bad_arm(
        "</robot>",
        upright,
        &["4 movable joints", "\"j3\" (continuous)", "joints = [\"j1\", \"j2\"], or [robot] joints = [\"j3\", \"j4\"]"],
    );
    let mimic = "<joint name=\"j3\" type=\"revolute\"><parent link=\"fore\"/><child link=\"w\"/>\n<mimic joint=\"j1\"/></joint><link name=\"w\"/></robot>";
    bad_arm("</robot>", mimic, &["line 23", "\"j3\" mimics joint \"j1\"", "parallelogram"]);
    let bare = ["<collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"1 0.1 0.1\"/></geometry></collision>"; 2];
    let urdf = bare.iter().fold(ARM.to_owned(), |urdf, text| urdf.replacen(text, "", 1));
    refused(
        load_files("arm.urdf", &urdf, WORLD, &Overrides::default()),
        &["arm.urdf", "the arm cannot collide", "bar = 0.05"],
    );
    bad_arm("<box size=\"1 0.1 0.1\"/>", "<mesh filename=\"a.dae\"/>", &["line 9", "a.dae", "STL", "bar = "]);
    bad_arm(
        "<box size=\"1 0.1 0.1\"/>",
        "<mesh filename=\"package://p/a.stl\"/>",
        &["line 9", "package://p/a.stl", "no package of that name"],
    );
    bad_arm("<box size=\"1 0.1 0.1\"/>", "<cone/>", &["line 9", "shape <cone> is unknown", "cylinder"]);
}

#[test]
fn robot_tables_that_do_not_fit_are_refused() {
    with_robot("joints = [\"j1\", \"elbow\"]", &["line 3, column", "no joint \"elbow\"", "\"j1\", \"j2\"", "^"]);
    with_robot("joints = [\"j2\", \"j1\"]", &["line 3", "not the other way round", "joints = [\"j1\", \"j2\"]"]);
    with_robot("joints = [\"j1\", \"j1\"]", &["line 3", "named twice"]);
    with_robot("joints = [\"j1\"]", &["line 3", "exactly two"]);
    with_robot("joints = [\"j1\", \"end\"]", &["line 3", "\"end\" is of type fixed"]);
    with_robot("tip = \"hand\"", &["line 3", "no link \"hand\"", "\"fore\", \"tool\""]);
    with_robot("tip = \"upper\"", &["line 3", "not carried"]);
    with_robot("fixed = { j1 = 0.1 }", &["line 3", "one of the two that move"]);
    with_robot("limits = { j9 = [0, 1] }", &["line 3", "no joint \"j9\""]);
    with_robot("limits = { j1 = [1, 0] }", &["line 3", "lower (1) must be below upper (0)"]);
    with_robot("velocity = { j1 = 0 }", &["line 3", "velocity of \"j1\" must be positive"]);
    with_robot("acceleration = { j1 = nan }", &["line 3", "acceleration of \"j1\""]);
    for value in ["0", "-200", "nan", "inf"] {
        with_robot(&format!("jerk = {{ j1 = {value} }}"), &["line 3, column", "jerk of \"j1\" must be positive", "^"]);
    }
    with_robot("jerk = { j9 = 200 }", &["line 3", "no joint \"j9\""]);
    with_robot("bar = -1", &["line 3", "bar"]);
    with_robot("fixd = {}", &["line 3, column 1", "unknown key `fixd`", "fixd = {}", "^^^^"]);
}

#[test]
fn invalid_obstacles_are_refused() {
    let shape = "circle = { center = [-1.5, 0], radius = 0.2 }";
    for (text, parts) in [
        ("polygon = [[5, 0], [6, 0]]", &["line 8, column 11", "obstacle \"post\"", "three corners", "^"][..]),
        ("polygon = [[5, 0], [6, 1], [6, 0], [5, 1]]", &["line 8", "not a simple polygon"]),
        ("polygon = [[5, 0], [6, 0], [7, 0]]", &["line 8", "not a simple polygon"]),
        ("polygon = [[5, 0], [5, 0], [6, 0]]", &["line 8", "three corners"]),
        ("polygon = [[5, nan], [6, 0], [7, 1]]", &["line 8, column 16", "not a finite number"]),
        ("polygon = [[5, 0, 1], [6, 0], [7, 1]]", &["line 8, column 12", "two numbers, found 3"]),
        ("circle = { center = [5, 0], radius = 0 }", &["line 8, column 38", "radius must be positive"]),
        ("circle = { center = [5, 0], radius = 1, r = 2 }", &["line 8", "unknown key `r`"]),
        ("polyline = [[5, 0]]", &["line 8", "at least two points"]),
        ("polyline = [[5, 0], [5, 0]]", &["line 8", "at least two points in different places"]),
        ("height = [0, 1]", &["line 6", "exactly one shape", "has 0"]),
        ("circle = { center = [5, 0], radius = 1 }\npolyline = [[5, 0], [6, 0]]", &["exactly one shape", "has 2"]),
        ("circle = { center = [5, 0], radius = 1 }\nheight = [1, 0]", &["line 9, column 10", "empty"]),
        ("circle = { center = [5e9, 0], radius = 1 }", &["line 8", "too large", "metres"]),
        ("circle = { center = 5 }", &["line 8, column 21", "^"]),
        ("colour = \"red\"", &["line 8, column 1", "unknown key `colour`"]),
    ] {
        bad_world(shape, text, parts);
    }
    bad_world("name = \"test\"", "name = \"test\"\nclearance = -0.1", &["line 2, column 13", "clearance", "negative"]);
    bad_world("name = \"test\"", "name = ", &["line 1", "^"]);
    bad_world("[goal]\njoints = [1.0, -0.5]", "[goal]\ntip = [1, 1]\njoints = [0, 0]", &["line 4", "both"]);
    bad_world("[goal]\njoints = [1.0, -0.5]", "[goal]", &["line 4", "neither"]);
}

#[test]
fn invalid_starts_and_goals_are_refused() {
    bad_world(
        "joints = [0.0, 0.5]",
        "joints = [0.0, 2.5]",
        &["line 3", "joint \"j2\" at 2.5 rad", "[-2, 2]", "limits"],
    );
    bad_world(
        "joints = [0.0, 0.5]",
        "joints = [3.0, 0.0]",
        &["the start", "link \"fore\" hits obstacle \"post\"", "m deep"],
    );
    bad_world(
        "joints = [1.0, -0.5]",
        "joints = [-3.0, 0.0]",
        &["line 5", "the goal", "link \"fore\" hits obstacle \"post\""],
    );
    bad_world("[start]\njoints = [0.0, 0.5]", "", &["there is no start", "--start"]);
    bad_world("[goal]\njoints = [1.0, -0.5]", "", &["there is no goal", "--goal-tip"]);
    bad_world("joints = [1.0, -0.5]", "tip = [3, 0]", &["line 5", "out of reach", "2.0000 m"]);
    bad_world("joints = [1.0, -0.5]", "tip = [0, 0.1]", &["line 5", "no IK solution", "exceeds its limits [-2, 2]"]);
    bad_world("joints = [1.0, -0.5]", "tip = [-1.5, 0.1]", &["no IK solution", "hits obstacle \"post\""]);
    bad_world("name = \"test\"", "clearance = 2.0", &["the start", "nearer than the clearance of 2 m"]);
    let start = Overrides { start: Some("0,150deg".parse().unwrap()), ..Overrides::default() };
    refused(load_files("arm.urdf", ARM, WORLD, &start), &["--start", "joint \"j2\" at 2.617994 rad"]);
    let both = Overrides {
        goal: Some("0,0".parse().unwrap()),
        goal_tip: Some("1,1".parse().unwrap()),
        ..Overrides::default()
    };
    refused(load_files("arm.urdf", ARM, WORLD, &both), &["--goal and --goal-tip"]);
    let clearance = Overrides { clearance: Some(f64::NAN), ..Overrides::default() };
    refused(load_files("arm.urdf", ARM, WORLD, &clearance), &["--clearance"]);
}

#[test]
fn touching_counts_as_contact() {
    // The straight forearm reaches x = 2, where the wall is.
    let wall = |x: f64| {
        let world = WORLD.replace("joints = [0.0, 0.5]", "joints = [0.0, 0.0]");
        format!("{world}[[obstacle]]\nname = \"wall\"\npolyline = [[{x}, -1], [{x}, 1]]\n")
    };
    refused(
        load_files("arm.urdf", ARM, &wall(2.0), &Overrides::default()),
        &["\"fore\" hits obstacle \"wall\", just touching"],
    );
    let problem = load_files("arm.urdf", ARM, &wall(2.0 + 1e-9), &Overrides::default()).unwrap().problem;
    assert!((problem.scene().clearance(problem.start()) - 1e-9).abs() < 1e-12);
}

#[test]
fn overrides_replace_the_world() {
    let overrides = Overrides {
        start: Some("10deg, 20deg".parse().unwrap()),
        goal_tip: Some("1.2,1.0".parse().unwrap()),
        clearance: Some(0.01),
        ..Overrides::default()
    };
    let problem = load_files("arm.urdf", ARM, WORLD, &overrides).unwrap().problem;
    assert!((problem.start()[0] - 10f64.to_radians()).abs() < 1e-15);
    assert_eq!(problem.scene().workspace().clearance, 0.01);
    assert_eq!(problem.goals().points().count(), 2);
    for q in problem.goals().points() {
        assert!((problem.scene().arm().tip_at(q) - cplan::geometry::Point::new(1.2, 1.0)).norm() < 1e-9);
    }
}

#[test]
fn preferences_are_checked_like_obstacles() {
    let with = |table: &str, parts: &[&str]| bad_world("[[obstacle]]", &format!("{table}\n[[obstacle]]"), parts);
    let square = "[[0, 0], [1, 0], [1, 1], [0, 1]]";
    for (table, parts) in [
        (format!("polygon = {square}"), ["line 6", "missing key `epsilon`"]),
        ("epsilon = 0.5".into(), ["line 6", "needs either `configurations` or `polygon`, it has neither"]),
        (format!("epsilon = 1\npolygon = {square}\nconfigurations = {square}"), ["preference 1", "it has both"]),
        (format!("epsilon = inf\npolygon = {square}"), ["line 7, column 11", "is not a finite number"]),
        (format!("name = \"bay\"\nepsilon = 1\ncircle = {square}"), ["line 9", "unknown key `circle`"]),
        (format!("epsilon = 1\ndirection = [0, 0]\npolygon = {square}"), ["line 8", "the direction is zero"]),
        (format!("epsilon = 1\ndirection = [1]\npolygon = {square}"), ["line 8", "expected two numbers"]),
        ("epsilon = 1\npolygon = [[0, 0], [1, 1], [1, 0], [0, 1]]".into(), ["line 8", "is not a simple polygon"]),
        (
            "name = \"bay\"\nepsilon = 1\nconfigurations = [[0, 0], [101, 0], [0, 1]]".into(),
            ["preference \"bay\"", "too wide"],
        ),
    ] {
        with(&format!("[[preference]]\n{table}"), &parts);
    }
}

#[test]
fn preferences_reach_the_workspace() {
    let tables = r#"
[[preference]]
epsilon = -0.5
direction = [0, -2]
configurations = [[0, 0], [1, 0], [1, 1]]
[[preference]]
name = "bay"
epsilon = 1.5
polygon = [[0, 0], [0, 1], [1, 1]]
"#;
    let loaded = load_files("arm.urdf", ARM, &format!("{WORLD}{tables}"), &Overrides::default()).unwrap();
    let [first, second] = &loaded.problem.scene().workspace().preferences[..] else { panic!("two preferences") };
    assert_eq!((first.name.as_str(), first.epsilon, first.direction), ("preference 1", -0.5, Some([0.0, -1.0])));
    assert_eq!((second.name.as_str(), second.epsilon, second.direction), ("bay", 1.5, None));
    assert!(matches!(&first.region, Region::Configurations(polygon) if polygon.corners().len() == 3));
    assert!(matches!(&second.region, Region::Tip(polygon) if polygon.area() == 0.5));
}

/// Checks that the message about a number that is too large states the bound.
#[test]
fn too_large_numbers_are_refused_with_the_bound() {
    bad_arm("xyz=\"0.5 0 0\"", "xyz=\"1000500 0 0\"", &["line 9", "at most 1e6", "from -1e6 to 1e6"]);
    bad_arm("size=\"1 0.1 0.1\"", "size=\"2e6 0.1 0.1\"", &["line 9", "at most 1e6", "from -1e6 to 1e6"]);
    with_robot("at = [1000500, 0]", &["at most 1e6", "from -1e6 to 1e6"]);
}
