//! Motions of all joints of the robot during a task, for messages that name them.
//!
//! While the arm moves, the tool is raised, and the wrist does not turn the payload, except where a stroke or a turn overlaps
//! with the motion. While the arm stands still, the wrist turns, and the tool is lowered and raised. If the world names the
//! wrist's joint, this joint compensates the rotation of link 2, so that level payloads keep their orientation. Without a
//! payload, it returns towards its rest position during the motion, as far as its limits allow, or turns to the value that the
//! step states. Along a line, it sets the tool's angle.

use cplan_handling::{Derivative, Driver, Drives, Piece, RobotJoint, RobotJoints, Task, ToolJoint, Wrist};
use cplan_legs::{Event, Leg, Sequence, ToolStroke, WristMotion, wrist_state};
use cplan_model::space::JointRange;
use cplan_motion::recorded::turn_profile;
use cplan_motion::{AccelerationJump, JointMotion, nanoseconds, phase_at, seconds, single, whole_nanoseconds};
use thiserror::Error;

/// The reason why messages cannot name all joints as requested.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MessageError {
    /// Accelerations that jump, which would mislead readers.
    #[error(transparent)]
    Jump(#[from] AccelerationJump),
    /// A joint of the tool that moves. Its accelerations are unknown.
    #[error(
        "accelerations cannot be written: joint \"{joint}\" of the tool moves at {time:.6} s, and its accelerations are not computed; write only the two planned joints (--joints planned), or leave out --accelerations"
    )]
    Tool {
        /// The joint's name in the URDF.
        joint: String,
        /// Time at which the joint first moves, in seconds from the beginning.
        time: f64,
    },
    /// A wrist that cannot turn fast enough.
    #[error(
        "joint \"{joint}\" cannot keep the payload level: at {time:.6} s it would {what}; widen its range, give the step a \
         lower speed, or write only the two planned joints (--joints planned)"
    )]
    Wrist {
        /// The joint's name in the URDF.
        joint: String,
        /// Time of the violation, in seconds from the beginning.
        time: f64,
        /// Description of the violation.
        what: String,
    },
}

/// The motion of all joints that ROS messages name, of the whole task and step by step.
#[derive(Debug, Clone, PartialEq)]
pub struct Messages {
    /// The motion of the whole task, including the times at which the arm stands still.
    pub whole: JointMotion,
    /// For each step, the time in seconds at which it begins, and its motion until all joints are at rest. If the arm departs
    /// while the tool is still being raised or turned for the previous step, the motion begins with this stroke or turn.
    pub steps: Vec<(f64, JointMotion)>,
}

/// Excess over a limit, as a fraction of it, that is due to rounding.
const ROUNDING: f64 = 1e-6;

impl Messages {
    /// Creates the messages for the steps of a sequence. They have accelerations of the arm, but none of the tool.
    pub fn new(robot: &RobotJoints, task: &Task, legs: &[Leg], sequence: &Sequence) -> Result<Self, MessageError> {
        let rest = robot.wrist.as_ref().map_or(0.0, |joint| joint.rest);
        let wrist = task.start_tool.wrist.unwrap_or(rest);
        let mut tool = Tool { robot, task, wrist, turned: 0.0, strokes: Vec::new(), turns: Vec::new() };
        let mut rows = Rows::default();
        rows.0.extend(legs.first().and_then(|leg| tool.first_row(leg, sequence)));
        let mut begins = Vec::new();
        for (index, leg) in legs.iter().enumerate() {
            let times = sequence.times(index).map(nanoseconds);
            let before = tool.strokes.len();
            tool.raise_first(leg, times[0]);
            let own = tool.strokes.get(before).map(|raising| raising.begin);
            let raising = tool.strokes.last().filter(|_| leg.overlap.raising > 0.0);
            let turning = tool.turns.last().filter(|_| leg.overlap.turn_after_departure > 0.0);
            begins.push(own.or(raising.or(turning).map(|before| before.begin)).unwrap_or(times[0]));
            tool.rows(leg, times).0.iter().for_each(|row| rows.push(*row));
        }
        rows.add_changes(tool.strokes.iter().chain(&tool.turns));
        rows.add_strokes(&tool.strokes);
        rows.add_turns(&tool.turns);
        tool.check(&rows)?;
        begins.iter_mut().for_each(|begin| *begin = rows.nearest(*begin));
        let step = |index: usize| {
            let end = begins.get(index + 1).copied().unwrap_or(u64::MAX);
            (seconds(begins[index]), rows.between(begins[index], end).motion(robot, begins[index]).without_rest())
        };
        let steps = (0..legs.len()).map(step).collect();
        Ok(Self { whole: rows.motion(robot, 0), steps })
    }
}

/// A change of a stroke's acceleration at least this far from a row, in nanoseconds, gets its own row. If it is nearer, the
/// stroke between rows deviates from its profile by less than a nanometre.
const MIN_ROW_GAP: u64 = 1_000;

/// A stroke of the tool, down or up, or a turn of the wrist.
#[derive(Debug, Clone)]
struct TimedStroke {
    /// Time at which it begins, nanoseconds.
    begin: u64,
    /// The joint's values at both ends, metres or radians; for a turn, relative to its beginning.
    ends: [f64; 2],
    /// Seconds since the beginning, distance and speed at the ends of phases of constant jerk.
    phases: Vec<[f64; 3]>,
}

impl TimedStroke {
    /// Iterates over the times at which the acceleration or the jerk changes, in nanoseconds.
    fn changes(&self) -> impl Iterator<Item = u64> {
        self.phases.iter().map(|[time, ..]| self.begin + nanoseconds(*time))
    }

    /// Returns the joint's value and velocity at the time of a row during or after the stroke. `before` and `after` are the times
    /// of the adjacent rows.
    fn at(&self, time: u64, [before, after]: [Option<u64>; 2]) -> [f64; 2] {
        let [from, to] = self.ends;
        let since = seconds(time - self.begin);
        let end = self.phases.last().map_or(0.0, |[time, ..]| *time);
        let phase = self.phases.windows(2).find(|phase| phase[1][0] > since);
        // A row shortly before or after the beginning or the end of the stroke may stand for it, unless the adjacent row does. If
        // two rows did, the stroke between the next ones would be too fast.
        let end = self.begin + nanoseconds(end);
        let is_near = |row: Option<u64>, change: u64| row.is_some_and(|row| row.abs_diff(change) <= MIN_ROW_GAP);
        let is_over = time >= end || (is_near(Some(time), end) && !is_near(after, end));
        if !is_over && is_near(Some(time), self.begin) && !is_near(before, self.begin) {
            return [from, 0.0];
        }
        let Some(phase) = phase.filter(|_| !is_over) else { return [to, 0.0] };
        let [distance, speed, _] = phase_at([phase[0], phase[1]], since);
        let sign = (to - from).signum();
        [from + sign * distance, sign * speed]
    }
}

impl Messages {
    /// Returns the messages without accelerations, for programs that join samples by cubics.
    pub fn without_accelerations(self) -> Self {
        let steps = self.steps.into_iter().map(|(begin, motion)| (begin, motion.without_accelerations()));
        Self { whole: self.whole.without_accelerations(), steps: steps.collect() }
    }

    /// Checks that quintics also describe the motion of the tool. This is so only if the tool does not move, because its
    /// acceleration would jump.
    pub fn check_accelerations(&self, robot: &RobotJoints) -> Result<(), MessageError> {
        let tool = |driver: Driver| matches!(driver, Driver::Stroke | Driver::Wrist);
        let moved = |(k, joint): (usize, &RobotJoint)| {
            let moving = self.whole.velocity.iter().position(|rates| rates[k] != 0.0);
            moving.filter(|_| tool(joint.driver)).map(|sample| (joint.name.clone(), self.whole.time[sample]))
        };
        match robot.joints.iter().enumerate().find_map(moved) {
            Some((joint, time)) => Err(MessageError::Tool { joint, time }),
            None => Ok(()),
        }
    }
}

/// Values of the joints at a time in whole nanoseconds.
#[derive(Debug, Clone, Copy)]
struct Row {
    at: u64,
    value: Drives,
    rate: Drives,
    /// Accelerations of the two planned joints.
    acceleration: [f64; 2],
}

impl Row {
    /// Returns the row at a time between this row and a later one, with all joints on cubics.
    fn toward(&self, later: &Self, at: u64) -> Self {
        if self.value == later.value && self.rate == later.rate {
            // A rounding error must not move joints at rest.
            return Self { at, ..*self };
        }
        let ends = [self.at, later.at].map(seconds);
        let cubic = |value: fn(&Drives) -> [f64; 2]| {
            let state = |row: &Row| [value(&row.value).into(), value(&row.rate).into()];
            let piece = Piece::hermite(ends[0], ends[1], state(self), state(later));
            let share = (seconds(at) - ends[0]) / (ends[1] - ends[0]);
            [Derivative::Position, Derivative::Velocity, Derivative::Acceleration].map(|of| piece.derivative(of, share))
        };
        let [planned, rates, accelerations] = cubic(|drives| drives.planned);
        let [wrist, turning, _] = cubic(|drives| [drives.wrist, 0.0]);
        Self {
            at,
            value: Drives { planned: planned.into(), wrist: wrist[0], ..self.value },
            rate: Drives { planned: rates.into(), wrist: turning[0], ..self.rate },
            acceleration: accelerations.into(),
        }
    }
}

/// Rows in chronological order, each with a different time.
#[derive(Debug, Default)]
struct Rows(Vec<Row>);

impl Rows {
    /// Adds a row. It replaces an earlier row with the same time, because its acceleration is that of the interval that begins
    /// then.
    fn push(&mut self, row: Row) {
        self.0.pop_if(|last| last.at == row.at);
        self.0.push(row);
    }

    /// Adds rows where the acceleration of a stroke or a turn changes.
    fn add_changes<'a>(&mut self, strokes: impl Iterator<Item = &'a TimedStroke>) {
        for change in strokes.flat_map(TimedStroke::changes) {
            let next = self.0.partition_point(|row| row.at < change);
            let (Some(before), Some(after)) = (next.checked_sub(1), self.0.get(next)) else { continue };
            if change - self.0[before].at > MIN_ROW_GAP && after.at - change > MIN_ROW_GAP {
                let row = self.0[before].toward(after, change);
                self.0.insert(next, row);
            }
        }
    }

    /// Adds strokes to rows with the initial value of the stroke.
    fn add_strokes(&mut self, strokes: &[TimedStroke]) {
        for index in 0..self.0.len() {
            let (beside, row) = (self.beside(index), &mut self.0[index]);
            let begun = strokes.partition_point(|stroke| stroke.begin <= row.at);
            if let Some(stroke) = begun.checked_sub(1).map(|last| &strokes[last]) {
                [row.value.stroke, row.rate.stroke] = stroke.at(row.at, beside);
            }
        }
    }

    /// Returns the times of the rows before and after a row.
    fn beside(&self, index: usize) -> [Option<u64>; 2] {
        [index.checked_sub(1), Some(index + 1)].map(|beside| self.0.get(beside?).map(|row| row.at))
    }

    /// Adds turns to rows in which the wrist only compensates the rotation of link 2.
    fn add_turns(&mut self, turns: &[TimedStroke]) {
        let (mut done, mut turned) = (0, 0.0);
        for index in 0..self.0.len() {
            let (beside, row) = (self.beside(index), &mut self.0[index]);
            while turns.get(done + 1).is_some_and(|next| next.begin <= row.at) {
                turned += turns[done].ends[1];
                done += 1;
            }
            if let Some(turn) = turns.get(done).filter(|turn| turn.begin <= row.at) {
                let [angle, rate] = turn.at(row.at, beside);
                row.value.wrist += turned + angle;
                row.rate.wrist += rate;
            }
        }
    }

    /// Returns the time of the row that stands for `time`: `time` itself, unless there is a row closely before or after it.
    fn nearest(&self, time: u64) -> u64 {
        let next = self.0.partition_point(|row| row.at < time);
        let beside = [next.checked_sub(1), Some(next)].into_iter().flatten().filter_map(|row| self.0.get(row));
        let closest = beside.map(|row| row.at).min_by_key(|at| at.abs_diff(time));
        closest.filter(|at| at.abs_diff(time) <= MIN_ROW_GAP).unwrap_or(time)
    }

    /// Returns the rows between two times. The last one has no acceleration, because the interval after it is not included.
    fn between(&self, from: u64, to: u64) -> Self {
        let mut rows: Vec<Row> = self.0.iter().filter(|row| (from..=to).contains(&row.at)).copied().collect();
        rows.last_mut().into_iter().for_each(|last| last.acceleration = [0.0; 2]);
        Self(rows)
    }

    fn motion(&self, robot: &RobotJoints, begin: u64) -> JointMotion {
        let acceleration = |row: &Row| robot.rates(&Drives { planned: row.acceleration, ..Drives::default() });
        JointMotion {
            joints: robot.names().map(str::to_owned).collect(),
            time: self.0.iter().map(|row| seconds(row.at - begin)).collect(),
            position: self.0.iter().map(|row| robot.values(&row.value)).collect(),
            velocity: self.0.iter().map(|row| robot.rates(&row.rate)).collect(),
            acceleration: Some(self.0.iter().map(acceleration).collect()),
        }
    }
}

/// The state of the tool during the steps.
struct Tool<'a> {
    robot: &'a RobotJoints,
    task: &'a Task,
    /// The value of the wrist's joint without the turns so far, radians.
    wrist: f64,
    /// Sum of the turns so far, radians.
    turned: f64,
    /// The strokes so far, in chronological order.
    strokes: Vec<TimedStroke>,
    /// The turns so far, in chronological order.
    turns: Vec<TimedStroke>,
}

impl Tool<'_> {
    /// Returns the row at the beginning of a task that begins with a rest. `None` if the arm departs at once.
    fn first_row(&self, leg: &Leg, sequence: &Sequence) -> Option<Row> {
        let [begin, ..] = sequence.times(0);
        let planned = *leg.timed.trajectory.position.first()?;
        let value = Drives { planned, stroke: self.initial_stroke(), wrist: self.wrist };
        (begin > 0.0).then(|| Row { at: 0, value, rate: Drives::default(), acceleration: [0.0; 2] })
    }

    /// Returns the value of the stroke's joint before the first stroke.
    fn initial_stroke(&self) -> f64 {
        self.robot.stroke.as_ref().map_or(0.0, |stroke| stroke.lowered(self.task.start_tool.depth))
    }

    /// Records the stroke up with which a motion begins. `departure` is the time at which the arm departs, in nanoseconds.
    fn raise_first(&mut self, leg: &Leg, departure: u64) {
        let Some(raising) = leg.raising else { return };
        let mut at = (departure + nanoseconds(leg.overlap.raising)).saturating_sub(nanoseconds(raising.seconds));
        self.stroke(Some(raising), true, &mut at);
    }

    /// Returns the rows of a step, with the initial value of the stroke, and records its strokes. `begin`, `arrival` and `end` are its
    /// times in nanoseconds.
    fn rows(&mut self, leg: &Leg, [begin, arrival, end]: [u64; 3]) -> Rows {
        let mut rows = Rows::default();
        let trajectory = &leg.timed.trajectory;
        let stroke = self.initial_stroke();
        for (k, time) in trajectory.time.iter().enumerate() {
            let [wrist, turning] = self.wrist_state(leg, k);
            rows.push(Row {
                at: begin + nanoseconds(*time),
                value: Drives { planned: trajectory.position[k], stroke, wrist },
                rate: Drives { planned: trajectory.velocity[k], stroke: 0.0, wrist: turning },
                acceleration: trajectory.acceleration[k],
            });
        }
        let Some(&Row { value, .. }) = rows.0.last() else { return rows };
        self.wrist = value.wrist;
        // At a place, the wrist turns before the tool is lowered; at a pick, after the tool has been raised.
        let places = matches!(leg.event, Some(Event::Release { .. }));
        let mut at = arrival - nanoseconds(leg.overlap.arrival());
        if places {
            self.turn(leg, &mut at);
        }
        self.stroke(leg.stroke, false, &mut at);
        at += nanoseconds(whole_nanoseconds(leg.step.dwell));
        // After a move, the tool stays lowered.
        self.stroke(leg.stroke.filter(|_| leg.event.is_some()), true, &mut at);
        if !places {
            self.turn(leg, &mut at);
        }
        self.wrist_motion(leg);
        // The whole motion ends in the same nanosecond as the sequence.
        rows.0.pop_if(|last| last.at >= end);
        rows.push(Row { at: end, value, rate: Drives::default(), acceleration: [0.0; 2] });
        rows
    }

    /// Returns value and velocity of the wrist's joint at sample `k` of the arm's motion.
    fn wrist_state(&self, leg: &Leg, k: usize) -> [f64; 2] {
        let (Some(joint), Some(limits)) = (&self.robot.wrist, self.task.wrist) else { return [self.wrist, 0.0] };
        if leg.carried.is_none() && leg.wrist.is_some() {
            return [self.wrist, 0.0];
        }
        let held = leg.carried.map(|object| self.task.objects[object].holding);
        let (of_joint, from) = ((joint.sign, joint.rest), self.wrist + self.turned);
        let arm = &self.task.arm;
        let [value, rate] = wrist_state(arm, limits, of_joint, held, &leg.timed.trajectory, (from, k));
        [value - self.turned, rate]
    }

    /// Records a turn of the payload by the wrist, and advances the time to its end.
    fn turn(&mut self, leg: &Leg, at: &mut u64) {
        let (Some((turn, seconds)), Some(limits)) = (leg.turn, self.task.wrist) else { return };
        if let Some(joint) = &self.robot.wrist {
            let by = joint.sign * (turn.to - turn.from);
            self.turns.push(TimedStroke {
                begin: *at,
                ends: [0.0, by],
                phases: turn_profile(&limits, by.abs(), seconds),
            });
            self.turned += by;
        }
        *at += nanoseconds(seconds);
    }

    /// Records the turn of the wrist to the value that the step states.
    fn wrist_motion(&mut self, leg: &Leg) {
        let (Some(WristMotion { angle, begin, seconds, .. }), Some(limits)) = (leg.wrist, self.task.wrist) else {
            return;
        };
        if angle != 0.0 {
            let phases = turn_profile(&limits, angle.abs(), seconds);
            self.turns.push(TimedStroke { begin: nanoseconds(begin), ends: [0.0, angle], phases });
            self.turned += angle;
        }
    }

    /// Records a stroke down or up, and advances the time to its end.
    fn stroke(&mut self, stroke: Option<ToolStroke>, up: bool, at: &mut u64) {
        let (Some(stroke), Some(limits)) = (stroke, &self.task.stroke) else { return };
        let ends = if up { [stroke.lowered, stroke.raised] } else { [stroke.raised, stroke.lowered] };
        if self.robot.stroke.is_some() {
            let phases = single((ends[1] - ends[0]).abs(), &limits.limits());
            self.strokes.push(TimedStroke { begin: *at, ends, phases });
        }
        *at += nanoseconds(stroke.seconds);
    }

    /// Checks that the wrist's joint is within its range and below its top speed.
    fn check(&self, rows: &Rows) -> Result<(), MessageError> {
        let (Some(joint), Some(limits)) = (&self.robot.wrist, self.task.wrist) else { return Ok(()) };
        let what = |row: &Row| limit_violation(joint, limits, row.value.wrist, row.rate.wrist);
        match rows.0.iter().find_map(|row| what(row).map(|what| (row.at, what))) {
            Some((at, what)) => Err(MessageError::Wrist { joint: joint.name.clone(), time: seconds(at), what }),
            None => Ok(()),
        }
    }
}

/// Describes the violation if a joint exceeds its speed or its range.
fn limit_violation(joint: &ToolJoint, limits: Wrist, value: f64, rate: f64) -> Option<String> {
    if rate.abs() > limits.velocity * (1.0 + ROUNDING) {
        return Some(format!("turn at {:.3} rad/s, above its top speed of {} rad/s", rate.abs(), limits.velocity));
    }
    match joint.range {
        JointRange::Interval { lower, upper } if value < lower - ROUNDING || value > upper + ROUNDING => {
            Some(format!("be at {value:.3} rad, outside its limits [{lower}, {upper}] rad"))
        }
        _ => None,
    }
}
