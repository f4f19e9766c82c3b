//! Checks that following a hint never leads to another error.

use super::errors::{ARM, WORLD, load_files};
use cplan::input::Overrides;

/// Returns a file with a piece of its text replaced.
fn with_replacement(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// Returns the world with a `[robot]` table.
fn robot(table: &str) -> String {
    with_replacement(WORLD, "[start]", &format!("[robot]\n{table}\n[start]"))
}

/// Checks that files are refused with a hint. Also checks that they load after each change that the hint suggests.
fn check_hint([urdf, world]: [&str; 2], hint: &str, mended: &[[&str; 2]]) {
    let refused = load_files("arm.urdf", urdf, world, &Overrides::default()).expect_err(hint).to_string();
    let hints = refused.split("hint: ").skip(1).collect::<Vec<_>>().join("\n");
    assert!(hints.contains(hint), "no \"{hint}\" in:\n{refused}");
    for [urdf, world] in mended {
        let loaded = load_files("arm.urdf", urdf, world, &Overrides::default());
        assert!(loaded.is_ok(), "\"{hint}\" leads to:\n{}", loaded.unwrap_err());
    }
}

/// Checks a mistake in the URDF, and the corrections that the hint suggests.
fn of_arm(from: &str, slip: &str, hint: &str, mended: &[&str]) {
    let mended: Vec<String> = mended.iter().map(|text| with_replacement(ARM, from, text)).collect();
    let mended: Vec<[&str; 2]> = mended.iter().map(|urdf| [urdf.as_str(), WORLD]).collect();
    check_hint([&with_replacement(ARM, from, slip), WORLD], hint, &mended);
}

/// Checks a mistake in the world file, and the corrections that the hint suggests.
fn of_world(from: &str, slip: &str, hint: &str, mended: &[&str]) {
    let mended: Vec<String> = mended.iter().map(|text| with_replacement(WORLD, from, text)).collect();
    let mended: Vec<[&str; 2]> = mended.iter().map(|world| [ARM, world.as_str()]).collect();
    check_hint([ARM, &with_replacement(WORLD, from, slip)], hint, &mended);
}

/// Checks an invalid `[robot]` table, and the corrections that the hint suggests.
fn of_robot(slip: &str, hint: &str, mended: &[&str]) {
    let mended: Vec<String> = mended.iter().map(|table| robot(table)).collect();
    let mended: Vec<[&str; 2]> = mended.iter().map(|world| [ARM, world.as_str()]).collect();
    check_hint([ARM, &robot(slip)], hint, &mended);
}

#[test]
fn hints_about_numbers_of_the_robot() {
    let xyz = "xyz=\"0.5 0 0\"";
    of_arm(xyz, "xyz=\"0.5 0\"", "separate numbers by blanks, as in \"0.5 0 0\"", &[xyz]);
    of_arm(xyz, "xyz=\"2e6 0 0\"", "divide those in millimetres by 1000", &["xyz=\"2e3 0 0\""]);
    of_arm("upper=\"3\"", "upper=\"three\"", "write numbers, such as 0.5", &["upper=\"2.5\""]);
    let size = "size=\"1 0.1 0.1\"";
    of_arm(size, "size=\"1 -0.1 0.1\"", "lengths in metres that are above 0", &[size]);
    of_arm("velocity=\"2\"", "velocity=\"-2\"", "limits are magnitudes", &["velocity=\"2\""]);
    let axis = "<axis xyz=\"0 0 1\"/>";
    of_arm(axis, "<axis xyz=\"0 0 0\"/>", "such as xyz=\"0 0 1\"", &[axis]);
    of_arm("<axis xyz=\"0 0 1\"/>", "", "joint \"j1\" has no <axis>", &[axis]);
}

#[test]
fn hints_about_limits_of_the_robot() {
    let (limits, turns) = ("lower=\"-3\" upper=\"3\"", "type=\"continuous\"");
    of_arm(limits, "lower=\"3\" upper=\"-3\"", "swap lower and upper", &[limits]);
    let world = robot("limits = { j1 = [-3.1, 3.1] }");
    for none in ["", "lower=\"-inf\" upper=\"3\"", "lower=\"-1\" upper=\"1e16\""] {
        let urdf = with_replacement(ARM, limits, none);
        let continuous = with_replacement(&urdf, "type=\"revolute\"", turns);
        let mended = [[urdf.as_str(), &world], [&with_replacement(ARM, "type=\"revolute\"", turns), WORLD]];
        check_hint([&urdf, WORLD], "[robot] limits = { j1 = [-3.1, 3.1] }, or make it type=\"continuous\"", &mended);
        assert!(none.contains("inf") || load_files("arm.urdf", &continuous, WORLD, &Overrides::default()).is_ok());
    }
    let soft = "<safety_controller soft_lower_limit=\"4\" soft_upper_limit=\"5\" k_velocity=\"1\"/></joint>";
    let urdf = with_replacement(ARM, "</joint>", soft);
    check_hint([&urdf, WORLD], "limits = { j1 = [-3, 3] }", &[[&urdf, &robot("limits = { j1 = [-3, 3] }")]]);
    // The limits in degrees, or correct as they are written.
    let urdf = with_replacement(ARM, limits, "lower=\"-150\" upper=\"132.5\"");
    let [degrees, radians] = ["[\"-150deg\", \"132.5deg\"]", "[-150, 132.5]"];
    let mended = [degrees, radians].map(|range| robot(&format!("limits = {{ j1 = {range} }}")));
    let hint = format!("limits = {{ j1 = {degrees} }}; if they are meant in radians: {{ j1 = {radians} }}");
    check_hint([&urdf, WORLD], &hint, &mended.each_ref().map(|world| [urdf.as_str(), world.as_str()]));
}

#[test]
fn hints_about_the_robots_tree() {
    let parent = "<parent link=\"upper\"/>";
    of_arm(parent, "<parent link=\"uper\"/>", "correct the name; the links are \"base\", \"upper\"", &[parent]);
    let child = "<child link=\"tool\"/>";
    of_arm(child, "<child link=\"fore\"/>", "give one joint its own child link", &[child]);
    let joint = "<joint name=\"j2\"";
    of_arm(joint, "<joint name=\"j1\"", "rename one of them", &[joint, "<joint name=\"j7\""]);
    let tool = "<link name=\"tool\"/>";
    let tied = "<link name=\"tool\"/><link name=\"stray\"/><joint name=\"tie\" type=\"fixed\"><parent link=\"tool\"/>\
                <child link=\"stray\"/></joint>";
    of_arm(
        tool,
        "<link name=\"tool\"/><link name=\"stray\"/>",
        "connect them with a fixed joint, or remove",
        &[tied, tool],
    );
    of_arm(
        "type=\"revolute\"",
        "type=\"hinge\"",
        "one of revolute, continuous",
        &["type=\"revolute\"", "type=\"continuous\""],
    );
}

#[test]
fn hints_about_shapes_of_the_robot() {
    let shape = "<box size=\"1 0.1 0.1\"/>";
    let bars = robot("bar = 0.05");
    for missing in ["<mesh filename=\"a.dae\"/>", "<mesh filename=\"package://p/a.stl\"/>"] {
        let urdf = with_replacement(ARM, shape, missing);
        check_hint([&urdf, WORLD], "[robot] bar = 0.05", &[[&urdf, &bars]]);
    }
    let others = [shape, "<cylinder radius=\"0.1\" length=\"1\"/>", "<sphere radius=\"0.1\"/>"];
    of_arm(shape, "<cone/>", "box, cylinder, sphere, capsule or mesh", &others);
    let solid = "<collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"1 0.1 0.1\"/></geometry></collision>";
    let bare = ARM.replace(solid, "");
    check_hint([&bare, WORLD], "bar = 0.05", &[[&bare, &bars]]);
}

#[test]
fn hints_about_the_robot_table() {
    let joints = "joints = [\"j1\", \"j2\"]";
    of_robot("joints = [\"j1\", \"elbow\"]", "the movable joints are \"j1\", \"j2\"", &[joints]);
    of_robot("joints = [\"j2\", \"j1\"]", joints, &[joints]);
    of_robot("joints = [\"j1\", \"j1\"]", "choose two joints of one chain, base to tip", &[joints]);
    of_robot("joints = [\"j1\"]", "joints = [\"first\", \"second\"], base to tip", &[joints]);
    for tip in ["hand", "upper"] {
        let links = ["tip = \"fore\"", "tip = \"tool\""];
        of_robot(&format!("tip = \"{tip}\""), "the links that it carries are \"fore\", \"tool\"", &links);
    }
    of_robot("fixed = { j1 = 0.1 }", "leave it out of `fixed`", &["fixed = {}"]);
    of_robot("limits = { j9 = [0, 1] }", "the movable joints are \"j1\"", &["limits = { j1 = [0, 1] }"]);
    of_robot("limits = { j1 = [1, 0] }", "limits = { NAME = [lower, upper] }", &["limits = { j1 = [0, 1] }"]);
    for table in ["velocity", "acceleration", "jerk"] {
        of_robot(&format!("{table} = {{ j1 = 0 }}"), "give a number above 0", &[&format!("{table} = {{ j1 = 0.5 }}")]);
    }
    of_robot("bar = -1", "bar = 0.05, metres", &["bar = 0.05"]);
    of_robot("fixd = {}", "use a known key, or remove this one", &["fixed = {}", ""]);
}

#[test]
fn hints_about_obstacles() {
    let shape = "circle = { center = [-1.5, 0], radius = 0.2 }";
    let square = "polygon = [[5, 0], [6, 0], [6, 1], [5, 1]]";
    for slip in ["[[5, 0], [6, 0]]", "[[5, 0], [6, 1], [6, 0], [5, 1]]", "[[5, 0], [6, 0], [7, 0]]"] {
        let wall = "polyline = [[5, 0], [6, 0]]";
        let hint = "list the corners in order round the shape (and round each hole), each once; a wall without area is a polyline";
        of_world(shape, &format!("polygon = {slip}"), hint, &[square, wall]);
    }
    of_world(shape, "polygon = [[5, nan], [6, 0], [7, 1]]", "write a number", &[square]);
    of_world(
        shape,
        "polygon = [[5, 0, 1], [6, 0], [7, 1]]",
        "write a point as [x, y]",
        &["polygon = [[5, 0], [6, 0], [7, 1]]"],
    );
    let round = "circle = { center = [5, 0], radius = 1 }";
    of_world(shape, "circle = { center = [5, 0], radius = 0 }", "give a radius above 0, in metres", &[round]);
    of_world(
        &format!("[[obstacle]]\nname = \"post\"\n{shape}"),
        "[[obstacle]]\ncircle = { center = [5, 0], radius = 0 }",
        "or leave the obstacle out",
        &[""],
    );
    of_world(shape, "circle = { center = [5, 0], radius = 1, r = 2 }", "or remove this one", &[round]);
    of_world(shape, "circle = { center = 5, radius = 1 }", "center = [x, y]", &[round]);
    of_world(
        shape,
        "circle = { center = [5e9, 0], radius = 1 }",
        "from -1e6 to 1e6",
        &["circle = { center = [1e6, 0], radius = 1 }"],
    );
    of_world(shape, "polyline = [[5, 0]]", "polyline = [[x, y], [x, y], ...]", &["polyline = [[5, 0], [6, 0]]"]);
    of_world(shape, "height = [0, 1]", "give it one of polygon, circle", &[&format!("{round}\nheight = [0, 1]")]);
    let two = format!("{round}\npolyline = [[5, 0], [6, 0]]");
    of_world(
        shape,
        &two,
        "put a second shape into another [[obstacle]]",
        &[&two.replace("\npoly", "\n[[obstacle]]\npoly")],
    );
    of_world(
        shape,
        &format!("{round}\nheight = [1, 0]"),
        "write the lower end first",
        &[&format!("{round}\nheight = [0, 1]")],
    );
    of_world("name = \"test\"", "clearance = -0.1", "write 0 or more", &["clearance = 0", "clearance = 0.1"]);
    of_world("name = \"test\"", "name = ", "name = \"words\"", &["name = \"words\""]);
}

#[test]
fn hints_about_start_and_goal() {
    let (start, goal) = ("joints = [0.0, 0.5]", "joints = [1.0, -0.5]");
    let limits = "choose values within the limits, or change the limits in the world file: of joints in [robot] limits, of motors in [robot] drives";
    let wide = "[robot]\nlimits = { j1 = [-3.2, 3.2], j2 = [-3.1, 3.1] }\n[start]";
    let override_limits = |world: &str| with_replacement(world, "[start]", wide);
    let beyond = with_replacement(WORLD, start, "joints = [0.0, 2.5]");
    check_hint(
        [ARM, &beyond],
        limits,
        &[[ARM, &with_replacement(WORLD, start, "joints = [0.0, 1.5]")], [ARM, &override_limits(&beyond)]],
    );
    let away = "move it away from the obstacle (touching counts as contact)";
    of_world(start, "joints = [3.0, 0.0]", away, &["joints = [2.7, 0.0]"]);
    of_world(goal, "joints = [-3.0, 0.0]", away, &["joints = [-2.7, 0.0]"]);
    of_world(&format!("[start]\n{start}"), "", "[start] joints = [q1, q2]", &["[start]\njoints = [0.1, 0.2]"]);
    let there = ["[goal]\njoints = [0.1, 0.2]", "[goal]\ntip = [1.0, 1.0]"];
    of_world(&format!("[goal]\n{goal}"), "", "[goal] joints = [q1, q2] or tip = [x, y]", &there);
    of_world(goal, "", "joints = [q1, q2], or tip = [x, y]", &["joints = [0.1, 0.2]", "tip = [1.0, 1.0]"]);
    of_world(goal, "tip = [3, 0]", "choose a point nearer to joint 1", &["tip = [1.5, 0]"]);
    // If only limits are violated, there is no obstacle to move away from.
    let points = "choose another point, or change the limits in the world file: of joints in [robot] limits, of motors in [robot] drives";
    let folded = with_replacement(WORLD, goal, "tip = [0, 0.1]");
    check_hint(
        [ARM, &folded],
        points,
        &[[ARM, &with_replacement(WORLD, goal, "tip = [0, 1.5]")], [ARM, &override_limits(&folded)]],
    );
    of_world(goal, "tip = [-1.5, 0.1]", "move it away from the obstacle", &["tip = [-1.0, 0.9]"]);
    // Some IK solutions are past limits, and the others are in contact. A point farther away is free.
    let one_sided = with_replacement(ARM, "lower=\"-2\" upper=\"2\"", "lower=\"0\" upper=\"2\"");
    let both = with_replacement(WORLD, goal, "tip = [-1.5, 0.1]");
    let mended = with_replacement(WORLD, goal, "tip = [-1.0, 0.9]");
    check_hint([&one_sided, &both], &format!("{away}, or {points}"), &[[&one_sided, &mended]]);
    // A point near the base is out of reach, because the arm cannot fold that far.
    let long = with_replacement(ARM, "<origin xyz=\"1 0 0\"/></joint>", "<origin xyz=\"0.4 0 0\"/></joint>");
    let near = with_replacement(WORLD, goal, "tip = [0.1, 0.0]");
    check_hint(
        [&long, &near],
        "choose a point farther from joint 1",
        &[[&long, &with_replacement(WORLD, goal, "tip = [1.2, 0.0]")]],
    );
    let clearance = with_replacement(WORLD, "name = \"test\"", "clearance = 2.0");
    check_hint(
        [ARM, &clearance],
        "or require less clearance",
        &[[ARM, &with_replacement(WORLD, "name = \"test\"", "clearance = 0.1")]],
    );
}
