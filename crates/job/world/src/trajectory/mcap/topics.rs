//! The topics of a recording, and the choice of the topic to read.

use super::file::each_message;
use super::message::{Kind, Message};
use cplan_robot::{Diagnostic, Source, quoted};
use mcap::{McapError, McapResult};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Types of messages that display a motion but state no joint values. Recordings that cplan writes have topics of these types.
const DISPLAY_TYPES: [&str; 3] =
    ["tf2_msgs/msg/TFMessage", "visualization_msgs/msg/MarkerArray", "sensor_msgs/msg/PointCloud2"];

/// The messages of one type on one topic.
#[derive(Default)]
pub(super) struct Topic {
    pub name: String,
    /// Name of the message type; empty if the file does not state it.
    schema: String,
    pub kind: Option<Kind>,
    /// Messages of a known kind that have positions, in the order of the file.
    pub messages: Vec<Message>,
    /// Time of recording, in nanoseconds, of the first message that does not fit the topic's type. `None` if all messages fit.
    broken: Option<u64>,
}

impl Topic {
    /// Returns true if a message has positions of both of the arm's joints.
    fn names_arm_joints(&self, arm: [&str; 2]) -> bool {
        self.messages.iter().any(|message| arm.iter().all(|joint| message.names(joint)))
    }

    /// Describes the topic by name, type and joints, for lists in messages.
    fn describe(&self) -> String {
        let schema = if self.schema.is_empty() { "no type" } else { &self.schema };
        let mut joints: Vec<&String> = Vec::new();
        for name in self.messages.iter().flat_map(|message| message.joints.iter()) {
            if !joints.contains(&name) {
                joints.push(name);
            }
        }
        let joints = if joints.is_empty() { String::new() } else { format!(", joints {}", quoted(joints)) };
        format!("{} ({schema}{joints})", self.name)
    }
}

/// Returns all topics of a file, by name and type.
///
/// # Errors
/// Files that are damaged or not MCAP.
pub(super) fn all(bytes: &[u8]) -> McapResult<Vec<Topic>> {
    let mut topics: BTreeMap<(String, String), Topic> = BTreeMap::new();
    each_message(bytes, |channel, logged, content| {
        let schema = channel.schema.as_ref().map_or(String::new(), |schema| schema.name.clone());
        let topic = topics.entry((channel.topic.clone(), schema.clone())).or_insert_with(|| Topic {
            name: channel.topic.clone(),
            kind: Kind::of(&schema),
            schema,
            ..Topic::default()
        });
        let Some(kind) = topic.kind else { return };
        match i64::try_from(logged).ok().and_then(|logged| Message::read(kind, content, logged)) {
            None => _ = topic.broken.get_or_insert(logged),
            Some(message) if message.rows.iter().all(|row| row.values[0].is_empty()) => {}
            Some(mut message) => {
                // Consecutive messages mostly have the same joints, whose names are stored only once.
                if let Some(last) = topic.messages.last().filter(|last| last.joints == message.joints) {
                    message.joints = Rc::clone(&last.joints);
                }
                topic.messages.push(message);
            }
        }
    })?;
    Ok(topics.into_values().collect())
}

/// Chooses the topic to read, and returns notes about the others. A requested topic takes precedence, then the only motion topic
/// with both of the arm's joints, then the only such state topic.
///
/// # Errors
/// No topic qualifies, or several do, or a message of the topic is damaged. The error lists all topics with their types.
pub(super) fn choose(
    source: &Source,
    mut topics: Vec<Topic>,
    asked: Option<&str>,
    arm: [&str; 2],
) -> Result<(Topic, Vec<String>), Diagnostic> {
    let of_name = |topic: &Topic| asked.is_none_or(|asked| topic.name == asked);
    let of_kind = |kind: Kind| -> Vec<usize> {
        let is_candidate = |topic: &Topic| topic.kind == Some(kind) && of_name(topic) && topic.names_arm_joints(arm);
        (0..topics.len()).filter(|k| is_candidate(&topics[*k])).collect()
    };
    let candidates = [Kind::Trajectory, Kind::State].map(of_kind).into_iter().find(|found| !found.is_empty());
    let list = |which: &[usize]| which.iter().map(|k| topics[*k].describe()).collect::<Vec<_>>().join(", ");
    let chosen = match candidates.as_deref() {
        Some([only]) => *only,
        Some(several) => {
            let message = format!("holds the arm's joints on several topics: {}", list(several));
            let help = format!("choose the topic to judge: --topic {}", topics[several[0]].name);
            return Err(source.diagnostic(message).help(help));
        }
        None => {
            let is_broken = |topic: &&Topic| of_name(topic) && topic.broken.is_some();
            if let Some(topic) = topics.iter().find(is_broken) {
                return Err(broken(source, topic));
            }
            let joints = quoted(arm);
            let message = match asked {
                Some(asked) if !topics.iter().any(of_name) => format!("has no topic {asked}"),
                Some(asked) => format!("has no positions of {joints} on {asked}"),
                None => format!("holds no positions of {joints}"),
            };
            let there = if topics.is_empty() { "nothing".into() } else { list(&Vec::from_iter(0..topics.len())) };
            let help = "record a topic of type sensor_msgs/msg/JointState or trajectory_msgs/msg/JointTrajectory with both of \
                        the arm's joints in each message";
            return Err(source.diagnostic(format!("{message}; it holds {there}")).help(help));
        }
    };
    let topic = topics.swap_remove(chosen);
    if topic.broken.is_some() {
        return Err(broken(source, &topic));
    }
    let (others, unused): (Vec<Topic>, Vec<Topic>) = topics.into_iter().partition(|other| other.kind.is_some());
    let mut notes: Vec<String> = others.iter().map(|other| not_judged(other, &topic)).collect();
    let mut unused: Vec<String> =
        unused.into_iter().filter(|t| !DISPLAY_TYPES.contains(&t.schema.as_str())).map(|t| t.name).collect();
    unused.dedup();
    if !unused.is_empty() {
        notes.push(format!("unused topics: {}", quoted(unused)));
    }
    Ok((topic, notes))
}

/// Returns the note about a topic with joint values that is not read.
fn not_judged(other: &Topic, judged: &Topic) -> String {
    let why = match (judged.kind, other.kind) {
        (Some(Kind::Trajectory), Some(Kind::State)) => "is the one that a controller executes",
        _ => "is judged",
    };
    let name = other.name.rsplit('/').next().unwrap_or_default();
    // "states" is a plural.
    let verb = if name.ends_with('s') { "are" } else { "is" };
    format!("{} {verb} not judged: {} {why}", other.name, judged.name)
}

fn broken(source: &Source, topic: &Topic) -> Diagnostic {
    let message = format!(
        "a message on {} at {} ns is not a {} in CDR",
        topic.name,
        topic.broken.unwrap_or_default(),
        topic.schema
    );
    source.diagnostic(message).help("the recording is damaged, or of another type")
}

/// Returns the diagnostic about a file that is not a recording.
pub(super) fn unreadable(source: &Source, error: &McapError) -> Diagnostic {
    let help = match error {
        McapError::UnsupportedCompression(_) => {
            "record it uncompressed, or with zstd or lz4 (mcap compress -o NEW.mcap OLD.mcap --compression zstd)"
        }
        _ => "it is damaged, truncated, or not a recording: record it again, or repair it (mcap recover)",
    };
    source.diagnostic(format!("cannot be read as MCAP: {error}")).help(help)
}
