//! The program's files, read by readers that share no code with the writers.

use super::controller::Message;
use serde_json::Value;

/// Reads the message of a YAML file. A YAML library reads the names. Points are read line by line, which is faster for
/// long files.
pub fn yaml(text: &str) -> Message {
    let (head, body) = text.split_once("\npoints:\n").expect("points");
    let head: Value = serde_saphyr::from_str(head).expect("YAML");
    let joints = serde_json::from_value(head["joint_names"].clone()).expect("names");
    let mut message = Message { joints, ..Message::default() };
    for line in body.lines() {
        let (key, value) = line[2..].split_once(": ").expect("a key");
        let numbers = || serde_json::from_str::<Vec<f64>>(value).expect("numbers");
        match key {
            "positions" => message.points.push([numbers(), Vec::new(), Vec::new()]),
            "velocities" => message.points.last_mut().expect("a point")[1] = numbers(),
            "accelerations" => message.points.last_mut().expect("a point")[2] = numbers(),
            "time_from_start" => {
                let (seconds, rest) =
                    value.strip_prefix("{sec: ").and_then(|rest| rest.split_once(", nanosec: ")).expect("a time");
                let part = |text: &str| text.trim_end_matches('}').parse::<u64>().expect("a whole number");
                message.since.push(part(seconds) * 1_000_000_000 + part(rest));
            }
            other => panic!("{other}"),
        }
    }
    assert_eq!(message.since.len(), message.points.len());
    message
}

/// Converts a table to a message with the joints of its columns, as a user would.
pub fn csv(text: &str) -> Message {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let joints: Vec<String> =
        header[1..].iter().take_while(|name| !name.ends_with("_velocity")).map(|name| name.to_string()).collect();
    let column = |name: String| header.iter().position(|column| *column == name);
    let columns = ["", "_velocity", "_acceleration"]
        .map(|suffix| joints.iter().filter_map(|joint| column(format!("{joint}{suffix}"))).collect::<Vec<_>>());
    let mut message = Message { joints, ..Message::default() };
    for line in lines {
        let numbers: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        message.since.push((numbers[0] * 1e9).round() as u64);
        message.points.push(columns.each_ref().map(|of| of.iter().map(|&c| numbers[c]).collect()));
    }
    message
}

/// Returns the messages on `/joint_trajectory` of a recording. Each comes with the time at which it begins, in
/// nanoseconds.
#[cfg(feature = "mcap")]
pub fn mcap(file: &[u8]) -> Vec<(u64, Message)> {
    let (_, motions) = crate::mcap::read(file);
    motions.into_iter().map(|m| (m.log, Message { joints: m.joints, since: m.since, points: m.points })).collect()
}

/// Returns the states of a recording: the time in nanoseconds, the joints' names and their positions.
#[cfg(feature = "mcap")]
pub fn states(file: &[u8]) -> Vec<(u64, Vec<String>, Vec<f64>)> {
    crate::mcap::read(file).0.into_iter().map(|state| (state.stamp, state.joints, state.position)).collect()
}
