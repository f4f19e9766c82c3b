//! Joint values as recorded topics of ROS 2, in an MCAP file.

use super::cdr::Cdr;
use super::{Samples, Series};
use crate::input::error::{Diagnostic, InputError, quoted};
use crate::input::source::Source;
use crate::space::Interpolation;
use std::collections::BTreeSet;

/// Topics and their types.
const TRAJECTORIES: (&str, &str) = ("/joint_trajectory", "trajectory_msgs/msg/JointTrajectory");
const STATES: (&str, &str) = ("/joint_states", "sensor_msgs/msg/JointState");

/// A sample: when, and positions, velocities and accelerations of all joints, the latter two perhaps empty.
struct Row {
    nanoseconds: i64,
    values: [Vec<f64>; 3],
}

/// A message: the joints' names, and its samples.
struct Message {
    joints: Vec<String>,
    rows: Vec<Row>,
}

/// Types that show a motion and do not say it, as cplan's own recordings have them.
const SHOWN: [&str; 3] =
    ["tf2_msgs/msg/TFMessage", "visualization_msgs/msg/MarkerArray", "sensor_msgs/msg/PointCloud2"];

/// Reads a recording: the motions on `/joint_trajectory`, one after the other, between which the arm stands still; without
/// any, what `/joint_states` say.
///
/// # Errors
/// What is no MCAP file, compressed ones, messages that are none, and motions that do not fit together.
pub(super) fn read(source: &Source, bytes: &[u8]) -> Result<Samples, InputError> {
    let broken = |error: ::mcap::McapError| {
        let help = match &error {
            ::mcap::McapError::UnsupportedCompression(_) => {
                "record it uncompressed, as cplan writes it (mcap convert with compression none)"
            }
            _ => "it is damaged, cut off, or no recording: record it anew",
        };
        source.diagnostic(format!("cannot be read as MCAP: {error}")).help(help)
    };
    let (mut trajectories, mut states, mut unknown) = (Vec::new(), Vec::new(), BTreeSet::new());
    for message in ::mcap::MessageStream::new(bytes).map_err(broken)? {
        let message = message.map_err(broken)?;
        let (topic, kind) =
            (&message.channel.topic, message.channel.schema.as_ref().map(|schema| schema.name.as_str()));
        let wrong = || {
            let message =
                format!("a message on {topic} at {} ns is no {} in CDR", message.log_time, kind.unwrap_or("type"));
            source.diagnostic(message).help("the recording is damaged, or of another type")
        };
        let begin = i64::try_from(message.log_time).map_err(|_| wrong())?;
        match (topic.as_str(), kind) {
            (name, Some(kind)) if (name, kind) == TRAJECTORIES => {
                trajectories.push((begin, trajectory(&message.data).ok_or_else(wrong)?));
            }
            (name, Some(kind)) if (name, kind) == STATES => {
                states.push((begin, state(&message.data, begin).ok_or_else(wrong)?));
            }
            (_, Some(kind)) if SHOWN.contains(&kind) => (),
            _ => drop(unknown.insert(topic.clone())),
        }
    }
    let mut samples = if trajectories.is_empty() {
        let all = states.into_iter().map(|(_, state)| state).collect();
        Samples { what: "message on /joint_states", ..joined(source, all, STATES.0)? }
    } else {
        let mut samples = whole(source, trajectories)?;
        if !states.is_empty() {
            samples.notes.push("/joint_states are not judged: /joint_trajectory is what a controller plays".into());
        }
        samples
    };
    if !unknown.is_empty() {
        samples.notes.push(format!("topics that are not used: {}", quoted(unknown)));
    }
    Ok(samples)
}

fn trajectory(bytes: &[u8]) -> Option<Message> {
    let mut cdr = Cdr::new(bytes)?;
    cdr.header()?;
    let joints = cdr.strings()?;
    let rows = cdr.sequence(24, |cdr| {
        let values = [cdr.f64s()?, cdr.f64s()?, cdr.f64s()?];
        cdr.f64s()?;
        Some(Row { nanoseconds: cdr.nanoseconds()?, values })
    })?;
    Some(Message { joints, rows })
}

/// A state, at the time of its stamp, or when it was recorded if it has none.
fn state(bytes: &[u8], recorded: i64) -> Option<Message> {
    let mut cdr = Cdr::new(bytes)?;
    let stamp = cdr.header()?;
    let joints = cdr.strings()?;
    let values = [cdr.f64s()?, cdr.f64s()?, Vec::new()];
    Some(Message { joints, rows: vec![Row { nanoseconds: if stamp == 0 { recorded } else { stamp }, values }] })
}

/// Motions that follow each other, each beginning when it was recorded.
fn whole(source: &Source, trajectories: Vec<(i64, Message)>) -> Result<Samples, Diagnostic> {
    let mut rests = Vec::new();
    let mut all: Vec<Message> = Vec::new();
    let (mut count, mut last): (usize, Option<i64>) = (0, None);
    for (begin, mut message) in trajectories {
        for row in &mut message.rows {
            row.nanoseconds = row.nanoseconds.saturating_add(begin);
        }
        if let (Some(end), Some(first)) = (last, message.rows.first_mut()) {
            if first.nanoseconds < end {
                let what = format!("a motion on {} begins at {} ns, before the last one ends", TRAJECTORIES.0, begin);
                return Err(source.diagnostic(what).help("record one motion after the other"));
            }
            // Samples need distinct times: a nanosecond is the least that messages tell apart.
            first.nanoseconds = first.nanoseconds.max(end + 1);
            rests.push(count - 1);
        }
        last = message.rows.last().map(|row| row.nanoseconds).or(last);
        count += message.rows.len();
        all.push(message);
    }
    let mut samples = joined(source, all, TRAJECTORIES.0)?;
    for &rest in &rests {
        for joint in &samples.joints {
            if joint.position[rest] != joint.position[rest + 1] {
                let what = format!(
                    "joint \"{}\" stands elsewhere when a motion begins than where the last one ended",
                    joint.name
                );
                return Err(source.diagnostic(what).help("record all motions"));
            }
        }
    }
    if !rests.is_empty() {
        samples
            .notes
            .push(format!("{} motions, one after the other; between them the arm stands still", rests.len() + 1));
    }
    Ok(Samples { what: "point on /joint_trajectory", joined: Some(Interpolation::Quintic), rests, ..samples })
}

/// All rows as one series a joint. The clock begins with the first.
fn joined(source: &Source, messages: Vec<Message>, topic: &str) -> Result<Samples, Diagnostic> {
    let Some(joints) = messages.first().map(|message| message.joints.clone()) else {
        let help = format!("record {} or {}", TRAJECTORIES.0, STATES.0);
        return Err(source.diagnostic("holds no joint values").help(help));
    };
    if let Some(other) = messages.iter().find(|message| message.joints != joints) {
        let what =
            format!("messages on {topic} name different joints: {} and {}", quoted(&joints), quoted(&other.joints));
        return Err(source.diagnostic(what).help("record one source of joint values"));
    }
    let rows: Vec<Row> = messages.into_iter().flat_map(|message| message.rows).collect();
    let given = [1, 2].map(|k: usize| rows.first().is_some_and(|row| !row.values[k].is_empty()));
    let expected = |k: usize| if k == 0 || given[k - 1] { joints.len() } else { 0 };
    if let Some(row) = rows.iter().find(|row| (0..3).any(|k| row.values[k].len() != expected(k))) {
        let what = format!("a sample on {topic} at {} ns has not one value for each joint and kind", row.nanoseconds);
        return Err(source
            .diagnostic(what)
            .help("give all samples positions, and all or none velocities and accelerations"));
    }
    let begin = rows.first().map_or(0, |row| row.nanoseconds);
    let column = |k: usize, joint: usize| rows.iter().map(|row| row.values[k][joint]).collect::<Vec<f64>>();
    let series = |(joint, name): (usize, &String)| Series {
        name: name.clone(),
        position: column(0, joint),
        velocity: given[0].then(|| column(1, joint)),
        acceleration: given[1].then(|| column(2, joint)),
    };
    Ok(Samples {
        // Correctly rounded, so that as decimals they have no more than nine digits behind the point.
        time: Some(rows.iter().map(|row| (row.nanoseconds - begin) as f64 / 1e9).collect()),
        joints: joints.iter().enumerate().map(series).collect(),
        ..Samples::default()
    })
}
