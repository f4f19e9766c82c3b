//! Invalid input of every kind. It is refused with the file, the line, the defect, and a hint. Following the hint never
//! leads to another error.

use super::{changes, fits, with_change};
use cplan::input::{self, InputError, LoadedProblem, Overrides, load};
use cplan::model::Region;
use std::fs;

/// A valid two-link arm in the (x, y) plane.
const ARM: &str = r#"<robot name="arm">
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
const WORLD: &str = r#"name = "test"
[start]
joints = [0.0, 0.5]
[goal]
joints = [1.0, -0.5]
[[obstacle]]
name = "post"
circle = { center = [-1.5, 0], radius = 0.2 }
"#;

fn load_files(urdf_name: &str, urdf: &str, world: &str, overrides: &Overrides) -> Result<LoadedProblem, InputError> {
    let folder = tempfile::tempdir().unwrap();
    let (u, w) = (folder.path().join(urdf_name), folder.path().join("world.toml"));
    fs::write(&u, urdf).unwrap();
    fs::write(&w, world).unwrap();
    load(input::robot(&u), &w, overrides)
}

fn loaded(urdf: &str, world: &str) -> Result<LoadedProblem, InputError> {
    load_files("arm.urdf", urdf, world, &Overrides::default())
}

#[track_caller]
fn refused(result: Result<LoadedProblem, InputError>, pattern: &str) {
    fits(&result.expect_err("should be refused").to_string(), pattern);
}

/// Checks that files are refused with a message, and that they load after each change that its hint suggests.
#[track_caller]
fn is_mended(urdf: &str, world: &str, pattern: &str, mended: &[[&str; 2]]) {
    refused(loaded(urdf, world), pattern);
    for [urdf, world] in mended {
        let found = loaded(urdf, world);
        assert!(found.is_ok(), "{pattern:?} leads to:\n{}", found.unwrap_err());
    }
}

/// Checks the arm with these changes.
#[track_caller]
fn arms(table: &str) {
    for row in changes(table) {
        let urdf = |text: &String| with_change(ARM, &row[0], text);
        let mended: Vec<String> = row[3..].iter().map(urdf).collect();
        let mended: Vec<[&str; 2]> = mended.iter().map(|urdf| [urdf.as_str(), WORLD]).collect();
        is_mended(&urdf(&row[1]), WORLD, &format!("arm.urdf ... {}", row[2]), &mended);
    }
}

/// Checks the world with these changes.
#[track_caller]
fn worlds(table: &str) {
    for row in changes(table) {
        let world = |text: &String| with_change(WORLD, &row[0], text);
        let mended: Vec<String> = row[3..].iter().map(world).collect();
        let mended: Vec<[&str; 2]> = mended.iter().map(|world| [ARM, world.as_str()]).collect();
        is_mended(ARM, &world(&row[1]), &format!("world.toml ... {}", row[2]), &mended);
    }
}

/// Returns the world with a `[robot]` table.
fn robot(table: &str) -> String {
    with_change(WORLD, "[start]", &format!("[robot]\n{table}\n[start]"))
}

#[test]
fn the_healthy_files_load() {
    let loaded = loaded(ARM, WORLD).unwrap();
    assert_eq!(loaded.problem.scene().arm().tip_name, "tool");
    assert!(loaded.robot.geometry.iter().any(|n| n.contains("heights along z")));
    assert!(loaded.robot.notes.iter().any(|n| n.contains("top speed in 0.25 s")));
    assert!(loaded.robot.warnings.is_empty());
}

#[test]
fn invalid_numbers_and_joints_of_robots_are_refused() {
    arms(
        r#"
xyz="0.5 0 0" => xyz="0.5 nan 0" => line 9 ... link "upper" ... not finite
" => xyz="0.5 0" => line 9 ... has 2 numbers, not 3 ... separate numbers by blanks, as in "0.5 0 0" => xyz="0.5 0 0"
" => xyz="1000500 0 0" => line 9 ... at most 1e6 ... from -1e6 to 1e6
" => xyz="2e6 0 0" => divide lengths in millimetres by 1000 => xyz="2e3 0 0"
size="1 0.1 0.1" => size="1 -0.1 0.1" => line 9 ... must be positive ... lengths in metres that are above 0
    => size="1 0.1 0.1"
" => size="2e6 0.1 0.1" => line 9 ... at most 1e6 ... from -1e6 to 1e6
<axis xyz="0 0 1"/> => <axis xyz="0 0 0"/> => line 5 ... joint "j1" ... is zero ... give the axis ... such as xyz="0 0 1"
    => <axis xyz="0 0 1"/>
" => nothing => joint "j1" has no <axis> => <axis xyz="0 0 1"/>
lower="-3" => lower="nan" => line 6 ... joint "j1" ... not finite ... continuous
upper="3" => upper="three" => line 6 ... upper="three" is not a number ... write numbers, such as 0.5 => upper="2.5"
velocity="2" => velocity="-2" => line 6 ... negative ... limits are magnitudes => velocity="2"
lower="-3" upper="3" => lower="3" upper="-3" => line 6 ... reversed ... swap lower and upper => lower="-3" upper="3"
"revolute" => "hinge" => line 3 ... type "hinge" is unknown ... one of revolute, continuous => "revolute" => "continuous"
"#,
    );
    let limits = "lower=\"-3\" upper=\"3\"";
    let world = robot("limits = { j1 = [-3.1, 3.1] }");
    let hint = "[robot] limits = { j1 = [-3.1, 3.1] }, or make it type=\"continuous\"";
    let turning = |urdf: &str| with_change(urdf, "\"revolute\"", "\"continuous\"");
    for (none, defect) in
        [("", "unset"), ("lower=\"-inf\" upper=\"3\"", "too long"), ("lower=\"-1\" upper=\"1e16\"", "too long")]
    {
        let urdf = with_change(ARM, limits, none);
        let pattern = format!("line 6 ... joint \"j1\" ... {defect} ... {hint}");
        is_mended(&urdf, WORLD, &pattern, &[[&urdf, &world], [&turning(ARM), WORLD]]);
        assert!(none.contains("inf") || loaded(&turning(&urdf), WORLD).is_ok());
    }
    let soft = "<safety_controller soft_lower_limit=\"4\" soft_upper_limit=\"5\" k_velocity=\"1\"/></joint>";
    let urdf = with_change(ARM, "</joint>", soft);
    let pattern = "line 7 ... soft limits [4, 5] do not overlap ... limits = { j1 = [-3, 3] }";
    is_mended(&urdf, WORLD, pattern, &[[&urdf, &robot("limits = { j1 = [-3, 3] }")]]);
    // The limits in degrees, or correct as they are written.
    let urdf = with_change(ARM, limits, "lower=\"-150\" upper=\"132.5\"");
    let [degrees, radians] = ["[\"-150deg\", \"132.5deg\"]", "[-150, 132.5]"];
    let mended = [degrees, radians].map(|range| robot(&format!("limits = {{ j1 = {range} }}")));
    let hint = format!("limits = {{ j1 = {degrees} }}; if radians are meant: {{ j1 = {radians} }}");
    is_mended(&urdf, WORLD, &hint, &mended.each_ref().map(|world| [urdf.as_str(), world.as_str()]));
}

#[test]
fn links_that_form_no_tree_are_refused() {
    arms(
        r#"
<parent link="upper"/> => <parent link="uper"/>
    => line 12 ... "uper" does not exist ... correct the name; the links are "base", "upper" => <parent link="upper"/>
<child link="tool"/> => <child link="fore"/>
    => line 20 ... two joints, "j2" (line 11) ... not a tree ... give one of the joints its own child link => <child link="tool"/>
<link name="tool"/> => <link name="fore"/> => line 21 ... second link is named "fore" ... line 17
<joint name="j2" => <joint name="j1" => line 11 ... second joint is named "j1" ... line 3 ... rename one of them
    => <joint name="j2" => <joint name="j7"
<parent link="base"/> => <parent link="tool"/> => cycle ... "j1" ... "j2" ... "end" ... line 
<link name="tool"/> => <link name="tool"/><link name="stray"/>
    => line 21 ... "base", "stray" ... exactly one ... connect these links by fixed joints, or remove => <link name="tool"/>
    => <link name="tool"/><link name="s"/><joint name="t" type="fixed"><parent link="tool"/><child link="s"/></joint>
<link name="base"/> => <link/> => line 2 ... has no name
<child link="upper"/> => nothing => line 3 ... <child> is missing
"#,
    );
}

#[test]
fn files_other_than_urdf_are_refused() {
    arms(
        r#"
<link name="tool"/> => <link name="tool"> => line 22 ... not well-formed XML
</robot> => nothing => not well-formed XML ... never closed
</robot> => <xacro:include filename="a"/></robot> => line 22 ... not declared ... xmlns:xacro=
name="arm" => name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro" v="${x}" => line 1 ... no property "x"
xyz="1 0 0" => xyz="${l1} 0 0" => line 13 ... no property "l1" ... xacro:property
"#,
    );
    let run = |name: &str, text: &str| load_files(name, text, WORLD, &Overrides::default());
    let arm = |name: &str, text: &str| run(name, text).unwrap().problem.scene().arm().clone();
    let plain = arm("arm.urdf", ARM);
    assert_eq!(arm("arm.urdf.xacro", ARM), plain);
    refused(run("arm.sdf", "<sdf version=\"1.6\"><model name=\"m\"/></sdf>"), "line 1 ... SDF ... URDF");
    refused(run("arm.urdf", WORLD), "not well-formed XML");
    refused(run("arm.urdf", ""), "arm.urdf ... not well-formed XML");
    refused(run("arm.urdf", "<html/>"), "root element is <html>");
    // A file is no xacro just because it declares the namespace.
    let declared = ARM.replace("<robot", "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"");
    assert_eq!(arm("arm.urdf", &declared), plain);
    let folder = tempfile::tempdir().unwrap();
    let (urdf, world) = (folder.path().join("arm.urdf"), folder.path().join("world.toml"));
    fs::write(&urdf, ARM).unwrap();
    fs::write(&world, WORLD).unwrap();
    refused(load(&world, &urdf, &Overrides::default()), "arm.urdf ... XML ... the URDF first");
    let missing = load("/nowhere/arm.urdf", "/nowhere/world.toml".as_ref(), &Overrides::default());
    refused(missing, "/nowhere/world.toml ... cannot be read");
}

#[test]
fn robots_without_a_planar_arm_or_shapes_are_refused() {
    arms(
        r#"
<axis xyz="0 0 1"/> => <axis xyz="0 1 0"/> => line 14 ... common plane ... about (0, 1, 0) ... 90.00
type="revolute" => type="fixed" => two joints ... only one movable joint, "j2" (revolute)
" => type="floating" => two joints ... only one
</robot> => <joint name="j3" type="continuous"><parent link="fore"/><child link="w"/><axis xyz="0 1 0"/></joint>
    <joint name="j4" type="continuous"><parent link="w"/><child link="v"/><axis xyz="0 1 0"/></joint>
    <link name="w"/><link name="v"/></robot>
    => 4 movable joints ... "j3" (continuous) ... joints = ["j1", "j2"], or [robot] joints = ["j3", "j4"]
" => <joint name="j3" type="revolute"><parent link="fore"/><child link="w"/>\n<mimic joint="j1"/></joint>
    <link name="w"/></robot> => line 23 ... "j3" mimics joint "j1" ... parallelogram
<box size="1 0.1 0.1"/> => <cone/> => line 9 ... shape <cone> is unknown ... box, cylinder, sphere, capsule or mesh
    => <box size="1 0.1 0.1"/> => <cylinder radius="0.1" length="1"/> => <sphere radius="0.1"/>
"#,
    );
    let bars = robot("bar = 0.05");
    for (file, pattern) in [("a.dae", "STL"), ("package://p/a.stl", "no package of this name")] {
        let urdf = with_change(ARM, "<box size=\"1 0.1 0.1\"/>", &format!("<mesh filename=\"{file}\"/>"));
        is_mended(&urdf, WORLD, &format!("line 9 ... {file} ... {pattern} ... [robot] bar = 0.05"), &[[&urdf, &bars]]);
    }
    let solid = "<collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"1 0.1 0.1\"/></geometry></collision>";
    let bare = ARM.replace(solid, "");
    is_mended(&bare, WORLD, "arm.urdf ... the arm cannot collide ... bar = 0.05", &[[&bare, &bars]]);
}

#[test]
fn robot_tables_that_do_not_fit_are_refused() {
    let rates: String = ["velocity = { j1 = 0 }", "acceleration = { j1 = 0 }", "jerk = { j1 = 0 }"]
        .map(|rate| {
            let (name, mended) = (rate.split(' ').next().unwrap(), rate.replace("= 0", "= 0.5"));
            format!("[start] => {rate} => line 3 ... {name} of \"j1\" must be positive ... give a number above 0 => {mended}\n")
        })
        .concat();
    let jerks = ["-200", "nan", "inf"].map(|jerk| {
        format!("[start] => jerk = {{ j1 = {jerk} }} => line 3, column ... jerk of \"j1\" must be positive ... ^\n")
    });
    let table = r#"
[start] => joints = ["j1", "elbow"] => line 3, column ... no joint "elbow" ... the movable joints are "j1", "j2" ... ^
    => joints = ["j1", "j2"]
" => joints = ["j2", "j1"] => line 3 ... joint "j1" carries joint "j2" ... swap them: joints = ["j1", "j2"] => joints = ["j1", "j2"]
" => joints = ["j1", "j1"] => line 3 ... named twice ... choose two joints of one chain, base to tip
    => joints = ["j1", "j2"]
" => joints = ["j1"] => line 3 ... exactly two ... joints = ["first", "second"], base to tip => joints = ["j1", "j2"]
" => joints = ["j1", "end"] => line 3 ... "end" is of type fixed
" => tip = "hand" => line 3 ... no link "hand" ... the links that it carries are "fore", "tool"
    => tip = "fore" => tip = "tool"
" => tip = "upper" => line 3 ... not carried ... the links that it carries are "fore", "tool" => tip = "fore"
" => fixed = { j1 = 0.1 } => line 3 ... joint "j1" is one of the two planned joints ... remove the joint from `fixed` => fixed = {}
" => limits = { j9 = [0, 1] } => line 3 ... no joint "j9" ... the movable joints are "j1" => limits = { j1 = [0, 1] }
" => limits = { j1 = [1, 0] } => line 3 ... lower (1) must be below upper (0) ... limits = { NAME = [lower, upper] }
    => limits = { j1 = [0, 1] }
" => acceleration = { j1 = nan } => line 3 ... acceleration of "j1"
" => jerk = { j9 = 200 } => line 3 ... no joint "j9"
" => at = [1000500, 0] => at most 1e6 ... from -1e6 to 1e6
" => bar = -1 => line 3 ... bar ... bar = 0.05, metres => bar = 0.05
" => fixd = {} => line 3, column 1 ... unknown key `fixd` ... fixd = {} ... ^^^^ ... did you mean `fixed`?
    => fixed = {} => nothing
"#;
    for row in changes(&[table, &rates, &jerks.concat()].concat()) {
        let mended: Vec<String> = row[3..].iter().map(|table| robot(table)).collect();
        let mended: Vec<[&str; 2]> = mended.iter().map(|world| [ARM, world.as_str()]).collect();
        is_mended(ARM, &robot(&row[1]), &format!("world.toml ... {}", row[2]), &mended);
    }
}

#[test]
fn invalid_obstacles_are_refused() {
    let corners = "list the corners in order round the shape (and round each hole), each once; a wall without area is a polyline \
                   => polygon = [[5, 0], [6, 0], [6, 1], [5, 1]] => polyline = [[5, 0], [6, 0]]";
    let table = r#"
circle = { center = [-1.5, 0], radius = 0.2 } => polygon = [[5, 0], [6, 0]]
    => line 8, column 11 ... obstacle "post" ... three corners ... ^ ... CORNERS
" => polygon = [[5, 0], [6, 1], [6, 0], [5, 1]] => line 8 ... not a simple polygon ... CORNERS
" => polygon = [[5, 0], [6, 0], [7, 0]] => line 8 ... not a simple polygon ... CORNERS
" => polygon = [[5, 0], [5, 0], [6, 0]] => line 8 ... three corners
" => polygon = [[5, nan], [6, 0], [7, 1]] => line 8, column 16 ... not a finite number ... write a number
    => polygon = [[5, 0], [6, 0], [6, 1], [5, 1]]
" => polygon = [[5, 0, 1], [6, 0], [7, 1]] => line 8, column 12 ... two numbers, found 3 ... write a point as [x, y]
    => polygon = [[5, 0], [6, 0], [7, 1]]
" => circle = { center = [5, 0], radius = 0 } => line 8, column 38 ... radius must be positive
    ... give a radius above 0, in metres ... or leave the obstacle out => circle = { center = [5, 0], radius = 1 }
" => circle = { center = [5, 0], radius = 1, r = 2 } => line 8 ... unknown key `r` ... or remove this one
    => circle = { center = [5, 0], radius = 1 }
" => polyline = [[5, 0]] => line 8 ... at least two points ... polyline = [[x, y], [x, y], ...]
    => polyline = [[5, 0], [6, 0]]
" => polyline = [[5, 0], [5, 0]] => line 8 ... at least two points in different places
" => height = [0, 1] => line 6 ... exactly one shape ... has 0 ... give it one of polygon, circle
    => circle = { center = [5, 0], radius = 1 }\nheight = [0, 1]
" => circle = { center = [5, 0], radius = 1 }\npolyline = [[5, 0], [6, 0]] => exactly one shape ... has 2
    ... put a second shape into another [[obstacle]]
    => circle = { center = [5, 0], radius = 1 }\n[[obstacle]]\npolyline = [[5, 0], [6, 0]]
" => circle = { center = [5, 0], radius = 1 }\nheight = [1, 0] => line 9, column 10 ... empty ... write the lower end first
    => circle = { center = [5, 0], radius = 1 }\nheight = [0, 1]
" => circle = { center = [5e9, 0], radius = 1 } => line 8 ... too large ... metres ... from -1e6 to 1e6
    => circle = { center = [1e6, 0], radius = 1 }
" => circle = { center = 5 } => line 8, column 21 ... ^
" => circle = { center = 5, radius = 1 } => center = [x, y] => circle = { center = [5, 0], radius = 1 }
" => colour = "red" => line 8, column 1 ... unknown key `colour`
name = "test" => \nclearance = -0.1 => line 2, column 13 ... clearance ... negative ... write 0 or more
    => clearance = 0 => clearance = 0.1
" => name =  => line 1 ... ^ ... name = "words" => name = "words"
[goal]\njoints = [1.0, -0.5] => [goal]\ntip = [1, 1]\njoints = [0, 0] => line 4 ... both
"#;
    worlds(&table.replace("CORNERS", corners));
}

#[test]
fn invalid_starts_and_goals_are_refused() {
    worlds(
        r#"
joints = [0.0, 0.5] => joints = [3.0, 0.0] => the start ... m deep ... link "fore" hits obstacle "post"
    ... choose a configuration away from the obstacle (touching counts as contact) => joints = [2.7, 0.0]
joints = [1.0, -0.5] => joints = [-3.0, 0.0] => line 5 ... the goal ... link "fore" hits obstacle "post"
    ... choose a configuration away from the obstacle (touching counts as contact) => joints = [-2.7, 0.0]
" => nothing => line 4 ... neither ... joints = [q1, q2], or tip = [x, y] => joints = [0.1, 0.2] => tip = [1.0, 1.0]
" => tip = [3, 0] => line 5 ... out of reach ... 2.0000 m ... choose a point nearer to joint 1 => tip = [1.5, 0]
" => tip = [-1.5, 0.1] => no IK solution ... hits obstacle "post"
    ... choose a point away from the obstacle (touching counts as contact) => tip = [-1.0, 0.9]
[start]\njoints = [0.0, 0.5] => nothing => there is no start ... --start ... [start] joints = [q1, q2]
    => [start]\njoints = [0.1, 0.2]
[goal]\njoints = [1.0, -0.5] => nothing => there is no goal ... --goal-tip ... [goal] joints = [q1, q2] or tip = [x, y]
    => [goal]\njoints = [0.1, 0.2] => [goal]\ntip = [1.0, 1.0]
name = "test" => clearance = 2.0 => the start ... nearer than the clearance of 2 m ... or require less clearance
    => clearance = 0.1
"#,
    );
    // If only limits are violated, there is no obstacle to move away from.
    let (start, goal) = ("joints = [0.0, 0.5]", "joints = [1.0, -0.5]");
    let wide = "[robot]\nlimits = { j1 = [-3.2, 3.2], j2 = [-3.1, 3.1] }\n[start]";
    let points = "choose another point, or change the limits in the world file: of joints in [robot] limits, of motors in [robot] drives";
    let values = "choose values within the limits, or change the limits in the world file: of joints in [robot] limits, of motors in [robot] drives";
    for (key, value, pattern, mended) in [
        (
            start,
            "joints = [0.0, 2.5]",
            ["line 3 ... joint \"j2\" at 2.5 rad ... [-2, 2]", values],
            "joints = [0.0, 1.5]",
        ),
        (
            goal,
            "tip = [0, 0.1]",
            ["line 5 ... no IK solution ... exceeds its limits [-2, 2]", points],
            "tip = [0, 1.5]",
        ),
    ] {
        let world = with_change(WORLD, key, value);
        let mended = [with_change(WORLD, key, mended), with_change(&world, "[start]", wide)];
        is_mended(ARM, &world, &pattern.join(" ... "), &mended.each_ref().map(|world| [ARM, world]));
    }
    // Some IK solutions are past limits, and the others are in contact. A point farther away is free.
    let one_sided = with_change(ARM, "lower=\"-2\" upper=\"2\"", "lower=\"0\" upper=\"2\"");
    let [both, free] = ["tip = [-1.5, 0.1]", "tip = [-1.0, 0.9]"].map(|tip| with_change(WORLD, goal, tip));
    let away = "choose a point away from the obstacle (touching counts as contact)";
    let (_, change_limits) = points.split_once(", or ").unwrap();
    is_mended(&one_sided, &both, &format!("{away}, or {change_limits}"), &[[&one_sided, &free]]);
    // A point near the base is out of reach, because the arm cannot fold that far.
    let long = with_change(ARM, "<origin xyz=\"1 0 0\"/></joint>", "<origin xyz=\"0.4 0 0\"/></joint>");
    let [near, far] = ["tip = [0.1, 0.0]", "tip = [1.2, 0.0]"].map(|tip| with_change(WORLD, goal, tip));
    is_mended(&long, &near, "choose a point farther from joint 1", &[[&long, &far]]);
    let overrides = Overrides::default;
    let joints = |text: &str| Some(text.parse().unwrap());
    let both = Overrides { goal: joints("0,0"), goal_tip: Some("1,1".parse().unwrap()), ..overrides() };
    for (overrides, pattern) in [
        (Overrides { start: joints("0,150deg"), ..overrides() }, "--start ... joint \"j2\" at 2.617994 rad"),
        (both, "--goal and --goal-tip"),
        (Overrides { clearance: Some(f64::NAN), ..overrides() }, "--clearance"),
    ] {
        refused(load_files("arm.urdf", ARM, WORLD, &overrides), pattern);
    }
}

#[test]
fn touching_counts_as_contact() {
    // The straight forearm reaches x = 2, where the wall is.
    let wall = |x: f64| {
        let world = WORLD.replace("joints = [0.0, 0.5]", "joints = [0.0, 0.0]");
        format!("{world}[[obstacle]]\nname = \"wall\"\npolyline = [[{x}, -1], [{x}, 1]]\n")
    };
    refused(loaded(ARM, &wall(2.0)), "\"fore\" hits obstacle \"wall\", just touching");
    let problem = loaded(ARM, &wall(2.0 + 1e-9)).unwrap().problem;
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
    let table = r#"
[[obstacle]] => polygon = SQUARE => line 6 ... missing key `epsilon`
" => epsilon = 0.5 => line 6 ... needs either `configurations` or `polygon`, but has neither
" => epsilon = 1\npolygon = SQUARE\nconfigurations = SQUARE => preference 1 ... needs either `configurations` or `polygon`, but has both
" => epsilon = inf\npolygon = SQUARE => line 7, column 11 ... is not a finite number
" => name = "bay"\nepsilon = 1\ncircle = SQUARE => line 9 ... unknown key `circle`
" => epsilon = 1\ndirection = [0, 0]\npolygon = SQUARE => line 8 ... the direction is zero
" => epsilon = 1\ndirection = [1]\npolygon = SQUARE => line 8 ... expected two numbers
" => epsilon = 1\npolygon = [[0, 0], [1, 1], [1, 0], [0, 1]] => line 8 ... is not a simple polygon
" => name = "bay"\nepsilon = 1\nconfigurations = [[0, 0], [101, 0], [0, 1]] => preference "bay" ... too wide
"#;
    for row in changes(&table.replace("SQUARE", "[[0, 0], [1, 0], [1, 1], [0, 1]]")) {
        let world = with_change(WORLD, &row[0], &format!("[[preference]]\n{}\n[[obstacle]]", row[1]));
        refused(loaded(ARM, &world), &format!("world.toml ... {}", row[2]));
    }
}

#[test]
fn preferences_reach_the_workspace() {
    let tables = "[[preference]]\nepsilon = -0.5\ndirection = [0, -2]\nconfigurations = [[0, 0], [1, 0], [1, 1]]\n\
                  [[preference]]\nname = \"bay\"\nepsilon = 1.5\npolygon = [[0, 0], [0, 1], [1, 1]]\n";
    let loaded = loaded(ARM, &format!("{WORLD}{tables}")).unwrap();
    let [first, second] = &loaded.problem.scene().workspace().preferences[..] else { panic!("two preferences") };
    assert_eq!((first.name.as_str(), first.epsilon, first.direction), ("preference 1", -0.5, Some([0.0, -1.0])));
    assert_eq!((second.name.as_str(), second.epsilon, second.direction), ("bay", 1.5, None));
    assert!(matches!(&first.region, Region::Configurations(polygon) if polygon.corners().len() == 3));
    assert!(matches!(&second.region, Region::Tip(polygon) if polygon.area() == 0.5));
}
