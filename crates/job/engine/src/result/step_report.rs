//! The steps of a task in the JSON of a result.

use super::finite;
use cplan_handling::{Action, Task};
use cplan_judge::CheckedProof;
use cplan_legs::{Event, FailedStep, Leg, RefusedIkSolution, Sequence, TaskAnswer, ToolStroke, WristMotion};
use cplan_motion::BlendReport;
use cplan_motion::recorded::WristTurn;
use serde::Serialize;
use std::borrow::Cow;

/// Returns the kind of a step, in one word.
fn action_name(action: &Action) -> &'static str {
    match action {
        Action::Pick { .. } => "pick",
        Action::Place { .. } => "place",
        Action::Move(_) => "move",
        Action::Follow(_) => "follow",
    }
}

/// A turn of the wrist. The arm stands still, except during overlaps.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnReport {
    /// Orientation of the object at the beginning, radians.
    pub from: f64,
    /// Orientation of the object at the end, in radians. The sign of its difference from `from` is the direction of the
    /// turn.
    pub to: f64,
    /// Duration of the turn, in seconds. The wrist turns with its fastest motion, or with that motion stretched evenly in
    /// time.
    pub seconds: f64,
    /// Time from the beginning of the turn before a place to the arrival of the arm, in seconds. 0 if the arm arrives
    /// first.
    #[serde(skip_serializing_if = "is_zero")]
    pub before_arrival: f64,
    /// Time from the beginning of the next motion to the end of the turn after a pick, in seconds. 0 if the arm departs
    /// later.
    #[serde(skip_serializing_if = "is_zero")]
    pub after_departure: f64,
    /// Proven lower bound on the distance between the object and obstacles while the arm stands still, metres. `None` if no obstacle is within
    /// reach.
    pub clearance: Option<f64>,
}

/// Returns true for an empty overlap, which is omitted.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(seconds: &f64) -> bool {
    *seconds == 0.0
}

/// A stroke of the tool: the tool is lowered, the gripper acts, and the tool is raised. The arm stands still, except during
/// overlaps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StrokeReport {
    /// The joint's value while the tool is raised, metres.
    pub raised: f64,
    /// The joint's value while the tool is lowered, in metres.
    pub lowered: f64,
    /// Duration of the stroke down, in seconds. The stroke up takes as long.
    pub seconds: f64,
    /// Time from the beginning of the stroke down to the arrival of the arm, in seconds. 0 if the arm arrives first.
    pub before_arrival: f64,
    /// Time from the beginning of the next motion to the end of the stroke up, in seconds. 0 if the arm departs later.
    pub after_departure: f64,
    /// Proven lower bound on the distance to obstacles while the arm stands still, metres. `None` if no obstacle is
    /// within reach.
    pub clearance: Option<f64>,
}

/// A turn of the wrist with an empty gripper, to the value that the step states. The wrist turns with its fastest motion, or
/// with that motion stretched evenly in time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WristReport {
    /// The joint's value at the beginning, radians.
    pub from: f64,
    /// The joint's value at the end, radians.
    pub to: f64,
    /// Time from the beginning of the task to the beginning of the turn, in seconds.
    pub begin: f64,
    /// Duration, in seconds.
    pub seconds: f64,
}

/// The motion of the wrist's joint along a line, at the samples of the step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WristMotionReport {
    /// Proven upper bound on the difference between the tool's angle and that which the line requires, radians.
    pub deviation: f64,
    /// Values of the joint, radians.
    pub position: Vec<f64>,
    /// Velocities, radians per second.
    pub velocity: Vec<f64>,
    /// Accelerations at the beginnings of the intervals after the samples, radians per second squared.
    pub acceleration: Vec<f64>,
}

impl WristMotionReport {
    fn new(deviation: f64, rows: &[[f64; 3]]) -> Self {
        let [position, velocity, acceleration] = [0, 1, 2].map(|k| rows.iter().map(|row| row[k]).collect());
        Self { deviation, position, velocity, acceleration }
    }
}

/// A step of the answer: a motion from rest to rest, and a rest after it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepReport {
    /// The step's number in the world file, from 1.
    pub step: usize,
    /// The repetition of the step, from 1.
    pub cycle: usize,
    /// The kind of step.
    pub action: &'static str,
    /// The object that is picked or placed.
    pub object: Option<String>,
    /// The object that is carried during the motion.
    pub carried: Option<String>,
    /// Time from the beginning of the task to the beginning of the motion, in seconds.
    pub begin: f64,
    /// Time from the beginning of the task to the end of the motion, in seconds.
    pub arrival: f64,
    /// Time from the beginning of the task to the end of the step, in seconds.
    pub end: f64,
    /// Waypoints of the motion, which straight segments connect.
    pub path: Vec<[f64; 2]>,
    /// Euclidean length of the path in joint space.
    pub length: f64,
    /// Proven lower bound on the distance between obstacles and the arm with its payload during the step, in metres. `None` if no
    /// obstacle is within reach.
    pub clearance: Option<f64>,
    /// Description of the link (or payload) and the obstacle that come nearest during the motion.
    pub closest: Option<String>,
    /// How the motion rounds the corners of the path.
    pub blends: BlendReport,
    /// Proven upper bound on the distance between the tip's path and the line, metres. `None` if the step follows no
    /// line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
    /// The motion of the wrist's joint along a line that states the tool's angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wrist_motion: Option<WristMotionReport>,
    /// The turn of the wrist after a pick or before a place.
    pub turn: Option<TurnReport>,
    /// The stroke up with which the step begins if the tool is lowered. `None` if it is raised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raising: Option<StrokeReport>,
    /// The stroke at the end of the motion. After a move, the tool stays lowered. `None` if it stays raised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stroke: Option<StrokeReport>,
    /// The turn of the wrist to the value that the step states, if it states one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wrist: Option<WristReport>,
    /// Index of the motion's first sample in the whole trajectory, from 0. `None` if the result has no whole
    /// trajectory.
    pub first_sample: Option<usize>,
    /// Index of the motion's last sample, at which the arm stands still. `None` if the result has no whole trajectory.
    pub last_sample: Option<usize>,
}

impl StepReport {
    /// Creates the report of step `index` of a sequence. `is_whole` is true if the result includes the trajectory of
    /// the whole sequence.
    fn new(task: &Task, legs: &[Leg], sequence: &Sequence, index: usize, is_whole: bool) -> Self {
        let leg = &legs[index];
        let curve = &leg.timed.curve;
        let path = curve.curve().path();
        let name = |object: usize| task.objects[object].name.clone();
        let [begin, arrival, end] = sequence.times(index);
        let samples = &sequence.samples[index];
        Self {
            step: leg.step.number,
            cycle: leg.step.cycle,
            action: action_name(&leg.step.action),
            object: leg.event.map(|event| name(event.object())),
            carried: leg.carried.map(name),
            begin,
            arrival,
            end,
            path: path.waypoints().iter().map(|q| [q[0], q[1]]).collect(),
            length: path.length(),
            clearance: finite(leg.clearance()),
            closest: curve.nearest().map(|nearest| leg.scene.describe(nearest.contact.pair)),
            blends: BlendReport::of(curve),
            deviation: leg.deviation,
            wrist_motion: leg
                .tool_deviation
                .map(|deviation| WristMotionReport::new(deviation, &leg.timed.trajectory.wrist)),
            turn: leg.turn.map(|(WristTurn { from, to, clearance }, seconds)| TurnReport {
                from,
                to,
                seconds,
                before_arrival: leg.overlap.turn_before_arrival,
                after_departure: legs.get(index + 1).map_or(0.0, |next| next.overlap.turn_after_departure),
                clearance: finite(clearance),
            }),
            raising: leg.raising.map(|stroke| StrokeReport::new(stroke, [0.0, leg.overlap.raising])),
            stroke: leg.stroke.map(|stroke| {
                let next = legs.get(index + 1).filter(|_| leg.event.is_some());
                StrokeReport::new(stroke, [leg.overlap.lowering, next.map_or(0.0, |next| next.overlap.raising)])
            }),
            wrist: leg.wrist.zip(task.start_tool.wrist).map(|(WristMotion { angle, begin, seconds, .. }, from)| {
                let to = leg.step.tool.wrist.unwrap_or(from + angle);
                WristReport { from, to, begin, seconds }
            }),
            first_sample: is_whole.then_some(*samples.start()),
            last_sample: is_whole.then_some(*samples.end()),
        }
    }
}

impl StrokeReport {
    fn new(stroke: ToolStroke, [before_arrival, after_departure]: [f64; 2]) -> Self {
        let ToolStroke { raised, lowered, seconds, clearance } = stroke;
        Self { raised, lowered, seconds, before_arrival, after_departure, clearance: finite(clearance) }
    }
}

/// Creates the reports of the steps of an answer, and of the events of the gripper.
pub fn step_reports(task: &Task, answer: &TaskAnswer) -> (Vec<StepReport>, Vec<EventReport>) {
    let (sequence, is_whole) = match answer.outcome.found() {
        Some(motion) => (Cow::Borrowed(&motion.sequence), true),
        None => (Cow::Owned(Sequence::of(&answer.legs)), false),
    };
    let legs = || answer.legs.iter().enumerate();
    let steps = (0..answer.legs.len()).map(|index| StepReport::new(task, &answer.legs, &sequence, index, is_whole));
    let events = legs().filter_map(|(index, leg)| EventReport::new(task, leg, &sequence, index));
    (steps.collect(), events.collect())
}

/// The pose of an object.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PoseReport {
    /// The object's origin in the plane, metres.
    pub at: [f64; 2],
    /// The object's orientation, radians.
    pub angle: f64,
}

/// An event of the gripper, with its time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventReport {
    /// Time of the event, in seconds from the beginning of the task.
    pub time: f64,
    /// The kind of event.
    pub event: &'static str,
    /// Name of the object.
    pub object: String,
    /// Number of the step in the world file, from 1.
    pub step: usize,
    /// The repetition of the step, from 1.
    pub cycle: usize,
    /// Position of the tip, metres.
    pub tip: [f64; 2],
    /// Pose of the object after its release. `None` for a grasp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<PoseReport>,
}

impl EventReport {
    /// Creates the report of the event of step `index` of a sequence. `None` if the step has none.
    fn new(task: &Task, leg: &Leg, sequence: &Sequence, index: usize) -> Option<Self> {
        let happens = leg.event?;
        let [_, arrival, end] = sequence.times(index);
        let tip = task.arm.tip_at(leg.timed.curve.curve().path().goal());
        let time = (arrival + leg.event_after()?).min(end);
        let (event, pose) = match happens {
            Event::Grasp { .. } => ("grasp", None),
            Event::Release { pose, .. } => {
                let (at, angle) = (pose.translation, pose.rotation.angle());
                ("release", Some(PoseReport { at: [at.x, at.y], angle }))
            }
        };
        Some(Self {
            time,
            event,
            object: task.objects[happens.object()].name.clone(),
            step: leg.step.number,
            cycle: leg.step.cycle,
            tip: [tip.x, tip.y],
            pose,
        })
    }
}

/// An IK solution at a step's target that the arm cannot reach, or is not known to reach.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IkSolutionReport {
    /// The values of both joints, radians or metres.
    pub joints: [f64; 2],
    /// The reason why the arm cannot reach the solution, or is not known to.
    pub reason: String,
    /// Collision boxes that separate the solution from the arm's configuration. `None` if the reason is another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<CheckedProof>,
}

impl From<&RefusedIkSolution> for IkSolutionReport {
    fn from(RefusedIkSolution { ik_solution, reason, proof }: &RefusedIkSolution) -> Self {
        Self { joints: [ik_solution[0], ik_solution[1]], reason: reason.clone(), proof: proof.clone() }
    }
}

/// A step that is infeasible, or not known to be feasible.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailedStepReport {
    /// The step's number in the world file, from 1.
    pub step: usize,
    /// The repetition of the step, from 1.
    pub cycle: usize,
    /// The kind of step.
    pub action: &'static str,
    /// A short description of the step.
    pub description: String,
    /// Position of the step in the world file: file, line and column.
    pub place: String,
    /// The reasons, with the motions that were tried, as in [`FailedStep::reasons`].
    pub reasons: Vec<String>,
    /// The object that is carried in the failing step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<String>,
    /// Joint values of the arm after the earlier steps.
    pub from: [f64; 2],
    /// The IK solutions that were tried from there. Empty if no IK solution within the joint limits reaches the target.
    #[serde(rename = "postures")]
    pub ik_solutions: Vec<IkSolutionReport>,
}

impl FailedStepReport {
    /// Creates the report of the first step of a task that cannot be performed, with the reasons.
    pub fn new(task: &Task, why: &FailedStep) -> Self {
        let FailedStep { step, reasons, scene, from, ik_solutions, .. } = why;
        Self {
            step: step.number,
            cycle: step.cycle,
            action: action_name(&step.action),
            description: step.action.describe(&task.objects),
            place: step.place.clone(),
            reasons: reasons.clone(),
            carried: scene.attachment().map(|payload| payload.name.clone()),
            from: [from[0], from[1]],
            ik_solutions: ik_solutions.iter().map(IkSolutionReport::from).collect(),
        }
    }
}
