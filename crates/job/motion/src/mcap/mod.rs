//! Trajectories as recordings of ROS 2 topics, in MCAP files.

mod cdr;
mod messages;
mod scene;

pub use scene::{Body, Solid, Stage};

use super::JointMotion;
use super::clock::nanoseconds;
use ::mcap::records::MessageHeader;
use ::mcap::{McapResult, WriteOptions, Writer};
use messages::{JOINT_STATE, JOINT_TRAJECTORY, MARKERS, POINTS, TRANSFORMS, Type};
use std::collections::BTreeMap;
use std::io::Cursor;

/// Writes motions as an MCAP file (version 0, profile `ros2`), as if they were recorded from a robot. The topic `/joint_states`
/// has a `sensor_msgs/msg/JointState` per sample. The topic `/joint_trajectory` has a `trajectory_msgs/msg/JointTrajectory` per
/// motion, at its beginning. The file includes the definitions of all messages. Chunks are not compressed.
///
/// With a `stage`, the file also has data for display:
/// - `/tf` has the poses of bodies whenever they move (`tf2_msgs/msg/TFMessage`, relative to the frame `world`, that of the
///   robot's root).
/// - `/scene` has their surfaces, once (`visualization_msgs/msg/MarkerArray`, for RViz and Foxglove).
/// - Topics below `/outlines`, one per body, have points along their rims (`sensor_msgs/msg/PointCloud2`, for Rerun).
///
/// Each motion comes with its start time, in seconds from the beginning of the recording. Motions must be in order. If a motion
/// begins when the previous one ends, there is only one state for that moment. Times of the log, stamps of states and
/// `time_from_start` agree to the nanosecond, and values are the motion's own `f64`. The same motions give the same bytes.
///
/// Time and size are linear in the number of samples: some 250 bytes per sample, and as many again for the poses of an arm.
pub fn mcap(motions: &[(&JointMotion, f64)], stage: Option<&Stage>) -> Vec<u8> {
    write(motions, stage).expect("channels with a schema each, and a buffer that takes all")
}

fn write(motions: &[(&JointMotion, f64)], stage: Option<&Stage>) -> McapResult<Vec<u8>> {
    let options = WriteOptions::new()
        .profile("ros2")
        .library(concat!("cplan ", env!("CARGO_PKG_VERSION")))
        // The crate's default depends on features that other crates may enable.
        .compression(None);
    let mut file = Recording { writer: options.create(Cursor::new(Vec::new()))? };
    let states = file.channel("/joint_states", &JOINT_STATE)?;
    let trajectories = file.channel("/joint_trajectory", &JOINT_TRAJECTORY)?;
    if let Some(stage) = stage {
        file.show(stage)?;
    }
    let mut last = None;
    for &(motion, begin) in motions {
        let begin = nanoseconds(begin);
        file.message(trajectories, begin, &messages::joint_trajectory(motion))?;
        for (k, &time) in motion.time.iter().enumerate() {
            let time = begin.saturating_add(nanoseconds(time));
            if last.replace(time) == Some(time) {
                continue;
            }
            let (position, velocity) = (&motion.position[k], &motion.velocity[k]);
            file.message(states, time, &messages::joint_state(&motion.joints, time, position, velocity))?;
        }
    }
    file.writer.finish()?;
    Ok(file.writer.into_inner().into_inner())
}

/// A recording that is being written to memory.
struct Recording {
    writer: Writer<Cursor<Vec<u8>>>,
}

impl Recording {
    fn channel(&mut self, topic: &str, kind: &Type) -> McapResult<u16> {
        let schema = self.writer.add_schema(kind.name, "ros2msg", kind.definition().as_bytes())?;
        // The profile requires this key. An empty value means the defaults of the player.
        let metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), String::new())]);
        self.writer.add_channel(schema, topic, "cdr", &metadata)
    }

    /// Writes the data for display.
    fn show(&mut self, stage: &Stage) -> McapResult<()> {
        let scene = self.channel("/scene", &MARKERS)?;
        self.message(scene, 0, &messages::markers(stage))?;
        for (number, body) in stage.bodies.iter().enumerate().filter(|(_, body)| !body.solids.is_empty()) {
            let outline = self.channel(&format!("/outlines/body_{number}"), &POINTS)?;
            self.message(outline, 0, &messages::points(stage, body))?;
        }
        let frames = self.channel("/tf", &TRANSFORMS)?;
        for moved in stage.moves().chunk_by(|a, b| a.0 == b.0) {
            let named: Vec<_> = moved.iter().map(|(_, body, at)| (stage.bodies[*body].name.as_str(), *at)).collect();
            self.message(frames, moved[0].0, &messages::transforms(moved[0].0, &named))?;
        }
        Ok(())
    }

    /// Adds a message with equal times of sending and receipt.
    fn message(&mut self, channel_id: u16, time: u64, data: &[u8]) -> McapResult<()> {
        let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, data)
    }
}
