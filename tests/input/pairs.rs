//! Robots with more than two joints that move in one plane.

use crate::fits;
use cplan::input::{InputError, LoadedScene, Source, scene_from};

/// Returns a chain of joints, each given by its axis. An upright slide has the axis `(0, 0, 1)`, which no arm can use.
fn chain(joints: &[(&str, [f64; 3])]) -> String {
    let mut urdf = "<robot name=\"chain\"><link name=\"l0\"/>".to_owned();
    for (k, (kind, [x, y, z])) in joints.iter().enumerate() {
        urdf += &format!(
            "<joint name=\"j{next}\" type=\"{kind}\"><parent link=\"l{k}\"/><child link=\"l{next}\"/><origin xyz=\"0.4 0 0\"/>\
             <axis xyz=\"{x} {y} {z}\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>\
             <link name=\"l{next}\"><collision><origin xyz=\"0.2 0 0\"/><geometry><box size=\"0.4 0.1 0.1\"/></geometry></collision></link>",
            next = k + 1
        );
    }
    urdf + "</robot>"
}

fn loaded(urdf: &str) -> Result<LoadedScene, InputError> {
    scene_from(Source::in_memory("chain.urdf", urdf), Source::in_memory("world.toml", ""))
}

fn chosen(urdf: &str) -> ([String; 2], String) {
    let loaded = loaded(urdf).unwrap();
    (loaded.scene.arm().joints.each_ref().map(|joint| joint.name.clone()), loaded.robot.notes.join("\n"))
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const ACROSS: [f64; 3] = [0.0, 1.0, 0.0];

/// Checks that the only planar pair of neighbours is taken, and the first of several that share a plane. A SCARA has two
/// arms, a quill and a wrist, which suits either arm, but is a neighbour of neither.
#[test]
fn the_only_planar_pair_or_the_first_in_a_plane_is_taken_with_a_note() {
    let (turn, lift, pitch) = (("revolute", UP), ("prismatic", UP), ("revolute", ACROSS));
    let first = "the first of 2 planar pairs of neighbours, which share a plane; choose others by [robot] joints";
    for (joints, note, names) in [
        (&[turn, turn, lift, turn][..], "", ["j1", "j2"]),
        (&[lift, turn, turn], "", ["j2", "j3"]),
        (&[turn, lift, turn], "", ["j1", "j3"]),
        (&[turn; 3], first, ["j1", "j2"]),
        (&[lift, turn, turn, turn], first, ["j2", "j3"]),
        (&[turn, pitch, pitch, pitch], first, ["j2", "j3"]),
    ] {
        let (chosen, notes) = chosen(&chain(joints));
        assert_eq!(chosen, names, "{joints:?}");
        fits(&notes, &format!("cplan plans for the joints \"{}\" and \"{}\" ... {note}", names[0], names[1]));
    }
}

#[test]
fn planar_pairs_in_several_planes_or_on_branches_are_refused_with_what_to_write() {
    let two_planes = chain(&[("revolute", UP), ("revolute", UP), ("revolute", ACROSS), ("revolute", ACROSS)]);
    let right = "<joint name=\"r1\" type=\"continuous\"><parent link=\"l0\"/><child link=\"r\"/><axis xyz=\"0 0 1\"/></joint>\
                 <joint name=\"r2\" type=\"continuous\"><parent link=\"r\"/><child link=\"rr\"/><axis xyz=\"0 0 1\"/></joint>\
                 <link name=\"r\"/><link name=\"rr\"/></robot>";
    let two_arms = chain(&[("revolute", UP), ("revolute", UP)]).replace("</robot>", right);
    for urdf in [two_planes, two_arms] {
        let error = loaded(&urdf).unwrap_err().to_string();
        assert!(error.contains("which two should cplan plan for?"), "{error}");
        assert!(error.contains("[robot] joints = [\"j1\", \"j2\"], or [robot] joints = "), "{error}");
        // The hint is sufficient.
        let world = Source::in_memory("world.toml", "[robot]\njoints = [\"j1\", \"j2\"]\n");
        let chosen = scene_from(Source::in_memory("chain.urdf", &*urdf), world).unwrap().scene;
        assert_eq!(chosen.arm().joints.each_ref().map(|joint| joint.name.as_str()), ["j1", "j2"]);
    }
}

/// Checks yaw, pitch, yaw: the axes of the yaws are parallel only while the pitch is held. Then checks axes of which no two
/// suit, and a pair that the world names.
#[test]
fn joints_in_no_common_plane_are_refused() {
    let crooked = [("revolute", UP), ("revolute", ACROSS), ("revolute", UP)];
    let none = [("revolute", UP), ("revolute", ACROSS), ("revolute", [1.0, 0.0, 0.0])];
    let scara = [("revolute", UP), ("revolute", UP), ("prismatic", UP), ("revolute", UP)];
    for (joints, world, pattern) in [
        (&crooked[..], "", "which two ... [robot] joints = [\"j1\", \"j3\"]"),
        (&none, "", "no two of the robot's 3 movable joints ... hint"),
        (&scara, "[robot]\njoints = [\"j2\", \"j3\"]\n", "one common plane ... [robot] joints = [\"j1\", \"j2\"]"),
    ] {
        let urdf = Source::in_memory("chain.urdf", chain(joints));
        fits(&scene_from(urdf, Source::in_memory("world.toml", world)).unwrap_err().to_string(), pattern);
    }
}
