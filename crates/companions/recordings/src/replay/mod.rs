//! Replays and judges a recorded task: checks that it is the task of the world, and that every motion and every turn is
//! free.
//!
//! The replay shares only data types with the search for task plans. The places of objects, the load, its pose and the
//! permitted contacts are derived from the world's steps and from the recorded configurations.

mod fault;
mod judged;
mod line;
mod order;
mod overlap;
mod state;
mod tool_angle;
mod tool_joints;

pub use fault::{Fault, OrderDeviation};
pub use tool_joints::{MisplacedJoint, StepTool, misplaced_joints};

use cplan_geometry::{Interval, Point, Pose};
use cplan_handling::{
    Action, Derivative, ObstacleTrajectory, Piece, RecordedStep, RecordedTurn, Recording, Step, Task,
};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Goal, Scene};
use cplan_motion::recorded::{
    CollisionCheck, Limit, LimitViolation, TurnContact, WristTurn, limit_violations, motor_violations,
    torque_violations,
};
use judged::Judged;
use order::{MatchedStep, match_steps};
use overlap::{Overlaps, PartialStroke, turn_faults, turning_at_rest};
use state::{State, lowering_seconds, wrist_faults};
use std::ops::RangeInclusive;

/// Largest difference between an actual and a required place, metres or radians. It is a thousand times the error of
/// inverse kinematics, and below the repeatability of any arm.
pub const PLACE_TOLERANCE: f64 = 1e-6;

/// Largest amount by which a time may be too short, in seconds. It exceeds the rounding of clocks, and rests that are
/// too short to be sampled. It is far below the precision of grippers.
pub const TIME_TOLERANCE: f64 = 1e-6;

/// A turn of the wrist that was checked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplayedTurn {
    /// The recorded turn.
    pub turn: RecordedTurn,
    /// A proof that it is free, or the first place of contact.
    pub verdict: Result<WristTurn, TurnContact>,
}

/// A gripper event in a step.
#[derive(Debug, Clone, PartialEq)]
pub struct GripperEvent {
    /// The step's number in the world file, from 1.
    pub step: usize,
    /// Number of its repetition, from 1.
    pub cycle: usize,
    /// The object that it takes or releases.
    pub object: usize,
    /// Time of the event, in seconds from the beginning of the record: when the motion, the turn before a release, and
    /// the downward stroke of the tool have ended.
    pub time: f64,
    /// Position of the tip.
    pub tip: Point,
    /// Pose of the object after its release. `None` if the event is a grasp.
    pub pose: Option<Pose>,
}

/// A recorded step that was checked.
#[derive(Debug, Clone)]
pub struct ReplayedStep<'a> {
    /// The required step.
    pub step: &'a Step,
    /// The recorded step.
    pub recorded: &'a RecordedStep,
    /// The scene during the motion, with the load. If only the arm at rest after the last step collides, this is the
    /// scene after that step.
    pub scene: Scene,
    /// The trajectories of the scene's moving obstacles, on a clock that begins with the motion.
    pub trajectories: Vec<ObstacleTrajectory>,
    /// The object that is picked or placed.
    pub object: Option<usize>,
    /// The object that is carried during the motion.
    pub carried: Option<usize>,
    /// Seconds from the beginning to the end of the motion.
    pub seconds: f64,
    /// Seconds from the beginning of the record to three times: the beginning of the motion, its end, and the next
    /// motion or the end of the record.
    pub times: [f64; 3],
    /// Least time for which the arm rests after the motion: dwell, turn and strokes, seconds.
    pub rest: f64,
    /// Depths of the lowered tool before the motion and at its end, metres. `None` if it is raised.
    pub depths: [Option<f64>; 2],
    /// The gripper event, if there is one.
    pub event: Option<GripperEvent>,
    /// The collision check of the motion, with the tool at the height that strokes give it. Moments are those of the
    /// whole recording.
    pub collision_check: CollisionCheck,
    /// Violations of joint limits. The joints' own limits apply, even if the step states a lower speed.
    pub broken: Vec<LimitViolation>,
    /// The turn of the wrist after the motion. `None` if there is none, or if it was recorded without a payload, which
    /// is a fault.
    pub turn: Option<ReplayedTurn>,
    /// Differences from the required step.
    pub faults: Vec<Fault>,
    /// The motion of the tool, as it was judged.
    pub tool: StepTool,
}

/// An iterator that checks the recorded steps in their order.
#[derive(Debug, Clone)]
pub struct Replay<'a> {
    task: &'a Task,
    recording: &'a Recording,
    recorded: &'a [RecordedStep],
    matched: Vec<MatchedStep<'a>>,
    departure: Option<OrderDeviation>,
    next: usize,
    state: State,
    /// The stroke that raises the tool, and the turn of the wrist, if they overlap with the next motion.
    before: (Option<PartialStroke>, Option<RecordedTurn>),
}

/// Matches the steps of a record with those of the task. Steps must come in the task's order, except that pairs of a
/// free group may come in any order. The arm must be at rest between steps. Iteration then checks each step, up to the
/// point where the record deviates from the task. It checks:
/// - Each motion from rest to rest, by [`cplan_motion::recorded::check_collision`] with the workspace's clearance, and
///   by [`limit_violations`]. Objects are where previous steps left them, and the load keeps the pose in which it was
///   taken. Link 2 may touch the object that it takes, and the object that it released last. Payloads may rest on their
///   supports. The state after the last step is checked as well.
/// - Strokes that overlap with motions, with the tool at its height at each moment. The tool must be raised completely
///   in between, and be as high as the world requires while the arm moves.
/// - Turns that overlap with motions, with the wrist at its angle at each moment. The wrist must turn only while the
///   tool is raised, and keep its limits although it also compensates the rotation of link 2.
/// - Moving obstacles, whose clock starts at the first sample. Moving objects must be picked within their windows of
///   time, and the resting arm must stay free between motions.
/// - Motions along a line, which must be within its tolerance, and at most as fast as the line allows. If the line
///   requires an angle of the tool, the wrist must keep it, also between samples, and stay within its limits.
/// - The end of each step. The tip must be at the grasp, and the object or the arm at its target, within a micrometre.
///   A turn must start at the object's orientation, last at least as long as the wrist needs, and be free
///   ([`cplan_motion::recorded::TurnAtRest`]). The arm must rest for the dwell, the turn, and the stroke of the
///   tool. The stroke must be free at all its heights.
/// - The values of the tool's joints at the start and at the end of a move. The arm must rest while the tool is raised
///   and lowered there, except in overlaps, and the wrist must turn from one value to the other within its limits.
///
/// Takes `O(n)` for `n` samples, plus the checks of motions.
pub fn replay<'a>(task: &'a Task, recording: &'a Recording, recorded: &'a [RecordedStep]) -> Replay<'a> {
    let (matched, departure) = match_steps(task, recording, recorded);
    Replay { task, recording, recorded, matched, departure, next: 0, state: State::initial(task), before: (None, None) }
}

impl Replay<'_> {
    /// Returns three times, in seconds from the beginning of the record: when the step's motion begins, when it ends,
    /// and when the next step's motion begins.
    fn times(&self, index: usize, recorded: &RecordedStep) -> [f64; 3] {
        let times = self.recording.times();
        let since = |sample: usize| times.and_then(|times| Some(times.get(sample)? - times[0])).unwrap_or(0.0);
        [since(*recorded.samples.start()), since(*recorded.samples.end()), since(self.next_begins(index))]
    }

    /// Returns the index of the first sample of the next step, or of the last sample if there is no next step.
    fn next_begins(&self, index: usize) -> usize {
        let last = self.recording.positions().len() - 1;
        self.recorded.get(index + 1).map_or(last, |next| *next.samples.start())
    }

    /// Returns the point where the record deviates from the sequence of the task. `None` if the record is the whole
    /// task.
    pub fn departure(&self) -> Option<&OrderDeviation> {
        self.departure.as_ref()
    }
}

impl<'a> Iterator for Replay<'a> {
    type Item = ReplayedStep<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        let index = self.next;
        let (matched, recorded) = (self.matched.get(index)?.clone(), self.recorded.get(index)?);
        let motion = self.recording.part(recorded.samples.clone())?;
        self.next += 1;
        let (task, recording, step) = (self.task, self.recording, matched.step);
        let required = task.workspace.fixed.clearance;
        let mut faults = Vec::new();
        let [from, to] = [0, motion.positions().len() - 1].map(|sample| motion.positions()[sample]);
        if index == 0 && !is_same_pose(task, from, task.start) {
            faults.push(Fault::Start);
        }
        self.state.renew(task, &matched.renewed);
        let (carried, released) = (self.state.carried(), self.state.released());
        let picked = step.action.picked();
        let times = self.times(index, recorded);
        let [first, last] = [*recorded.samples.start(), *recorded.samples.end()];
        let scene = self.state.scene(task, picked);
        let mut broken = limit_violations(&task.arm.joints, &motion);
        broken.extend(motor_violations(&task.arm, &motion));
        broken.extend(torque_violations(&scene, &motion));
        broken.iter_mut().for_each(|excess| excess.moment.sample += first);
        let judge = |samples: RangeInclusive<usize>, scene: Scene, trajectories: Vec<ObstacleTrajectory>| {
            Judged::of(task, recording, samples, scene, trajectories)
        };
        let mut judged = judge(first..=last, scene, self.state.trajectories(task, times[0]))?;
        let mut object = carried;
        let handled = picked.or(carried.filter(|_| matches!(step.action, Action::Place { .. })));
        let depth = match handled {
            Some(object) => task.stroke.as_ref().map(|stroke| stroke.depth(&task.objects[object]) - step.elevation),
            None => step.tool.lowered_by(),
        };
        let raised_first = self.state.raise(task);
        let raised_from = raised_first.as_ref().map(|(depth, _)| *depth);
        let mut before = std::mem::take(&mut self.before);
        match &raised_first {
            Some((depth, _)) => {
                let (depth, overlap) = (*depth, recorded.raising);
                before.0 = Some(PartialStroke { depth, overlap }).filter(|_| overlap > 0.0);
                let (stood, asked) = (times[0], lowering_seconds(task, depth) - overlap);
                if index == 0 && stood < asked - TIME_TOLERANCE {
                    faults.push(Fault::RestBefore { stood, asked });
                }
            }
            None => faults.extend((recorded.raising > 0.0).then_some(Fault::NotLowered)),
        }
        let overlaps = Overlaps::new(before, recorded, depth);
        faults.extend(overlaps.faults(task, motion.duration().unwrap_or(0.0)));
        if let Some(clearance) = judged.check.clearance()
            && let Some(found) = overlaps.check(task, &self.state, &motion, picked, clearance)
        {
            judged.add_in(found, first);
        }
        if let Some(sought) = judged.check.clearance()
            && let Some(found) = overlaps.check_turns(task, &judged.scene, &motion, (required, sought), &mut faults)
        {
            judged.add_in(found, first);
        }
        let (turn, lowered);
        match &step.action {
            Action::Pick { object: picked, grasp, when, .. } => {
                object = Some(*picked);
                let is_in_time =
                    |[from, to]: &Interval| from - TIME_TOLERANCE <= times[1] && times[1] <= to + TIME_TOLERANCE;
                if self.state.stop(task, *picked, times[1]) && !(when.is_empty() || when.iter().any(is_in_time)) {
                    faults.push(Fault::When { time: times[1] });
                }
                // The place step that follows declares the supports.
                let following = self.matched[index + 1..].iter().find_map(|next| match &next.step.action {
                    Action::Place { supports, .. } => Some(supports.as_slice()),
                    _ => None,
                });
                faults.extend(self.state.grasp(task, to, step, *grasp, following.unwrap_or_default()));
                lowered = self.state.lowered(task, step.elevation, false);
                turn = self.state.turn(task, to, recorded.turn, &mut faults);
            }
            Action::Place { at, angle, .. } => {
                turn = self.state.turn(task, to, recorded.turn, &mut faults);
                lowered = self.state.lowered(task, step.elevation, true);
                faults.extend(self.state.release(task, (to, step.elevation), *at, *angle));
            }
            Action::Move(goal) => {
                (object, lowered) = (None, self.state.lower(task, step));
                faults.extend(distance_from_goal(task, to, goal));
                turn = self.state.turn(task, to, recorded.turn, &mut faults);
                self.state.moved();
            }
            Action::Follow(followed) => {
                (object, lowered) = (None, None);
                faults.extend(line::fault(task, &motion, followed));
                faults.extend(line::speed_fault(task, &motion, followed));
                faults.extend(tool_angle::faults(task, &motion, followed, recorded.wrist_motion.as_deref()));
                turn = self.state.turn(task, to, recorded.turn, &mut faults);
                self.state.moved();
            }
        }
        faults.extend(elbow_fault(task, step, &motion));
        let asked_rest = step.dwell
            + recorded.turn.as_ref().map_or(0.0, turning_at_rest)
            + depth.map_or(0.0, |depth| lowering_seconds(task, depth) * if handled.is_some() { 2.0 } else { 1.0 })
            - overlaps.lowering.map_or(0.0, |lowering| lowering.overlap)
            - handled.map_or(0.0, |_| recorded.overlap.after_departure);
        // A moving obstacle may hit the resting arm.
        if task.has_moving_obstacles() && judged.check.is_free() {
            let (stays, then) = (self.state.scene(task, released), self.state.trajectories(task, times[1]));
            let found = judge(last..=self.next_begins(index), stays, then).filter(|found| !found.check.is_free());
            found.into_iter().for_each(|found| judged.add(found));
        }
        let below = [raised_first.map(|(_, scene)| (scene, first)), lowered.map(|scene| (scene, last))];
        for (below, sample) in below.into_iter().flatten() {
            let found = judge(sample..=sample, below, task.workspace.trajectories());
            found.into_iter().for_each(|found| judged.add(found));
        }
        // The next step's checks begin in the state after this step. Judge the arm at rest here if this step is the
        // last, or if objects are renewed next: until then, released objects are still present.
        let next = self.matched.get(self.next);
        let (is_last, is_renewed) = (next.is_none(), next.is_some_and(|next| !next.renewed.is_empty()));
        if (is_last || is_renewed) && judged.check.is_free() {
            let after = self.state.scene(task, released.filter(|_| is_last));
            if is_last
                && broken.iter().all(|excess| excess.limit != Limit::Torque)
                && let Some(standing) = recording.part(last..=last)
            {
                let mut held = torque_violations(&after, &standing);
                held.iter_mut().for_each(|excess| excess.moment.sample += last);
                broken.extend(held);
            }
            let found = judge(last..=last, after, self.state.trajectories(task, times[1]));
            found.filter(|found| !found.check.is_free()).into_iter().for_each(|found| judged.add(found));
        }
        let is_picked = matches!(step.action, Action::Pick { .. });
        let raising = depth.filter(|_| handled.is_some() && recorded.overlap.after_departure > 0.0);
        let turn_after = recorded.turn.filter(|turn| turn.overlap.after_departure > 0.0);
        self.before =
            (raising.map(|depth| PartialStroke { depth, overlap: recorded.overlap.after_departure }), turn_after);
        if is_last && (raising.is_some() || turn_after.is_some()) {
            faults.push(Fault::MustRest);
        }
        faults.extend(turn_faults(recorded, is_picked, matches!(step.action, Action::Place { .. })));
        if let Some(stood) = matched.rest.filter(|stood| *stood < asked_rest - TIME_TOLERANCE) {
            faults.push(Fault::Rest { stood, asked: asked_rest });
        }
        faults.extend(wrist_faults(task, step, recorded.wrist, times[2]));
        let lowered = |depth: Option<f64>| depth.zip(task.stroke.as_ref()).map(|(depth, stroke)| stroke.lowered(depth));
        let asked = [lowered(raised_from), lowered(depth)];
        for ((is, asked), when) in recorded.lowered.into_iter().zip(asked).zip(["before", "after"]) {
            // Recordings of other programs need not state the strokes at picks and places.
            let is_optional = is.is_none() && when == "after" && handled.is_some();
            let differs = is.zip(asked).is_none_or(|(is, asked)| (is - asked).abs() > PLACE_TOLERANCE);
            if is.is_some() != asked.is_some() && !is_optional || (is.is_some() && differs) {
                faults.push(Fault::Lowered { is, asked, when });
            }
        }
        let seconds = motion.duration().unwrap_or(0.0);
        let event = object.map(|object| {
            let pose = self.state.pose(object);
            let turning = pose.and(recorded.turn.as_ref()).map_or(0.0, turning_at_rest);
            let lowering = depth.map_or(0.0, |depth| lowering_seconds(task, depth))
                - overlaps.lowering.map_or(0.0, |lowering| lowering.overlap);
            let (number, cycle, tip) = (step.number, step.cycle, task.arm.tip_at(to));
            GripperEvent { step: number, cycle, object, time: (times[1] + turning + lowering).min(times[2]), tip, pose }
        });
        let holding = |object: usize| task.objects[object].holding;
        let tool = StepTool {
            times,
            overlaps,
            depth,
            stays_lowered: handled.is_none(),
            carried: carried.map(holding),
            picked: picked.map(holding),
            turn: recorded.turn,
        };
        Some(ReplayedStep {
            tool,
            step,
            recorded,
            scene: judged.scene,
            trajectories: judged.trajectories,
            object,
            carried,
            seconds,
            times,
            rest: asked_rest,
            depths: [raised_from, depth],
            event,
            collision_check: judged.check,
            broken,
            turn,
            faults,
        })
    }
}

/// Returns true if two configurations are equal up to whole turns of joints on a circle.
fn is_same_pose(task: &Task, a: Configuration, b: Configuration) -> bool {
    task.arm.topology().displacement(a, b).amax() <= PLACE_TOLERANCE
}

/// Returns the difference between a motion's end and the goal of a move. `None` if the goal is reached.
fn distance_from_goal(task: &Task, q: Configuration, goal: &Goal) -> Option<Fault> {
    match goal {
        Goal::Joints(target) => (!is_same_pose(task, q, *target)).then_some(Fault::Joints { is: q, target: *target }),
        Goal::Tip(_) | Goal::TipAndElbow(..) | Goal::Area(_) => {
            let is = task.arm.tip_at(q);
            let off = (is - goal.nearest_tip(is)?).norm();
            (off > PLACE_TOLERANCE).then_some(Fault::Tip { off })
        }
    }
}

/// Returns a fault if the elbow is on the wrong side at the end of a step, or on a part of its line.
fn elbow_fault(task: &Task, step: &Step, motion: &Recording) -> Option<Fault> {
    let elbow = step.required_elbow()?;
    let is_wrong = |q: Configuration| elbow.excess(&task.arm, q) > PLACE_TOLERANCE;
    let is_wrong_in = |piece: &Piece| piece.critical(Derivative::Position, 1).any(|u| is_wrong(piece.at(u)));
    let along_line = matches!(step.action, Action::Follow(_)) && motion.pieces().iter().any(is_wrong_in);
    let at_end = motion.positions().last().is_some_and(|q| is_wrong(*q));
    (along_line || at_end).then_some(Fault::Elbow { elbow })
}

/// Returns the difference between two orientations, from zero to half a turn.
pub(super) fn angle_between(a: f64, b: f64) -> f64 {
    JointRange::Circle.displacement(b, a).abs()
}
