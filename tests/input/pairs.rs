//! Robots with more than two joints that move in one plane.

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

#[test]
fn of_several_planar_pairs_that_share_a_plane_the_first_is_taken_with_a_note() {
    for (joints, pairs, first) in [
        (vec![("revolute", UP); 3], 2, ["j1", "j2"]),
        (vec![("prismatic", UP), ("revolute", UP), ("revolute", UP), ("revolute", UP)], 2, ["j2", "j3"]),
        (vec![("revolute", UP), ("revolute", ACROSS), ("revolute", ACROSS), ("revolute", ACROSS)], 2, ["j2", "j3"]),
    ] {
        let (names, notes) = chosen(&chain(&joints));
        assert_eq!(names, first, "{joints:?}");
        let note = format!(
            "the first of {pairs} planar pairs of neighbours, which share a plane; [robot] joints chooses others"
        );
        assert!(notes.contains(&note), "{notes}");
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
