//! The robot's own body as an obstacle: static links for both links, and link 1 for the parts that link 2 carries.

use super::{Done, Place};
use cplan_check_files::check_files;

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

fn run(urdf: &str, world: &str, options: &str) -> (Place, Done) {
    let place = Place::new();
    place.write("arm.urdf", urdf);
    place.write("world.toml", world);
    let done = place.run(&["arm.urdf", "world.toml"], options);
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
fn the_base_is_in_the_way_of_the_quill() {
    let allowed = "ignore_contact = [[\"inner\", \"quill\"]]";
    for (what, quill, robot, is_hit) in [
        ("98 mm within the pedestal", 0.174, allowed, true),
        ("over it", 0.273, allowed, false),
        ("it may touch", 0.174, "ignore_contact = [[\"quill\", \"base_link\"], [\"inner\", \"quill\"]]", false),
        ("no body", 0.174, "own_body = false", false),
    ] {
        let (_, done) = run(&scara(quill, ""), &world(robot, FOLDED), "--json --quiet");
        assert_eq!(done.code, i32::from(is_hit), "{what}: {}{}", done.stdout, done.stderr);
        let hit = r#"link \"outer\" (body \"quill\") hits link \"base_link\""#;
        assert_eq!(done.stdout.contains(hit), is_hit, "{what}: {}", done.stdout);
    }
}

#[test]
fn link_1_is_in_the_way_of_the_quill() {
    for (what, quill, robot, is_hit) in [
        ("beside it when folded", 0.29, "", true),
        ("above it", 0.381, "", false),
        ("it may touch", 0.29, "ignore_contact = [[\"inner\", \"quill\"]]", false),
    ] {
        let (_, done) = run(&scara(quill, ""), &world(robot, FOLDED), "--json --quiet");
        assert_eq!(done.code, i32::from(is_hit), "{what}: {}{}", done.stdout, done.stderr);
        let hit = r#"link \"outer\" (body \"quill\") hits link \"inner\""#;
        assert_eq!(done.stdout.contains(hit), is_hit, "{what}: {}", done.stdout);
    }
}

/// Checks that joint 2 does not pass the angles at which the quill would be in link 1. If joint 2 has no limit, it
/// turns in the other direction.
#[test]
fn joint_2_does_not_pass_the_fold() {
    let urdf = scara(0.29, "").replace(r#"<limit lower="-3.1" upper="3.1" velocity="5" effort="1"/>"#, "");
    let turns = urdf.replace(r#"name="j2" type="revolute""#, r#"name="j2" type="continuous""#);
    let (place, found) =
        run(&turns, &world("limits = { j1 = [-0.2, 0.2] }", [0.0, -2.0]), "--json --quiet --certificate c.json");
    assert_eq!(found.code, 0, "{}{}", found.stdout, found.stderr);
    let path: Vec<[f64; 2]> = serde_json::from_value(found.json()["path"].clone()).unwrap();
    assert!((path[path.len() - 1][1] + 2.0).abs() < 1e-9, "the long way round: {path:?}");
    let files = ["arm.urdf", "world.toml", "c.json"].map(|name| place.path(name));
    check_files(&files[0], &files[1], &files[2]).expect("holds");
    // A post blocks the other direction.
    let post = "[[obstacle]]\ncircle = { center = [0.9, 0.0], radius = 0.15 }\n";
    let barred = world("limits = { j1 = [-0.2, 0.2] }", [0.0, -2.0]) + post;
    let (place, none) = run(&turns, &barred, "--json --quiet --certificate c.json");
    assert_eq!(none.code, 3, "{}{}", none.stdout, none.stderr);
    let files = ["arm.urdf", "world.toml", "c.json"].map(|name| place.path(name));
    check_files(&files[0], &files[1], &files[2]).expect("holds");
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
    let (_, without) = at_post("");
    assert_eq!(without.code, 0, "{}", without.stderr);
    let (_, with) = at_post(hand);
    with.refused(1, &[r#"link "outer" (body "hand") hits obstacle "post""#]);
    let (_, beside) = run(&scara(0.39, hand), &(world("tip = \"quill\"", [0.0, -1.0]) + post), "");
    assert!(beside.stdout.contains("no collision geometry: \"hand\""), "{}", beside.stdout);
}

#[test]
fn links_that_meet_in_every_configuration_are_named() {
    // A plate fixed to the base surrounds the quill in every configuration.
    let plate = r#"<joint name="floor" type="fixed"> <parent link="base_link"/> <child link="plate"/> </joint>
        <link name="plate"> <collision> <origin xyz="0 0 0.42"/> <geometry> <cylinder radius="3" length="0.01"/> </geometry> </collision> </link>"#;
    let (_, done) = run(&scara(0.39, plate), &world("", [0.0, -1.0]), "");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let report = "links that meet in every configuration is ignored: \"plate\" and \"outer\", \"plate\" and \"quill\"";
    assert!(done.stdout.contains(report), "{}", done.stdout);
    let neighbors = "\"base_link\" and \"inner\", \"inner\" and \"outer\"";
    assert!(done.stdout.contains(neighbors), "{}", done.stdout);
}

#[test]
fn links_that_the_robot_does_not_have_are_refused() {
    for (robot, parts) in [
        ("ignore_contact = [[\"base\", \"quill\"]]", ["no link \"base\"", "\"base_link\", \"inner\""]),
        ("ignore_contact = [[\"base_link\"]]", ["a pair of links needs two names, not 1", "ignore_contact = [["]),
    ] {
        let (_, done) = run(&scara(0.39, ""), &world(robot, [0.0, -1.0]), "");
        done.refused(1, &parts);
        assert!(done.stderr.contains("world.toml: line 3"), "{}", done.stderr);
    }
}
