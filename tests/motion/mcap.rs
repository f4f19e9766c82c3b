//! Recordings, read back by the MCAP crate's reader and a decoder of CDR that shares no code with the writer. The
//! decoder computes the place of each value by the standard alone. `tests/python/read_mcap.py` reads the same files
//! with independent libraries.

use cplan::motion::{JointMotion, mcap};
use mcap_reader::read::{LinearReader, MessageStream, Summary};
use mcap_reader::records::Record;
use proptest::prelude::*;

/// The crate `mcap`, under another name than that of the function `mcap`.
use ::mcap as mcap_reader;

/// A reader that takes values off the front of a message.
pub struct Decoder<'a> {
    message: &'a [u8],
    at: usize,
}

impl<'a> Decoder<'a> {
    pub fn new(message: &'a [u8]) -> Self {
        assert_eq!(message[..4], [0, 1, 0, 0], "plain CDR, little endian");
        Self { message, at: 4 }
    }

    pub fn take<const N: usize>(&mut self) -> [u8; N] {
        while !(self.at - 4).is_multiple_of(N) {
            assert_eq!(self.message[self.at], 0, "filling");
            self.at += 1;
        }
        self.at += N;
        self.message[self.at - N..self.at].try_into().unwrap()
    }

    pub fn word(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    pub fn numbers(&mut self) -> Vec<f64> {
        (0..self.word()).map(|_| f64::from_le_bytes(self.take())).collect()
    }

    pub fn string(&mut self) -> String {
        let length = self.word() as usize;
        let bytes: Vec<u8> = (0..length).map(|_| self.take::<1>()[0]).collect();
        let (end, text) = bytes.split_last().expect("a zero at least");
        assert_eq!(*end, 0);
        String::from_utf8(text.to_vec()).unwrap()
    }

    fn strings(&mut self) -> Vec<String> {
        (0..self.word()).map(|_| self.string()).collect()
    }

    /// Reads a time in whole nanoseconds.
    pub fn time(&mut self) -> u64 {
        let (seconds, rest) = (self.word(), self.word());
        assert!(seconds <= i32::MAX as u32 && rest < 1_000_000_000);
        u64::from(seconds) * 1_000_000_000 + u64::from(rest)
    }

    pub fn end(self) {
        assert_eq!(self.at, self.message.len(), "nothing is left");
    }
}

#[derive(Debug, PartialEq)]
pub struct State {
    pub log: u64,
    pub stamp: u64,
    pub joints: Vec<String>,
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
}

#[derive(Debug, PartialEq)]
pub struct Motion {
    pub log: u64,
    pub joints: Vec<String>,
    pub since: Vec<u64>,
    /// Positions, velocities and accelerations of each point.
    pub points: Vec<[Vec<f64>; 3]>,
}

/// Reads everything in a file, and checks the structure that all files have.
pub fn read(file: &[u8]) -> (Vec<State>, Vec<Motion>) {
    let (mut states, mut motions) = (Vec::new(), Vec::new());
    for message in MessageStream::new(file).unwrap() {
        let message = message.unwrap();
        let channel = &message.channel;
        let schema = channel.schema.as_ref().unwrap();
        assert_eq!((channel.message_encoding.as_str(), schema.encoding.as_str()), ("cdr", "ros2msg"));
        assert_eq!(message.publish_time, message.log_time);
        let log = message.log_time;
        if !channel.topic.starts_with("/joint_") {
            // `recorded_scene` tests these topics, which display the motion.
            continue;
        }
        let mut from = Decoder::new(&message.data);
        let stamp = from.time();
        assert_eq!(from.string(), "", "no frame");
        let joints = from.strings();
        match (channel.topic.as_str(), schema.name.as_str()) {
            ("/joint_states", "sensor_msgs/msg/JointState") => {
                let (position, velocity) = (from.numbers(), from.numbers());
                assert!(from.numbers().is_empty(), "efforts are not known");
                states.push(State { log, stamp, joints, position, velocity });
            }
            ("/joint_trajectory", "trajectory_msgs/msg/JointTrajectory") => {
                assert_eq!(stamp, 0, "begin now");
                let (mut since, mut points) = (Vec::new(), Vec::new());
                for _ in 0..from.word() {
                    points.push([from.numbers(), from.numbers(), from.numbers()]);
                    assert!(from.numbers().is_empty());
                    since.push(from.time());
                }
                motions.push(Motion { log, joints, since, points });
            }
            other => panic!("{other:?}"),
        }
        from.end();
    }
    (states, motions)
}

/// Returns a trajectory with accelerations. `steps` are the times between samples, and `values` those of the samples.
fn trajectory(joints: &[String], steps: &[f64], values: &[[f64; 6]]) -> JointMotion {
    let time = steps.iter().scan(-steps[0], |t, step| {
        *t += step;
        Some(*t)
    });
    let rows = |of: usize| values.iter().map(|v| v[of..of + 2].to_vec()).collect();
    JointMotion {
        joints: joints.to_vec(),
        time: time.collect(),
        position: rows(0),
        velocity: rows(2),
        acceleration: Some(rows(4)),
    }
}

fn names() -> [String; 2] {
    ["shoulder, \"left\"".into(), "élbow".into()]
}

#[test]
fn the_file_has_its_header_and_schemas() {
    let motion = trajectory(&names(), &[0.0, 0.5], &[[0.0; 6]; 2]);
    let file = mcap(&[(&motion, 0.0)], None);
    let Some(Ok(Record::Header(header))) = LinearReader::new(&file).unwrap().next() else { panic!("no header") };
    assert_eq!(header.profile, "ros2");
    assert_eq!(header.library, format!("cplan {}", env!("CARGO_PKG_VERSION")));
    let summary = Summary::read(&file).unwrap().expect("a summary");
    let count = summary.stats.as_ref().expect("statistics");
    assert_eq!((count.message_count, count.message_start_time, count.message_end_time), (3, 0, 500_000_000));
    assert!(summary.chunk_indexes.iter().all(|chunk| chunk.compression.is_empty()));
    let mut topics: Vec<_> = summary.channels.values().map(|channel| channel.topic.as_str()).collect();
    topics.sort_unstable();
    assert_eq!(topics, ["/joint_states", "/joint_trajectory"]);
}

#[test]
fn several_motions_follow_each_other() {
    let there = trajectory(&names(), &[0.0, 0.25, 0.25], &[[0.0; 6], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [2.0; 6]]);
    let back = trajectory(&names(), &[0.0, 1.0], &[[2.0; 6], [0.0; 6]]);
    let (states, motions) = read(&mcap(&[(&there, 0.0), (&back, 2.5)], None));
    let logs: Vec<u64> = states.iter().map(|state| state.log).collect();
    assert_eq!(logs, [0, 250_000_000, 500_000_000, 2_500_000_000, 3_500_000_000]);
    assert!(states.iter().all(|state| state.stamp == state.log && state.joints == names()));
    let begins: Vec<_> = motions.iter().map(|motion| (motion.log, motion.since.clone())).collect();
    assert_eq!(begins, [(0, vec![0, 250_000_000, 500_000_000]), (2_500_000_000, vec![0, 1_000_000_000])]);
    assert_eq!(motions[0].points[1], [vec![1.0, 2.0], vec![3.0, 4.0], vec![5.0, 6.0]]);
}

#[test]
fn motions_without_a_pause_between_them_share_a_state() {
    let there = trajectory(&names(), &[0.0, 0.5], &[[0.0; 6], [2.0; 6]]);
    let cubic = JointMotion { acceleration: None, ..trajectory(&names(), &[0.0, 1.0], &[[2.0; 6], [0.0; 6]]) };
    let (states, motions) = read(&mcap(&[(&there, 0.0), (&cubic, 0.5)], None));
    let logs: Vec<u64> = states.iter().map(|state| state.log).collect();
    assert_eq!(logs, [0, 500_000_000, 1_500_000_000]);
    assert_eq!(motions[1].points[0], [vec![2.0; 2], vec![2.0; 2], vec![]]);
}

#[test]
fn a_file_of_many_chunks_is_read_back() {
    // A sample has some 250 bytes, and a chunk is a megabyte.
    let many = 20_000;
    let values: Vec<[f64; 6]> = (0..many).map(|k| [k as f64; 6]).collect();
    let motion = trajectory(&names(), &vec![1e-3; many], &values);
    let file = mcap(&[(&motion, 0.0)], None);
    assert!(Summary::read(&file).unwrap().expect("a summary").chunk_indexes.len() > 2);
    let (states, motions) = read(&file);
    assert_eq!((states.len(), motions.len(), motions[0].points.len()), (many, 1, many));
    assert!(states.windows(2).all(|pair| pair[0].log < pair[1].log));
    assert!(states.iter().enumerate().all(|(k, state)| state.position == [k as f64; 2]));
}

proptest! {
    #![proptest_config(cplan_cases::cases(64))]

    #[test]
    fn any_motion_is_read_back(
        rows in prop::collection::vec((1e-6..1e4, prop::array::uniform6(prop::num::f64::NORMAL | prop::num::f64::ZERO)), 1..20),
        joints in prop::array::uniform2("[^\0]{0,20}"),
    ) {
        let (steps, values): (Vec<f64>, Vec<[f64; 6]>) = rows.into_iter().unzip();
        let motion = trajectory(&joints, &steps, &values);
        let file = mcap(&[(&motion, 0.0)], None);
        prop_assert_eq!(&file, &mcap(&[(&motion, 0.0)], None));
        let (states, motions) = read(&file);
        prop_assert_eq!((states.len(), motions.len()), (values.len(), 1));
        for (k, state) in states.iter().enumerate() {
            prop_assert_eq!(&state.joints, &joints);
            prop_assert_eq!(&state.position, &motion.position[k]);
            prop_assert_eq!(&state.velocity, &motion.velocity[k]);
            prop_assert!((state.log as f64 * 1e-9 - motion.time[k]).abs() <= 0.6e-9);
            prop_assert_eq!([state.stamp, motions[0].since[k]], [state.log; 2]);
            let acceleration = motion.acceleration.as_ref().unwrap()[k].clone();
            let expected = [motion.position[k].clone(), motion.velocity[k].clone(), acceleration];
            prop_assert_eq!(&motions[0].points[k], &expected);
        }
        prop_assert!(states.windows(2).all(|pair| pair[0].log < pair[1].log));
        prop_assert_eq!((&motions[0].joints[..], motions[0].log), (&joints[..], 0));
    }
}
