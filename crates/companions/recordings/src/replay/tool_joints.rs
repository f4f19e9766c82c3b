//! Recorded motions of the tool's joints, compared with those that the steps state.
//!
//! The replay judges the strokes and turns that the steps state. If a file also records the values of the tool's
//! joints, these must agree. While the arm moves, the steps determine the value of each joint at each time. While the
//! arm rests, the tool may be at any height down to its lowest position there, and a payload may have any orientation
//! of its turn, since the replay judges all of them.

use super::overlap::{Overlaps, PartialStroke};
use cplan_handling::{
    Drives, Holding, RecordedJoints, RecordedStep, RecordedTurn, Recording, RobotJoints, Stroke, Task, ToolJoint,
    WristJoint,
};
use cplan_model::space::Configuration;
use cplan_motion::recorded::{turn_angle, turn_profile};
use cplan_motion::single;
use thiserror::Error;

/// Largest difference between a recorded and a stated value, radians or metres. It exceeds the difference between a
/// cubic interpolation of the samples and the certified blends.
const VALUE_TOLERANCE: f64 = 1e-5;

/// Number of compared places per piece of the motion.
const PLACES_PER_PIECE: u8 = 4;

/// The motion of the tool in a step, as it was judged.
#[derive(Debug, Clone, Copy)]
pub struct StepTool {
    /// Seconds from the beginning of the record to the beginning of the arm's motion, its end, and the next motion.
    pub(super) times: [f64; 3],
    /// The overlaps of the motion with strokes and turns.
    pub(super) overlaps: Overlaps,
    /// Depth to which the tool is lowered at the end of the motion, metres.
    pub(super) depth: Option<f64>,
    /// True if the tool stays lowered after the step.
    pub(super) stays_lowered: bool,
    /// Grip of the object that is carried during the motion.
    pub(super) carried: Option<Holding>,
    /// Grip of the object that is picked at the end of the motion.
    pub(super) picked: Option<Holding>,
    pub(super) turn: Option<RecordedTurn>,
}

/// A joint with another value than the steps of the file state.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("all_joints: at {time:.6} s, joint \"{joint}\" is at {is}, but according to the steps {}", range(*stated))]
pub struct MisplacedJoint {
    /// The joint's name in the URDF.
    pub joint: String,
    /// Seconds from the beginning of the recording.
    pub time: f64,
    /// The recorded value, radians or metres.
    pub is: f64,
    /// Least and greatest value that the steps allow.
    pub stated: [f64; 2],
}

fn range([least, greatest]: [f64; 2]) -> String {
    if least == greatest { format!("at {least}") } else { format!("from {least} to {greatest}") }
}

/// Returns the joints whose recorded values differ from those that the steps state, each with the first such time.
/// `recording` is the motion of the arm, and `tools` describes the recorded steps.
pub fn misplaced_joints(
    task: &Task,
    robot: &RobotJoints,
    recording: &Recording,
    (steps, tools): (&[RecordedStep], &[StepTool]),
    all: &RecordedJoints,
) -> Vec<MisplacedJoint> {
    let pieces = all.arm.pieces();
    let places = places(pieces.len());
    let times: Vec<f64> = places.iter().map(|&(k, share)| pieces[k].time(share)).collect();
    let planned = recording.resampled(&times).positions().to_vec();
    let guide = Guide::new(task, robot, recording, (steps, tools));
    let sampled = all.others.iter().map(|(name, values)| {
        let pieces = values.pieces();
        (name.as_str(), places.iter().map(|&(k, share)| pieces[k].at(share)[0]).collect())
    });
    let sampled: Vec<(&str, Vec<f64>)> = sampled.collect();
    let mut found: Vec<MisplacedJoint> = Vec::new();
    let mut carried = None;
    for (k, (time, &(piece, share))) in times.iter().zip(&places).enumerate() {
        let time = time - times[0];
        let end = [k == 0, k + 1 == places.len()];
        let value = |name: &str| sampled.iter().find(|(other, _)| *other == name).map(|(_, values)| values[k]);
        let here = pieces[piece].at(share);
        let mut compare = |joint: &str, is: f64, stated: [f64; 2]| {
            let is_off = is < stated[0] - VALUE_TOLERANCE || is > stated[1] + VALUE_TOLERANCE;
            if is_off && found.iter().all(|known| known.joint != joint) {
                found.push(MisplacedJoint { joint: joint.to_owned(), time, is, stated });
            }
        };
        for joint in 0..2 {
            compare(&task.arm.joints[joint].name, here[joint], [planned[k][joint]; 2]);
        }
        guide.compare_others(&value, here, &mut compare);
        if let Some(stroke) = &robot.stroke
            && let Some(is) = value(&stroke.joint.name)
        {
            compare(&stroke.joint.name, is, guide.stroke_range(stroke, time, end));
        }
        if let Some(wrist) = &robot.wrist
            && let Some(is) = value(&wrist.name)
            && let Some(stated) = guide.wrist_range(wrist, (time, end), (here, is), &mut carried)
        {
            compare(&wrist.name, is, stated);
        }
    }
    found
}

/// Returns the compared places of a motion, each as a piece and a fraction of it.
fn places(pieces: usize) -> Vec<(usize, f64)> {
    let shares = (0..PLACES_PER_PIECE).map(|k| f64::from(k) / f64::from(PLACES_PER_PIECE));
    let places = (0..pieces).flat_map(|piece| shares.clone().map(move |share| (piece, share)));
    places.chain([(pieces - 1, 1.0)]).collect()
}

#[derive(Clone, Copy)]
struct Carried {
    /// Index of the step that picked it.
    since: usize,
    /// The tool's angle at the pick, radians.
    reference: f64,
}

/// The values of the tool's joints according to the steps.
struct Guide<'a> {
    task: &'a Task,
    robot: &'a RobotJoints,
    steps: &'a [RecordedStep],
    tools: &'a [StepTool],
    /// Motion of the wrist along a line, for each step that has one.
    along: Vec<Option<Recording>>,
}

impl<'a> Guide<'a> {
    fn new(
        task: &'a Task,
        robot: &'a RobotJoints,
        recording: &Recording,
        (steps, tools): (&'a [RecordedStep], &'a [StepTool]),
    ) -> Self {
        let along = |step: &RecordedStep| {
            let motion = step.wrist_motion.as_ref()?;
            let times = recording.times()?.get(step.samples.clone())?;
            let begin = recording.times()?[0];
            let column = |of: usize| motion.iter().map(|row| Configuration::new(row[of], 0.0)).collect();
            Recording::new(column(0), Some(times.iter().map(|time| time - begin).collect()), Some(column(1))).ok()
        };
        Self { task, robot, steps, tools, along: steps.iter().map(along).collect() }
    }

    /// Compares the joints other than stroke and wrist: those that keep a value, or that follow other joints.
    fn compare_others(
        &self,
        value: &dyn Fn(&str) -> Option<f64>,
        planned: Configuration,
        compare: &mut impl FnMut(&str, f64, [f64; 2]),
    ) {
        let rest = self.robot.at_rest(planned.into());
        let stroke = self.robot.stroke.as_ref().map(|stroke| stroke.joint.name.as_str());
        let wrist = self.robot.wrist.as_ref().map(|wrist| wrist.name.as_str());
        let drives = Drives {
            stroke: stroke.and_then(value).unwrap_or(rest.stroke),
            wrist: wrist.and_then(value).unwrap_or(rest.wrist),
            ..rest
        };
        for (joint, stated) in self.robot.joints.iter().zip(self.robot.values(&drives)) {
            let is_tool = [stroke, wrist].contains(&Some(joint.name.as_str()));
            if let Some(is) = value(&joint.name).filter(|_| !is_tool) {
                compare(&joint.name, is, [stated; 2]);
            }
        }
    }

    /// Returns the index of the last step whose motion has begun. `None` before the first motion.
    fn step_at(&self, time: f64) -> Option<usize> {
        self.tools.partition_point(|tool| tool.times[0] <= time).checked_sub(1)
    }

    /// Returns bounds on the value of the stroke's joint at a time. `is_end` states whether this is the first, and
    /// whether it is the last place of the record.
    fn stroke_range(&self, stroke: &Stroke, time: f64, is_end: [bool; 2]) -> [f64; 2] {
        let rest = stroke.joint.rest;
        let lowered = |depth: Option<f64>| stroke.lowered(depth.unwrap_or(0.0));
        let down_to = |depth: Option<f64>| [rest.min(lowered(depth)), rest.max(lowered(depth))];
        let start = self.task.start_tool.lowered_by();
        if is_end[0] {
            return [lowered(start); 2];
        }
        let Some(step) = self.step_at(time) else { return down_to(start) };
        let StepTool { times: [begin, arrival, _], overlaps, depth, stays_lowered, .. } = self.tools[step];
        if is_end[1] {
            return [lowered(depth.filter(|_| stays_lowered)); 2];
        }
        if time > arrival {
            return down_to(depth);
        }
        let profile = |depth: f64| single(depth.abs(), &stroke.limits());
        let value = match (overlaps.raising, overlaps.lowering) {
            (Some(PartialStroke { depth, overlap }), _) if time < begin + overlap => {
                let profile = profile(depth);
                let whole = profile.last().map_or(0.0, |[end, ..]| *end);
                turn_angle(&profile, [stroke.lowered(depth), rest], time - (begin + overlap - whole))
            }
            (_, Some(PartialStroke { depth, overlap })) if time > arrival - overlap => {
                turn_angle(&profile(depth), [rest, stroke.lowered(depth)], time - (arrival - overlap))
            }
            _ => rest,
        };
        [value; 2]
    }

    /// Returns bounds on the value of the wrist's joint at a time, with the arm at `q` and a recorded value `is`.
    /// `None` without a payload: then any value is right, because the parts that the wrist turns count as discs.
    fn wrist_range(
        &self,
        wrist: &ToolJoint,
        (time, is_end): (f64, [bool; 2]),
        (q, is): (Configuration, f64),
        carried: &mut Option<Carried>,
    ) -> Option<[f64; 2]> {
        let stated = match is_end {
            [true, _] => self.task.start_tool.wrist,
            [_, true] => self.steps.last().and_then(|step| step.wrist).map(|turn| turn.to),
            _ => None,
        };
        if let Some(stated) = stated {
            return Some([stated; 2]);
        }
        let step = self.step_at(time)?;
        let tool = &self.tools[step];
        let is_moving = time <= tool.times[1];
        if let Some(Some(along)) = self.along.get(step).filter(|_| is_moving) {
            return Some([along.resampled(&[time]).positions()[0][0]; 2]);
        }
        let Some(holding) = tool.carried.or(tool.picked.filter(|_| !is_moving)) else {
            *carried = None;
            return None;
        };
        let link_2 = match holding {
            Holding::Level => WristJoint::link_2_angle(&self.task.arm, q.into()),
            Holding::Rigid => 0.0,
        };
        let here = Carried { since: step, reference: link_2 + wrist.sign * is };
        let Carried { since, reference } = *carried.get_or_insert(here);
        let ends = self.turned(since, step, time).map(|by| wrist.sign * (reference + by - link_2));
        Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
    }

    /// Returns bounds on the sum of all turns between the pick in step `since` and a time in `step`, radians.
    fn turned(&self, since: usize, step: usize, time: f64) -> [f64; 2] {
        let by = |turn: Option<RecordedTurn>| turn.map_or(0.0, |turn| turn.to - turn.from);
        let before: f64 = self.tools[since..step].iter().map(|tool| by(tool.turn)).sum();
        let StepTool { times: [begin, arrival, _], overlaps, turn, .. } = self.tools[step];
        if time > arrival {
            let after = before + by(turn);
            return [before.min(after), before.max(after)];
        }
        let during = |turn: RecordedTurn, since: f64| {
            let by = turn.to - turn.from;
            let profile = self.task.wrist.map(|wrist| turn_profile(&wrist, by.abs(), turn.seconds));
            profile.map_or(0.0, |profile| turn_angle(&profile, [0.0, by], since))
        };
        let mut sum = before;
        if let Some(turn) = overlaps.turn_before {
            let from = begin + turn.overlap.after_departure - turn.seconds;
            sum += during(turn, time - from) - by(Some(turn));
        }
        if let Some(turn) = overlaps.turn_at_end {
            sum += during(turn, time - (arrival - turn.overlap.before_arrival));
        }
        [sum; 2]
    }
}
