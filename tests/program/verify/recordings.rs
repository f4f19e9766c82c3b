//! Recordings of ROS 2 topics.
#![cfg(feature = "mcap")]

use serde_json::{Value, json};
use std::path::Path;
use std::process::{Command, Output};

fn shipped(file: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file).display().to_string()
}

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let run = Command::new(env!("CARGO_BIN_EXE_cplan")).current_dir(folder).args(arguments).output();
    let Output { status, stdout, stderr } = run.unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (status.code().expect("no signal"), text(stdout), text(stderr))
}

/// The same message in both formats is the same motion.
#[test]
fn a_recording_is_judged_as_the_message_in_it() {
    let folder = tempfile::tempdir().unwrap();
    for (robot, world) in [("planar_2r", "shelf"), ("scara", "scara_cell")] {
        let (robot, world) = (shipped(&format!("robots/{robot}.urdf")), shipped(&format!("workspaces/{world}.toml")));
        let planned = run(folder.path(), &[&robot, &world, "--output", "m.yaml", "--output", "m.mcap", "--quiet"]);
        assert_eq!(planned.0, 0, "{}", planned.2);
        let found = ["m.yaml", "m.mcap"].map(|file| {
            let (code, json, errors) = run(folder.path(), &["verify", &robot, &world, file, "--json"]);
            let mut found: Value = serde_json::from_str(&json).unwrap_or_else(|e| panic!("{e}: {errors}"));
            let notes = found.as_object_mut().unwrap().remove("notes").unwrap().to_string();
            (code, found, notes)
        });
        assert_eq!((found[0].0, &found[0].1), (found[1].0, &found[1].1));
        assert!(found[1].2.contains("/joint_states are not judged"), "{}", found[1].2);
        std::fs::remove_file(folder.path().join("m.yaml")).unwrap();
        std::fs::remove_file(folder.path().join("m.mcap")).unwrap();
    }
}

/// A message of states, with positions alone, of joints named in any order.
fn state(seconds: i32, values: [f64; 2]) -> Vec<u8> {
    let mut bytes = vec![0, 1, 0, 0];
    let put = |bytes: &mut Vec<u8>, size: usize, value: &[u8]| {
        let content = (bytes.len() - 4).next_multiple_of(size);
        bytes.resize(4 + content, 0);
        bytes.extend_from_slice(value);
    };
    let word = |bytes: &mut Vec<u8>, value: i32| put(bytes, 4, &value.to_le_bytes());
    word(&mut bytes, seconds);
    word(&mut bytes, 500_000_000);
    word(&mut bytes, 1);
    bytes.push(0);
    word(&mut bytes, 2);
    for name in ["elbow", "shoulder"] {
        word(&mut bytes, name.len() as i32 + 1);
        bytes.extend(name.as_bytes());
        bytes.push(0);
    }
    word(&mut bytes, 2);
    values.iter().for_each(|value| put(&mut bytes, 8, &value.to_le_bytes()));
    word(&mut bytes, 0);
    word(&mut bytes, 0);
    bytes
}

fn recording(messages: &[(&str, u64, Vec<u8>)]) -> Vec<u8> {
    let options = mcap::WriteOptions::new().compression(None);
    let mut writer = options.create(std::io::Cursor::new(Vec::new())).unwrap();
    let none = Default::default();
    let schema = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", b"").unwrap();
    for (topic, time, data) in messages {
        let channel_id = writer.add_channel(schema, topic, "cdr", &none).unwrap();
        let header = mcap::records::MessageHeader { channel_id, sequence: 0, log_time: *time, publish_time: *time };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

#[test]
fn states_that_somebody_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let (robot, world) = (shipped("robots/planar_2r.urdf"), shipped("workspaces/shelf.toml"));
    let states = |last: [f64; 2]| {
        [("/joint_states", 7, state(10, [0.4, -0.9])), ("/rosout", 8, vec![1]), ("/joint_states", 9, state(12, last))]
    };
    let judged = |bytes: &[u8]| {
        std::fs::write(folder.path().join("m.mcap"), bytes).unwrap();
        run(folder.path(), &["verify", &robot, &world, "m.mcap", "--json", "--anywhere"])
    };
    let (code, json, errors) = judged(&recording(&states([0.5, -0.8])));
    assert_eq!(code, 0, "{errors}{json}");
    let found: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((&found["samples"], &found["duration"]), (&json!(2), &json!(2.0)));
    assert!(found["notes"].to_string().contains("topics that are not used: \\\"/rosout\\\""), "{found:#}");
    // Straight to the goal goes through the shelf, faster than the elbow can.
    assert_eq!(judged(&recording(&states([-0.35, 1.55]))).0, 3);

    let whole = recording(&states([0.5, -0.8]));
    for (bytes, part) in [
        (whole[..whole.len() / 2].to_vec(), "cure: it is damaged, cut off, or no recording"),
        (b"no recording".to_vec(), "cure: it is damaged, cut off, or no recording"),
        (
            recording(&[("/joint_states", 7, state(10, [0.4, -0.9])[..40].to_vec())]),
            "a message on /joint_states at 7 ns",
        ),
        (recording(&[("/rosout", 7, vec![1])]), "holds no joint values"),
    ] {
        let (code, _, errors) = judged(&bytes);
        assert_eq!(code, 1, "{errors}");
        assert!(errors.contains(part) && errors.contains("cure:"), "{part}: {errors}");
    }
}
