//! The joints that files name, and accelerations if they are requested.

use super::{Certified, Run, files, judge, root};
use cplan::input::load_scene;
use std::path::Path;

/// A two-link arm on a rail that is held. It has a gripper whose fingers mimic each other, and a fan that mimics the
/// elbow.
const ROBOT: &str = r#"<robot name="rig">
  <link name="base"/>
  <joint name="fan" type="continuous"><parent link="base"/><child link="blades"/><axis xyz="0 0 1"/>
    <mimic joint="elbow" multiplier="-2" offset="0.25"/></joint>
  <link name="blades"/>
  <joint name="rail" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" velocity="1" effort="1"/></joint>
  <link name="carriage"/>
  <joint name="shoulder" type="revolute"><parent link="carriage"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="2" effort="1"/></joint>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="3" effort="1"/></joint>
  <link name="fore"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <joint name="left" type="prismatic"><parent link="fore"/><child link="left_finger"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" velocity="1" effort="1"/></joint>
  <link name="left_finger"/>
  <joint name="right" type="prismatic"><parent link="fore"/><child link="right_finger"/><axis xyz="0 1 0"/>
    <limit lower="-0.1" upper="0.1" velocity="1" effort="1"/><mimic joint="left" multiplier="-1"/></joint>
  <link name="right_finger"/>
</robot>"#;

const WORLD: &str = "[robot]\njoints = [\"shoulder\", \"elbow\"]\nfixed = { rail = 0.5, left = 0.03 }\n\
                     [start]\njoints = [0.0, 0.4]\n[goal]\njoints = [1.0, -0.8]\n";

fn rig(options: &[&str]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let (robot, world) = (folder.path().join("rig.urdf"), folder.path().join("world.toml"));
    std::fs::write(&robot, ROBOT).unwrap();
    std::fs::write(&world, WORLD).unwrap();
    let run = Run::of(&robot, &world, options);
    assert_eq!(run.code, 0, "{}", run.errors);
    run
}

#[test]
fn messages_name_every_movable_joint_of_the_robot() {
    let run = rig(&[]);
    let message = files::yaml(&run.text("yaml"));
    assert_eq!(message.joints, ["fan", "rail", "shoulder", "elbow", "left", "right"]);
    for [position, velocity, acceleration] in &message.points {
        let (shoulder, elbow) = (position[2], position[3]);
        // A held joint stays at its value in the world, and mimicking joints follow their rule.
        assert_eq!(position[..], [-2.0 * elbow + 0.25, 0.5, shoulder, elbow, 0.03, -0.03]);
        assert_eq!(velocity[..], [-2.0 * velocity[3] + 0.0, 0.0, velocity[2], velocity[3], 0.0, 0.0]);
        assert!(acceleration.is_empty());
    }
    #[cfg(feature = "mcap")]
    {
        let file = run.bytes("mcap");
        let messages = files::mcap(&file);
        assert_eq!((messages.len(), &messages[0].1.points), (1, &message.points));
        let states = files::states(&file);
        assert_eq!(states.len(), message.points.len());
        assert!(states.iter().all(|(_, names, position)| *names == message.joints && position.len() == 6));
    }
    // Tables contain only the two planned joints.
    assert!(run.text("csv").starts_with("time,shoulder,elbow,shoulder_velocity,elbow_velocity\n"));
}

#[test]
fn messages_can_name_only_the_planned_joints() {
    let run = rig(&["--joints", "planned"]);
    let message = files::yaml(&run.text("yaml"));
    assert_eq!(message.joints, ["shoulder", "elbow"]);
    assert!(message.points.iter().all(|[position, velocity, _]| [position.len(), velocity.len()] == [2, 2]));
    #[cfg(feature = "mcap")]
    assert_eq!(files::mcap(&run.bytes("mcap"))[0].1.joints, ["shoulder", "elbow"]);
}

#[test]
fn accelerations_that_jump_are_refused() {
    let files = [root("robots/planar_2r.urdf"), root("workspaces/shelf.toml")];
    let run = Run::of(&files[0], &files[1], &["--accelerations"]);
    assert_eq!(run.code, 1);
    for word in ["accelerations cannot be written", "quintics", "--jerk"] {
        assert!(run.errors.contains(word), "{}", run.errors);
    }
}

#[test]
fn quintics_through_accelerations_are_the_certified_motion_where_the_jerk_is_limited() {
    let (robot, world) = (root("robots/planar_2r.urdf"), root("workspaces/shelf.toml"));
    let options = ["--jerk", "200,300", "--accelerations"];
    let run = Run::of(&robot, &world, &options);
    assert_eq!(run.code, 0, "{}", run.errors);
    let (certified, joints) =
        (Certified::of(&run.json()), load_scene(&robot, &world).unwrap().scene.into_parts().0.joints);
    for message in [files::yaml(&run.text("yaml")), files::csv(&run.text("csv"))] {
        assert!(message.points.iter().all(|[.., acceleration]| acceleration.len() == 2));
        let extremes = judge("shelf with a limited jerk", &message, 0, &certified, &joints);
        assert!(extremes.acceleration > 0.5 && extremes.off < 1e-9, "{extremes:?}");
    }
    #[cfg(feature = "mcap")]
    judge("shelf, MCAP", &files::mcap(&run.bytes("mcap"))[0].1, 0, &certified, &joints);
}

#[test]
fn a_limit_on_one_jerk_is_not_enough_where_the_other_joint_moves_alone() {
    let world = "[start]\njoints = [0.0, 0.5]\n[goal]\njoints = [0.8, 0.5]\n";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("world.toml");
    std::fs::write(&file, world).unwrap();
    let robot: &Path = &root("robots/planar_2r.urdf");
    assert_eq!(Run::of(robot, &file, &["--jerk", "none,300", "--accelerations"]).code, 1);
    assert_eq!(Run::of(robot, &file, &["--jerk", "300,none", "--accelerations"]).code, 0);
}
