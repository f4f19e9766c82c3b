//! Recordings of ROS 2 topics.
#![cfg(feature = "mcap")]

use super::*;
/// Checks that the same message in both formats is judged as the same motion.
#[test]
fn a_recording_is_judged_as_the_message_in_it() {
    for (robot, world) in [("planar_2r", "shelf"), ("scara", "scara_cell")] {
        let place = Place::new();
        let [robot, world] = shipped(robot, world);
        let files = [robot.to_str().unwrap(), world.to_str().unwrap()];
        place.run(&files, "--output m.yaml --output m.mcap --quiet").exits(0);
        let found = ["m.yaml", "m.mcap"].map(|file| {
            let mut found = judge(&robot, &world, &place.path(file), &Question::default()).unwrap();
            let notes = found.as_object_mut().unwrap().remove("notes").unwrap().to_string();
            (found, notes)
        });
        assert_eq!(found[0].0, found[1].0);
        assert_eq!(found[1].0["verdict"], "free", "{:#}", found[1].0);
        assert!(found[1].1.contains("/joint_states are not judged"), "{}", found[1].1);
    }
}

/// A writer of values in the encoding CDR.
struct Message(Vec<u8>);

impl Message {
    /// Returns a message whose header has this time stamp.
    fn stamped(seconds: i32, nanoseconds: i32) -> Self {
        Self(vec![0, 1, 0, 0]).word(seconds).word(nanoseconds).word(1).byte(0)
    }

    fn put(mut self, size: usize, value: &[u8]) -> Self {
        let content = (self.0.len() - 4).next_multiple_of(size);
        self.0.resize(4 + content, 0);
        self.0.extend_from_slice(value);
        self
    }

    fn byte(self, value: u8) -> Self {
        self.put(1, &[value])
    }

    fn word(self, value: i32) -> Self {
        self.put(4, &value.to_le_bytes())
    }

    fn names(self, names: &[&str]) -> Self {
        let name =
            |message: Self, name: &&str| name.bytes().fold(message.word(name.len() as i32 + 1), Self::byte).byte(0);
        names.iter().fold(self.word(names.len() as i32), name)
    }

    fn values(self, values: &[f64]) -> Self {
        values.iter().fold(self.word(values.len() as i32), |message, value| message.put(8, &value.to_le_bytes()))
    }
}

/// Returns a state with positions only.
fn state_of(seconds: i32, names: &[&str], values: &[f64]) -> Vec<u8> {
    Message::stamped(seconds, 500_000_000).names(names).values(values).word(0).word(0).0
}

/// Returns a state of the planar arm.
fn state(seconds: i32, values: [f64; 2]) -> Vec<u8> {
    state_of(seconds, &["elbow", "shoulder"], &values)
}

/// Returns a motion without a time stamp. Its points have their seconds from the start.
fn motion(names: &[&str], points: &[(i32, [f64; 2])]) -> Vec<u8> {
    let start = Message::stamped(0, 0).names(names).word(points.len() as i32);
    let point = |message: Message, (seconds, values): &(i32, [f64; 2])| {
        message.values(values).values(&[0.0; 2]).word(0).word(0).word(*seconds).word(0)
    };
    points.iter().fold(start, point).0
}

const STATES: &str = "sensor_msgs/msg/JointState";
const MOTIONS: &str = "trajectory_msgs/msg/JointTrajectory";

/// Returns a recording of messages: topic, log time and content, all of the same type.
fn recording(messages: &[(&str, u64, Vec<u8>)]) -> Vec<u8> {
    let typed: Vec<_> = messages.iter().map(|(topic, time, data)| (*topic, STATES, *time, data.clone())).collect();
    recording_of(&typed)
}

/// Returns a recording of messages: topic, type, log time and content.
fn recording_of(messages: &[(&str, &str, u64, Vec<u8>)]) -> Vec<u8> {
    let options = mcap::WriteOptions::new().compression(None);
    let mut writer = options.create(std::io::Cursor::new(Vec::new())).unwrap();
    let none = Default::default();
    for (topic, kind, time, data) in messages {
        let schema = writer.add_schema(kind, "ros2msg", b"").unwrap();
        let channel_id = writer.add_channel(schema, topic, "cdr", &none).unwrap();
        let header = mcap::records::MessageHeader { channel_id, sequence: 0, log_time: *time, publish_time: *time };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

#[test]
fn states_recorded_by_another_program_are_judged() {
    let states = |last: [f64; 2]| {
        [
            ("/joint_states", STATES, 7, state(10, [0.4, -0.9])),
            ("/rosout", "rcl_interfaces/msg/Log", 8, vec![1]),
            ("/joint_states", STATES, 9, state(12, last)),
        ]
    };
    let found = judge_recording(&recording_of(&states([0.5, -0.8])), None).unwrap();
    assert_eq!(found["verdict"], "free", "{found:#}");
    assert_eq!((&found["samples"], &found["duration"]), (&json!(2), &json!(2.0)));
    assert!(found["notes"].to_string().contains("unused topics: \\\"/rosout\\\""), "{found:#}");
    // The straight line to the goal leads through the shelf, faster than the elbow can move.
    assert_eq!(judge_recording(&recording_of(&states([-0.35, 1.55])), None).unwrap()["verdict"], "collision");

    let whole = recording_of(&states([0.5, -0.8]));
    for (bytes, part) in [
        (whole[..whole.len() / 2].to_vec(), "hint: it is damaged, truncated, or not a recording"),
        (b"no recording".to_vec(), "hint: it is damaged, truncated, or not a recording"),
        (
            recording(&[("/joint_states", 7, state(10, [0.4, -0.9])[..40].to_vec())]),
            "a message on /joint_states at 7 ns",
        ),
        (
            recording_of(&[("/rosout", "rcl_interfaces/msg/Log", 7, vec![1]), ("/camera", "", 7, vec![1])]),
            "holds no positions of \"shoulder\", \"elbow\"; it holds /camera (no type), /rosout (rcl_interfaces/msg/Log)",
        ),
    ] {
        let error = judge_recording(&bytes, None).unwrap_err().to_string();
        assert!(error.contains(part) && error.contains("hint:"), "{part}: {error}");
    }
}

/// Judges a recording of the planar arm, with any start and end.
fn judge_recording(bytes: &[u8], topic: Option<&str>) -> Result<Value, InputError> {
    judged(&shipped("planar_2r", "shelf"), "m.mcap", bytes, &Question { topic, ..Question::with_free_ends() })
}

/// Returns the error of a recording, and the hint.
fn message_of(bytes: &[u8], topic: Option<&str>) -> String {
    let error = judge_recording(bytes, topic).unwrap_err();
    let first = &error.diagnostics()[0];
    format!("{}; {}", first.message, first.help.as_ref().expect("a hint"))
}

/// Checks recordings that `write.py` (in the folder of the files) wrote with the format's Python package. They contain
/// the same motion as the table.
#[test]
fn compressed_chunks_of_a_topic_may_be_out_of_order() {
    let [robot, world] = shipped("planar_2r", "shelf");
    let row = |k: i32| {
        let [time, shoulder, elbow] = [k * 50, -900 + 10 * k, 400 + 10 * k].map(|n| f64::from(n) / 1000.0);
        format!("{time},{shoulder},{elbow}\n")
    };
    let table = "time,shoulder,elbow\n".to_owned() + &(0..40).map(row).collect::<String>();
    let place = Place::new().with("m.csv", table);
    let csv = place.path("m.csv");
    let judged = |file: &PathBuf| {
        let found = judge(&robot, &world, file, &Question::with_free_ends()).unwrap();
        assert_eq!((&found["verdict"], &found["samples"]), (&json!("free"), &json!(40)), "{found:#}");
        ["clearance", "duration", "nearest"].map(|key| found[key].to_string())
    };
    for file in ["zstd", "lz4"] {
        let file = root(&format!("tests/program/verify/recorded/{file}.mcap"));
        let [found, expected] = [&file, &csv].map(judged);
        assert_eq!((&found[1..], &found[0][..8]), (&expected[1..], &expected[0][..8]), "{}", file.display());
    }
}

#[test]
fn damaged_compressed_chunks_are_refused() {
    for file in ["zstd", "lz4"] {
        let mut bytes = std::fs::read(root(&format!("tests/program/verify/recorded/{file}.mcap"))).unwrap();
        for at in (200..bytes.len() - 200).step_by(97) {
            bytes[at] ^= 0x55;
            // Whatever byte changes, the program does not crash.
            if let Ok(found) = judge_recording(&bytes, None) {
                assert_ne!(found["verdict"], "undecided", "{file}, {at}: {found:#}");
            }
            bytes[at] ^= 0x55;
        }
    }
}

/// Checks a recording with several topics. The program does not choose one of them silently, and following its hint
/// works.
#[test]
fn several_topics_with_the_joints_of_the_arm_need_a_choice() {
    let bytes = recording(&[
        ("/real/joint_states", 7, state(10, [0.4, -0.9])),
        ("/sim/joint_states", 8, state(10, [0.4, -0.8])),
        ("/real/joint_states", 9, state(11, [0.41, -0.9])),
        ("/sim/joint_states", 10, state(12, [0.41, -0.8])),
        ("/gripper/joint_states", 10, state_of(12, &["finger"], &[0.1])),
    ]);
    let message = message_of(&bytes, None);
    assert!(
        message.contains("/real/joint_states (sensor_msgs/msg/JointState, joints \"elbow\", \"shoulder\")"),
        "{message}"
    );
    assert!(message.ends_with("--topic /real/joint_states") && !message.contains("/gripper"), "{message}");
    for (topic, duration) in [("/real/joint_states", 1.0), ("/sim/joint_states", 2.0)] {
        let found = judge_recording(&bytes, Some(topic)).unwrap();
        assert_eq!((&found["verdict"], &found["duration"]), (&json!("free"), &json!(duration)), "{found:#}");
        let other = if topic.starts_with("/real") { "/sim" } else { "/real" };
        assert!(found["notes"].to_string().contains(&format!("{other}/joint_states are not judged")), "{found:#}");
    }
    for (topic, part) in
        [("/joint_states", "has no topic /joint_states"), ("/gripper/joint_states", "has no positions of")]
    {
        let message = message_of(&bytes, Some(topic));
        assert!(
            message.contains(part)
                && message.contains("/gripper/joint_states (sensor_msgs/msg/JointState, joints \"finger\")"),
            "{message}"
        );
    }
}

/// Checks a recording in which several nodes publish on one topic. The arm's messages count; the others only appear in
/// notes.
#[test]
fn several_publishers_may_share_a_topic() {
    let bytes = recording(&[
        ("/joint_states", 7, state(10, [0.4, -0.9])),
        ("/joint_states", 8, state_of(10, &["lid"], &[0.1])),
        ("/joint_states", 9, state_of(11, &["shoulder", "lid", "elbow"], &[-0.9, 0.0, 0.41])),
        ("/joint_states", 9, state_of(11, &["shoulder", "lid", "elbow"], &[-0.9, 0.0, 0.41])),
        ("/joint_states", 11, state_of(12, &["elbow"], &[1.0])),
    ]);
    let found = judge_recording(&bytes, None).unwrap();
    assert_eq!(found["verdict"], "free", "{found:#}");
    assert_eq!((&found["samples"], &found["duration"]), (&json!(2), &json!(1.0)), "{found:#}");
    let notes = found["notes"].to_string();
    assert!(notes.contains("2 of 4 messages on /joint_states do not name both"), "{notes}");
    assert!(notes.contains("1 messages repeat") && notes.contains("joint \\\"lid\\\" is ignored"), "{notes}");

    // Positions of the two joints from separate messages are not combined.
    let halves = recording(&[
        ("/joint_states", 7, state_of(10, &["elbow"], &[0.4])),
        ("/joint_states", 8, state_of(10, &["shoulder"], &[-0.9])),
    ]);
    let message = message_of(&halves, None);
    assert!(message.contains("holds no positions of") && message.contains("both of the arm's joints"), "{message}");
}

/// Checks a recording of commands to a controller: motions in a namespace. The first point of a motion is not the arm's
/// position.
#[test]
fn motions_of_a_controller_in_a_namespace_are_judged() {
    let topic = "/arm_controller/joint_trajectory";
    let joints = ["elbow", "shoulder"];
    let bytes = recording_of(&[
        (topic, MOTIONS, 8_000_000_000, motion(&joints, &[(1, [0.42, -0.9]), (2, [0.43, -0.9])])),
        (topic, MOTIONS, 1_000_000_000, motion(&["shoulder", "elbow"], &[(0, [-0.9, 0.4]), (2, [-0.9, 0.41])])),
        ("/joint_states", STATES, 9, state(10, [0.4, -0.9])),
    ]);
    let found = judge_recording(&bytes, None).unwrap();
    assert_eq!(found["verdict"], "free", "{found:#}");
    // The samples: two points, the waiting position, the next beginning, two points.
    assert_eq!((&found["samples"], &found["duration"]), (&json!(5), &json!(9.0)), "{found:#}");
    assert!(found["notes"].to_string().contains("2 motions in sequence"), "{found:#}");

    let jumps = recording_of(&[
        (topic, MOTIONS, 1_000_000_000, motion(&joints, &[(0, [0.4, -0.9]), (2, [0.41, -0.9])])),
        (topic, MOTIONS, 8_000_000_000, motion(&joints, &[(0, [0.42, -0.9]), (2, [0.43, -0.9])])),
        ("/joint_states", STATES, 9, state(10, [0.4, -0.9])),
        ("/joint_states", STATES, 10, state(11, [0.43, -0.9])),
    ]);
    let message = message_of(&jumps, None);
    assert!(
        message.contains("has different values at the end of a motion") && message.contains("--topic"),
        "{message}"
    );
    assert_eq!(judge_recording(&jumps, Some("/joint_states")).unwrap()["verdict"], "free");
}

#[test]
fn only_recordings_have_topics() {
    let question = Question { topic: Some("/joint_states"), ..Question::default() };
    let table = "time,shoulder,elbow\n0,-0.9,0.4\n";
    let error = judged(&shipped("planar_2r", "shelf"), "m.csv", table, &question).unwrap_err().to_string();
    has(&error, &["has no topics", "leave --topic out"]);
}
