//! Joint values from topics of ROS 2 that were recorded in an MCAP file.

mod cdr;
mod file;
mod message;
mod topics;

use super::samples::{Names, Samples, Series};
use cplan_handling::Interpolation;
use cplan_robot::{Diagnostic, InputError, Source, quoted};
use message::{Kind, Message, Row};
use topics::Topic;

/// Reads a recording. It consists of states, or of consecutive motions between which the arm stands still. Reads the topic
/// `asked`; if it is `None`, [`topics::choose`] chooses one.
///
/// # Errors
/// Files that are not MCAP, no topic or several topics with the arm's joints, invalid messages, and motions that do not fit
/// together.
pub(super) fn read(source: &Source, bytes: &[u8], asked: Option<&str>, names: &Names) -> Result<Samples, InputError> {
    let topics = topics::all(bytes).map_err(|error| topics::unreadable(source, &error))?;
    let (topic, notes) = topics::choose(source, topics, asked, names.arm)?;
    let mut samples = match topic.kind {
        Some(Kind::Trajectory) => motions(source, topic, names)?,
        _ => states(source, topic, names)?,
    };
    samples.notes.extend(notes);
    Ok(samples)
}

/// Returns the messages with both of the arm's joints, each with its time and sorted by it, and the other messages.
///
/// The time of a message is its stamp. If any of the messages lacks a stamp, the times of recording are used instead.
fn messages_by_time(topic: &mut Topic, arm: [&str; 2]) -> (Vec<(i64, Message)>, Vec<Message>) {
    let (messages, others): (Vec<Message>, Vec<Message>) = std::mem::take(&mut topic.messages)
        .into_iter()
        .partition(|message| arm.iter().all(|joint| message.names(joint)));
    let has_stamps = messages.iter().all(|message| message.stamp != 0);
    let time = |message: &Message| if has_stamps { message.stamp } else { message.logged };
    let mut messages: Vec<(i64, Message)> = messages.into_iter().map(|message| (time(&message), message)).collect();
    messages.sort_by_key(|(time, _)| *time);
    (messages, others)
}

/// Converts states to samples, one per message.
fn states(source: &Source, mut topic: Topic, names: &Names) -> Result<Samples, Diagnostic> {
    let (messages, others) = messages_by_time(&mut topic, names.arm);
    let mut table = Table::new(source, &topic.name, &messages);
    let mut repeated = 0;
    for (time, message) in messages {
        let before = table.rows.len();
        table.add(message, time)?;
        if let [.., last, new] = &table.rows[..]
            && (last.nanoseconds, &last.values) == (new.nanoseconds, &new.values)
        {
            table.rows.truncate(before);
            repeated += 1;
        }
    }
    let mut samples = table.samples(names, &others)?;
    if repeated > 0 {
        samples.notes.push(format!("{repeated} messages repeat earlier ones and are ignored"));
    }
    Ok(Samples { what: format!("message on {}", topic.name).into(), ..samples })
}

/// Converts consecutive motions to samples. Each motion begins at the time of its message.
fn motions(source: &Source, mut topic: Topic, names: &Names) -> Result<Samples, Diagnostic> {
    let (messages, others) = messages_by_time(&mut topic, names.arm);
    let name = &topic.name;
    let mut table = Table::new(source, name, &messages);
    let (mut rests, mut count) = (Vec::new(), 0);
    for (begin, message) in messages {
        let from = table.rows.len();
        table.add(message, begin)?;
        let [end, first] = match table.rows.get(from.saturating_sub(1)..from + 1) {
            Some([end, first]) => [end, first],
            // This is the first motion, or it has no points.
            _ => {
                count += usize::from(table.rows.len() > from);
                continue;
            }
        };
        count += 1;
        if begin < end.nanoseconds {
            let what =
                format!("a motion on {name} begins at {begin} ns, but the previous one ends at {}", end.nanoseconds);
            let help = "record one motion after the other, or verify the recorded states instead: --topic NAME";
            return Err(source.diagnostic(what).help(help));
        }
        // Times of samples must differ, by a nanosecond at least, which is the unit of messages.
        let earliest = end.nanoseconds + 1;
        let differing = table.joints.iter().enumerate().find(|(k, _)| end.values[0][*k] != first.values[0][*k]);
        if let Some((_, joint)) = differing {
            if first.nanoseconds <= begin {
                let what = format!(
                    "joint \"{joint}\" has different values at the end of a motion and at the beginning of the next"
                );
                let help = "record all motions, or verify the recorded states instead: --topic NAME";
                return Err(source.diagnostic(what).help(help));
            }
            // The controller moves the arm from where it is to the first point.
            let still = |k: usize| end.values[k].iter().map(|_| 0.0).collect();
            let start = Row { nanoseconds: begin.max(earliest), values: [end.values[0].clone(), still(1), still(2)] };
            table.rows.insert(from, start);
        } else {
            let first = &mut table.rows[from];
            first.nanoseconds = first.nanoseconds.max(earliest);
        }
        rests.push(from - 1);
    }
    let mut samples = table.samples(names, &others)?;
    if count > 1 {
        samples.notes.push(format!("{count} motions in sequence; the arm stands still between them"));
    }
    Ok(Samples { what: format!("point on {name}").into(), joined: Some(Interpolation::Quintic), rests, ..samples })
}

/// Values of some joints, collected from messages.
struct Table<'a> {
    source: &'a Source,
    topic: &'a str,
    /// The joints that all messages have.
    joints: Vec<String>,
    /// The joints that only some messages have.
    others: Vec<String>,
    /// Values in the order of `joints`.
    rows: Vec<Row>,
    /// Values of the other joints, without their times.
    other_series: Vec<(String, Vec<f64>)>,
}

impl<'a> Table<'a> {
    /// Creates a table for the joints of these messages, without rows.
    fn new(source: &'a Source, topic: &'a str, messages: &[(i64, Message)]) -> Self {
        let (mut joints, mut others): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
        if let Some((_, first)) = messages.first() {
            joints = first.joints.to_vec();
        }
        let mut last = None;
        for (_, message) in messages {
            if last.replace(&message.joints).is_some_and(|last| *last == message.joints) {
                continue;
            }
            others.extend(joints.extract_if(.., |joint| !message.names(joint)));
            let is_new = |name: &&String| !joints.contains(name) && !others.contains(name);
            others.extend(message.joints.iter().filter(is_new).cloned().collect::<Vec<_>>());
        }
        Self { source, topic, joints, others, rows: Vec::new(), other_series: Vec::new() }
    }

    /// Adds the rows of a message with this time.
    ///
    /// # Errors
    /// Rows without one value for each joint.
    fn add(&mut self, message: Message, time: i64) -> Result<(), Diagnostic> {
        let places = |names: &[String]| -> Vec<usize> {
            names.iter().filter_map(|name| message.joints.iter().position(|joint| joint == name)).collect()
        };
        let kept = places(&self.joints);
        let width = message.joints.len();
        for row in message.rows {
            let nanoseconds = row.nanoseconds.saturating_add(time);
            if !row.values.iter().enumerate().all(|(k, values)| values.len() == width || k > 0 && values.is_empty()) {
                let what = format!(
                    "a sample on {} at {nanoseconds} ns has too few or too many values; it needs one for each joint",
                    self.topic
                );
                return Err(self
                    .source
                    .diagnostic(what)
                    .help("record a position of each joint, and velocities of all joints or of none"));
            }
            for name in &self.others {
                if let Some(place) = message.joints.iter().position(|joint| joint == name) {
                    add_other_value(&mut self.other_series, name, row.values[0][place]);
                }
            }
            let of_kept = |values: &Vec<f64>| kept.iter().filter_map(|place| values.get(*place).copied()).collect();
            self.rows.push(Row { nanoseconds, values: row.values.each_ref().map(of_kept) });
        }
        Ok(())
    }

    /// Returns the rows as one series per joint. Times are relative to the first row.
    ///
    /// # Errors
    /// Velocities or accelerations in only some of the rows.
    fn samples(mut self, names: &Names, others: &[Message]) -> Result<Samples, Diagnostic> {
        let rows = std::mem::take(&mut self.rows);
        let given = [1, 2].map(|k: usize| rows.first().is_some_and(|row| !row.values[k].is_empty()));
        if let Some(row) = rows.iter().find(|row| [1, 2].iter().any(|&k| row.values[k].is_empty() == given[k - 1])) {
            let what = format!(
                "only some samples on {} have velocities or accelerations; the one at {} ns differs from the first",
                self.topic, row.nanoseconds
            );
            return Err(self
                .source
                .diagnostic(what)
                .help("record velocities in all samples or in none, and accelerations likewise"));
        }
        for message in others {
            for row in &message.rows {
                let values = message.joints.iter().zip(&row.values[0]);
                values
                    .filter(|(name, _)| !self.joints.contains(name))
                    .for_each(|(name, value)| add_other_value(&mut self.other_series, name, *value));
            }
        }
        let mut notes = Vec::new();
        if !others.is_empty() {
            let all = others.len() + rows.len();
            let joints = quoted(names.arm);
            notes.push(format!(
                "{} of {all} messages on {} do not name both of {joints} and are ignored",
                others.len(),
                self.topic
            ));
        }
        let begin = rows.first().map_or(0, |row| row.nanoseconds);
        let column = |k: usize, joint: usize| rows.iter().map(|row| row.values[k][joint]).collect::<Vec<f64>>();
        // Broadcasters publish NaN for quantities that a joint does not measure.
        let measured = |k: usize, joint: usize| {
            given[k - 1].then(|| column(k, joint)).filter(|values| !values.iter().all(|value| value.is_nan()))
        };
        let series = |(joint, name): (usize, &String)| Series {
            name: name.clone(),
            position: column(0, joint),
            velocity: measured(1, joint),
            acceleration: measured(2, joint),
        };
        Ok(Samples {
            // Correctly rounded, so that the shortest decimal has at most nine digits after the point.
            time: Some(rows.iter().map(|row| (row.nanoseconds - begin) as f64 / 1e9).collect()),
            joints: self.joints.iter().enumerate().map(series).collect(),
            other_series: self
                .other_series
                .into_iter()
                .map(|(name, position)| Series { name, position, ..Series::default() })
                .collect(),
            notes,
            ..Samples::default()
        })
    }
}

/// Adds a value of one of the other joints.
fn add_other_value(all: &mut Vec<(String, Vec<f64>)>, name: &str, value: f64) {
    match all.iter_mut().find(|(known, _)| known == name) {
        Some((_, values)) => values.push(value),
        None => all.push((name.to_owned(), vec![value])),
    }
}
