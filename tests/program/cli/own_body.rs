//! The robot's own body as an obstacle: static links for both links, and link 1 for the parts that link 2 carries.

use super::*;
/// A SCARA with a reach of 1.05 m. It stands on a pedestal 272 mm high, has arms of 560 and 490 mm above it, and a
/// quill whose lower end is at the height `{quill}` m. The words in braces are placeholders for what differs between
/// cases.
const SCARA: &str = r#"<robot name="scara">
<link name="base_link"> <collision> <origin xyz="-0.0185 0 0.136"/> <geometry> <box size="0.297 0.21 0.272"/> </geometry> </collision> </link>
<joint name="j1" type="revolute">
  <parent link="base_link"/> <child link="inner"/> <origin xyz="0 0 0.3"/> <axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" velocity="5" effort="1"/>
</joint>
<link name="inner"> <collision> <origin xyz="0.28 0 0.04"/> <geometry> <box size="0.66 0.2 0.08"/> </geometry> </collision> </link>
<joint name="j2" type="revolute">
  <parent link="inner"/> <child link="outer"/> <origin xyz="0.56 0 0.1"/> <axis xyz="0 0 1"/>
  <limit lower="-3.1" upper="3.1" velocity="5" effort="1"/>
</joint>
<link name="outer"> <collision> <origin xyz="0.245 0 0.04"/> <geometry> <box size="0.59 0.15 0.08"/> </geometry> </collision> </link>
<joint name="j3" type="prismatic">
  <parent link="outer"/> <child link="quill"/> <origin xyz="0.49 0 0"/> <axis xyz="0 0 1"/>
  <limit lower="-0.3" upper="0.1" velocity="1" effort="1"/>
</joint>
<link name="quill"> <collision> <origin xyz="0 0 {middle}"/> <geometry> <cylinder radius="0.02" length="{length}"/> </geometry> </collision> </link>
{more}
</robot>"#;

/// Returns the robot with a quill from this height up to 0.5 m, and with more links.
fn scara(quill: f64, more: &str) -> String {
    let (middle, length) = (f64::midpoint(quill, 0.5) - 0.4, 0.5 - quill);
    SCARA.replace("{middle}", &middle.to_string()).replace("{length}", &length.to_string()).replace("{more}", more)
}

const FILES: [&str; 2] = ["arm.urdf", "world.toml"];

fn run(urdf: &str, world: &str, options: &str) -> Done {
    Place::new().with(FILES[0], urdf).with(FILES[1], world).run(&FILES, options)
}

/// Checks the exit code of a plan, and that its certificate holds.
#[track_caller]
fn certified(urdf: &str, world: &str, code: i32) -> (Place, Done) {
    let place = Place::new().with(FILES[0], urdf).with(FILES[1], world);
    let (done, _) = place.certified(FILES[0], FILES[1], "--json --quiet", code);
    (place, done)
}

const WORLD: &str =
    "[robot]\njoints = [\"j1\", \"j2\"]\n{robot}\n[start]\njoints = [0.0, 1.0]\n[goal]\njoints = {goal}\n";

/// Returns a world without obstacles, with more entries in its `[robot]` table.
fn world(robot: &str, goal: [f64; 2]) -> String {
    WORLD.replace("{robot}", robot).replace("{goal}", &format!("{goal:?}"))
}

/// A folded configuration. The tip is 72 mm from axis 1, over the pedestal.
const FOLDED: [f64; 2] = [0.5, 3.1];

#[test]
fn the_base_and_link_1_are_in_the_way_of_the_quill() {
    let allowed = "ignore_contact = [[\"inner\", \"quill\"]]";
    let both = "ignore_contact = [[\"quill\", \"base_link\"], [\"inner\", \"quill\"]]";
    for (what, quill, robot, link, is_hit) in [
        ("98 mm within the pedestal", 0.174, allowed, "base_link", true),
        ("over the pedestal", 0.273, allowed, "base_link", false),
        ("it may touch the pedestal", 0.174, both, "base_link", false),
        ("no body", 0.174, "own_body = false", "base_link", false),
        ("beside link 1 when folded", 0.29, "", "inner", true),
        ("above link 1", 0.381, "", "inner", false),
        ("it may touch link 1", 0.29, allowed, "inner", false),
    ] {
        let done = run(&scara(quill, ""), &world(robot, FOLDED), "--json --quiet").exits(i32::from(is_hit));
        let hit = format!(r#"link \"outer\" (body \"quill\") hits link \"{link}\""#);
        assert_eq!(done.stdout.contains(&hit), is_hit, "{what}: {}", done.stdout);
    }
}

/// Checks that joint 2 does not pass the angles at which the quill would be in link 1. If joint 2 has no limit, it
/// turns in the other direction.
#[test]
fn joint_2_does_not_pass_the_fold() {
    let urdf = scara(0.29, "").replace(r#"<limit lower="-3.1" upper="3.1" velocity="5" effort="1"/>"#, "");
    let turns = urdf.replace(r#"name="j2" type="revolute""#, r#"name="j2" type="continuous""#);
    let long = world("limits = { j1 = [-0.2, 0.2] }", [0.0, -2.0]);
    let (_, found) = certified(&turns, &long, 0);
    let path: Vec<[f64; 2]> = serde_json::from_value(found.json()["path"].clone()).unwrap();
    assert!((path[path.len() - 1][1] + 2.0).abs() < 1e-9, "the long way round: {path:?}");
    // A post blocks the other direction.
    let post = "[[obstacle]]\ncircle = { center = [0.9, 0.0], radius = 0.15 }\n";
    let (place, _) = certified(&turns, &(long + post), 3);
    let explained = place.run(&["explain", "arm.urdf", "world.toml"], "--json");
    let blocking = &explained.json()["blocking"];
    assert!(blocking.as_array().unwrap().contains(&"inner".into()), "{}", explained.stdout);
}

/// Checks a hand without collision geometry, whose visual geometry counts although the link that it is attached to has
/// collision geometry.
#[test]
fn a_hand_that_has_only_a_visual_is_not_left_out() {
    let hand = r#"<joint name="mount" type="fixed"> <parent link="outer"/> <child link="hand"/> <origin xyz="0.49 0 0"/> </joint>
        <link name="hand"> <visual> <origin xyz="0.1 0 0.04"/> <geometry> <box size="0.2 0.05 0.05"/> </geometry> </visual> </link>"#;
    let post = "[[obstacle]]\nname = \"post\"\ncircle = { center = [1.2, 0.0], radius = 0.02 }\n";
    let at_post = |more| run(&scara(0.39, more), &(world("tip = \"quill\"", [0.0, 0.0]) + post), "");
    at_post("").exits(0);
    at_post(hand).refused(1, &[r#"link "outer" (body "hand") hits obstacle "post""#]);
    let beside = run(&scara(0.39, hand), &(world("tip = \"quill\"", [0.0, -1.0]) + post), "");
    beside.says(&["that of the visual geometry: \"hand\""]);
}

#[test]
fn links_that_meet_in_every_configuration_are_named() {
    // A plate fixed to the base surrounds the quill in every configuration.
    let plate = r#"<joint name="floor" type="fixed"> <parent link="base_link"/> <child link="plate"/> </joint>
        <link name="plate"> <collision> <origin xyz="0 0 0.42"/> <geometry> <cylinder radius="3" length="0.01"/> </geometry> </collision> </link>"#;
    let report = "contact is ignored between shapes that meet in every configuration: \"plate\" and \"outer\", \"plate\" and \"quill\"";
    run(&scara(0.39, plate), &world("", [0.0, -1.0]), "").exits(0).says(&[report]);
}

/// An arm of two bars that are 0.4 m long. Braces stand for its root, with everything that hangs from it, and for the
/// range of joint 2.
const ON_A_BASE: &str = r#"<robot name="arm"> {base}
<joint name="j1" type="revolute">
  <parent link="base"/> <child link="L1"/> <origin xyz="0 0 0.1"/> <axis xyz="0 0 1"/> <limit lower="-2.5" upper="2.5" effort="1" velocity="2"/>
</joint>
<link name="L1"> <collision> <origin xyz="0.2 0 0"/> <geometry> <box size="0.4 0.04 0.04"/> </geometry> </collision> </link>
<joint name="j2" type="revolute">
  <parent link="L1"/> <child link="L2"/> <origin xyz="0.4 0 {rise}"/> <axis xyz="0 0 1"/> <limit lower="-{bend}" upper="{bend}" effort="1" velocity="2"/>
</joint>
<link name="L2"> <collision> <origin xyz="0.2 0 0"/> <geometry> <box size="0.4 0.04 0.04"/> </geometry> </collision> </link> </robot>"#;

fn on_a_base(base: &str, bend: f64, rise: f64) -> String {
    ON_A_BASE.replace("{base}", base).replace("{bend}", &bend.to_string()).replace("{rise}", &rise.to_string())
}

/// Returns a world for a swing of joint 1 from one side to the other.
fn swing(robot: &str) -> String {
    format!("{robot}\n[start]\njoints = [-1.59, 0.0]\n[goal]\njoints = [1.59, 0.0]\n")
}

/// Checks that a part of the base is in the way unless the links may touch it, also for the checker.
#[track_caller]
fn assert_bars(urdf: &str, link: &str) {
    certified(urdf, &swing(""), 3);
    certified(urdf, &swing(&format!("[robot]\nignore_contact = [[\"{link}\", \"L1\"], [\"{link}\", \"L2\"]]")), 0);
}

/// Checks a plate in front of the arm. Start and goal are beside it, and at 32 values of each joint link 2 is in it.
#[test]
fn a_plate_that_is_left_at_both_ends_counts() {
    let plate = r#"<link name="base"> <collision> <origin xyz="0.54 0 0.15"/> <geometry> <box size="1.0 1.56 0.1"/> </geometry> </collision> </link>"#;
    assert_bars(&on_a_base(plate, 0.01, 0.1), "base");
}

/// Checks a post beside link 1 that hangs from a root without a shape, with one, and behind further fixed joints.
#[test]
fn a_post_beside_link_1_counts_whatever_it_hangs_from() {
    let post = |parent: &str, root: &str| {
        format!(
            r#"<link name="base"> {root} </link>
            <joint name="f" type="fixed"> <parent link="base"/> <child link="frame"/> </joint> <link name="frame"/>
            <joint name="p" type="fixed"> <parent link="{parent}"/> <child link="post"/> <origin xyz="0.25 0.15 0.1"/> </joint>
            <link name="post"> <collision> <geometry> <cylinder radius="0.03" length="0.2"/> </geometry> </collision> </link>"#
        )
    };
    let foot = r#"<collision> <geometry> <cylinder radius="0.05" length="0.2"/> </geometry> </collision>"#;
    for parent in ["base", "frame"] {
        for root in ["", foot] {
            assert_bars(&on_a_base(&post(parent, root), 2.5, 0.05), "post");
        }
    }
}

/// Checks a base of a column at the axis and a cable box beside it.
#[test]
fn shapes_of_a_neighbor_count_one_by_one() {
    let base = |cable_box: &str| {
        format!(
            r#"<link name="base">
            <collision> <geometry> <cylinder radius="0.05" length="0.2"/> </geometry> </collision>
            <collision> <origin xyz="{cable_box} 0.1"/> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision> </link>"#
        )
    };
    assert_bars(&on_a_base(&base("0.25 0.15"), 2.5, 0.05), "base");
    let beside = run(&on_a_base(&base("-0.25 0.0"), 2.5, 0.05), &swing(""), "").exits(0);
    beside.says(&[
        "is ignored between shapes that meet in every configuration: shape 1 of \"base\" and shape 1 of \"L1\"",
    ]);
}

/// Checks the hint of an arm whose shapes collide near a joint. The line that it offers helps.
#[test]
fn the_hint_names_shapes_that_are_too_large() {
    let base = r#"<link name="base"> <collision> <origin xyz="-0.02 0.05 0.1"/> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision>
        <collision> <origin xyz="0.1 0 0.1"/> <geometry> <box size="0.05 0.02 0.1"/> </geometry> </collision> </link>"#;
    let urdf = on_a_base(base, 2.5, 0.05);
    let at_zero =
        |robot: &str| run(&urdf, &format!("{robot}\n[start]\njoints = [0, 0]\n[goal]\njoints = [1, 1]\n"), "");
    let line = "ignore_contact = [[\"base\", \"L1\"]]";
    let parts = ["link \"L1\" hits link \"base\"", "shape 1 of \"L1\" and shape 2 of \"base\"", line];
    at_zero("").refused(1, &parts);
    at_zero(&format!("[robot]\n{line}")).exits(0);
}

#[test]
fn links_that_the_robot_does_not_have_are_refused() {
    for (robot, parts) in [
        ("ignore_contact = [[\"base\", \"quill\"]]", ["no link \"base\"", "\"base_link\", \"inner\""]),
        ("ignore_contact = [[\"base_link\"]]", ["a pair of links needs two names, not 1", "ignore_contact = [["]),
    ] {
        let done = run(&scara(0.39, ""), &world(robot, [0.0, -1.0]), "");
        done.refused(1, &parts);
        done.warns(&["world.toml: line 3"]);
    }
}

/// Checks a link of a box and of a bar that replaces an unreadable mesh. The base always meets the bar, which begins at
/// the axis, but not the box, although both have the number 0.
#[test]
fn a_bar_is_no_layer_of_a_box() {
    let base = r#"<link name="base"> <collision> <origin xyz="0.15 0 0.1"/> <geometry> <box size="0.4 0.1 0.1"/> </geometry> </collision> </link>"#;
    let mesh = r#"<collision> <geometry> <mesh filename="missing.stl"/> </geometry> </collision>"#;
    let link = r#"<link name="L1"> <collision> <origin xyz="0.2 0 0"/> <geometry> <box size="0.4 0.04 0.04"/>"#;
    let urdf = on_a_base(base, 0.01, 0.05);
    let urdf = urdf.replace(link, &link.replace("0.2 0 0", "0.3 0 0").replace("0.4 0.04", "0.1 0.04"));
    let urdf = urdf.replace("</link>\n<joint name=\"j2\"", &format!("{mesh} </link>\n<joint name=\"j2\""));
    assert!(urdf.contains("missing.stl") && urdf.contains("0.3 0 0"));
    run(&urdf, &swing("[robot]\nbar = 0.01"), "--quiet").exits(3);
}
