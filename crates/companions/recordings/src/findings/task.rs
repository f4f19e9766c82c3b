//! Findings about a task, step by step.

use super::motion::{CollisionFinding, ExceededLimits, Judgement, LimitFinding, MotionFindings, limits, verdict};
use crate::claims::{false_step_claims, false_task_claims};
use crate::replay::{OrderDeviation, Replay, ReplayedStep, ReplayedTurn, StepTool};
use cplan_handling::{Claims, RecordedStep, Recording, Task};
use cplan_model::Scene;
use cplan_robot::AssumedLimits;
use serde::Serialize;

/// Findings about a step.
#[derive(Debug, Clone, Serialize)]
pub struct StepFinding {
    /// The step's number in the world file, from 1.
    pub step: usize,
    /// The repetition of the step, from 1.
    pub cycle: usize,
    /// A short description of the step.
    pub action: String,
    /// The object that is picked or placed.
    pub object: Option<String>,
    /// The object that is carried during the motion.
    pub carried: Option<String>,
    /// The verdict on the step.
    pub verdict: Judgement,
    /// Index of the first sample of the step's motion, from 0.
    pub first_sample: usize,
    /// Index of the last sample of the step's motion.
    pub last_sample: usize,
    /// Duration of the step's motion, in seconds.
    pub seconds: f64,
    /// Collisions and clearance along the step's motion.
    #[serde(flatten)]
    pub collisions: CollisionFinding,
    /// The turn of the wrist after a pick or before a place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn: Option<TurnFinding>,
    /// Violated limits, each listed once.
    pub limits_broken: Vec<LimitFinding>,
    /// Exceeded limits that the files do not state. They do not affect the verdict.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub assumed_exceeded: Vec<LimitFinding>,
    /// Differences from the requested step.
    pub faults: Vec<String>,
}

/// A turn of the wrist.
#[derive(Debug, Clone, Serialize)]
pub struct TurnFinding {
    /// Orientation of the object at the beginning, radians.
    pub from: f64,
    /// Orientation of the object at the end, radians.
    pub to: f64,
    /// Duration of the turn, in seconds.
    pub seconds: f64,
    /// Proven lower bound on the distance between object and obstacles, in metres. Only for free turns with obstacles
    /// within reach.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// The first contact of a turn that is not free.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<TurnContactFinding>,
}

/// A contact of an object while it is turned.
#[derive(Debug, Clone, Serialize)]
pub struct TurnContactFinding {
    /// Orientation of the object at the contact, radians.
    pub angle: f64,
    /// Name of the obstacle.
    pub obstacle: String,
}

impl StepFinding {
    fn new(task: &Task, replayed: &ReplayedStep, assumed: &AssumedLimits) -> Self {
        let ReplayedStep { step, recorded, scene, collision_check, broken, faults, .. } = replayed;
        let name = |object: usize| task.objects[object].name.clone();
        let turn = replayed.turn.map(|turn| TurnFinding::new(scene, &turn));
        let of_turn = match &turn {
            Some(TurnFinding { contact: Some(_), .. }) => Judgement::Collision,
            _ => Judgement::Free,
        };
        let joints = &scene.arm().joints;
        let broken = ExceededLimits::new(joints, broken, assumed);
        let of_faults = if faults.is_empty() { Judgement::Free } else { Judgement::Task };
        Self {
            step: step.number,
            cycle: step.cycle,
            action: step.action.describe(&task.objects),
            object: replayed.object.map(name),
            carried: replayed.carried.map(name),
            verdict: verdict(collision_check, &broken.given).max(of_turn).max(of_faults),
            first_sample: *recorded.samples.start(),
            last_sample: *recorded.samples.end(),
            seconds: replayed.seconds,
            collisions: CollisionFinding::new(scene, collision_check, true),
            turn,
            limits_broken: limits(joints, &broken.given, true),
            assumed_exceeded: limits(joints, &broken.assumed, true),
            faults: faults.iter().map(ToString::to_string).collect(),
        }
    }

    /// Returns a name for the step.
    pub fn name(&self) -> String {
        format!("step {} (cycle {})", self.step, self.cycle)
    }

    /// Returns a proven lower bound on the distance to obstacles during the step's motion and turn, in metres. `None`
    /// if no obstacle is within reach.
    pub fn clearance(&self) -> Option<f64> {
        let turn = self.turn.as_ref().and_then(|turn| turn.clearance);
        turn.into_iter().chain(self.collisions.clearance).reduce(f64::min)
    }
}

impl TurnFinding {
    fn new(scene: &Scene, ReplayedTurn { turn, verdict }: &ReplayedTurn) -> Self {
        let contact = verdict.err().map(|contact| TurnContactFinding {
            angle: contact.angle,
            obstacle: scene.obstacle(contact.obstacle).name.clone(),
        });
        let clearance = verdict.ok().map(|free| free.clearance).filter(|clearance| clearance.is_finite());
        Self { from: turn.from, to: turn.to, seconds: turn.seconds, clearance, contact }
    }
}

/// Judges all steps. The collision finding of the whole task is that of one step: the first that collides, or else the
/// first that is undecided, or else the one with the least clearance. Also returns the motion of the tool in each step.
pub(crate) fn judge_steps(
    task: &Task,
    scene: &Scene,
    assumed: &AssumedLimits,
    (recording, recorded): (&Recording, &[RecordedStep]),
    mut replay: Replay,
    claims: &Claims,
    notes: Vec<String>,
) -> (MotionFindings, Vec<StepTool>) {
    let (mut happened, mut false_claims, mut tools) = (Vec::new(), Vec::new(), Vec::new());
    let mut steps = Vec::new();
    for (index, step) in replay.by_ref().enumerate() {
        false_claims.extend(false_step_claims(task, recording, &step, claims, index));
        happened.extend(step.event.clone());
        tools.push(step.tool);
        steps.push(StepFinding::new(task, &step, assumed));
    }
    // If the recording departs from the task, statements about the whole task describe something else.
    if replay.departure().is_none() {
        false_claims.extend(false_task_claims(task, recording, recorded, &happened, claims));
    }
    let departure = replay.departure().map(OrderDeviation::to_string);
    let of_departure = if departure.is_some() { Judgement::Task } else { Judgement::Free };
    let worst = steps.iter().map(|step| step.verdict).max().unwrap_or(Judgement::Free);
    let of_step = |step: &StepFinding| {
        let name = step.name();
        step.faults.iter().map(move |fault| format!("{name}: {fault}")).collect::<Vec<_>>()
    };
    let faults = steps.iter().flat_map(of_step).chain(departure).collect();
    let findings = MotionFindings {
        verdict: worst.max(of_departure),
        collisions: collisions(&steps),
        limits_broken: steps.iter().flat_map(|step| step.limits_broken.iter().cloned()).collect(),
        assumed_exceeded: steps.iter().flat_map(|step| step.assumed_exceeded.iter().cloned()).collect(),
        faults,
        steps: Some(steps),
        notes,
        ..MotionFindings::of_nothing(scene, recording)
    };
    (findings.with_faults(Judgement::Claims, false_claims), tools)
}

/// Selects the collision finding of the whole task from those of its steps.
fn collisions(steps: &[StepFinding]) -> CollisionFinding {
    let undecided = steps.iter().position(|step| step.collisions.undecided.is_some());
    let turn_hits = |step: &StepFinding| step.turn.as_ref().is_some_and(|turn| turn.contact.is_some());
    if let Some(hit) = steps.iter().position(|step| step.collisions.first_contact.is_some()) {
        let proven = undecided.is_none_or(|open| open > hit) && !steps[..hit].iter().any(turn_hits);
        let collisions = steps[hit].collisions.clone();
        return CollisionFinding { free_until: collisions.free_until.filter(|_| proven), ..collisions };
    }
    if let Some(open) = undecided {
        return steps[open].collisions.clone();
    }
    if steps.iter().any(turn_hits) {
        return CollisionFinding::default();
    }
    let clearance = steps.iter().filter_map(StepFinding::clearance).reduce(f64::min);
    let depth =
        |step: &&StepFinding| step.collisions.nearest.as_ref().map_or(f64::NEG_INFINITY, |nearest| nearest.depth);
    let nearest = steps.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
    CollisionFinding {
        clearance,
        nearest: nearest.and_then(|step| step.collisions.nearest.clone()),
        ..CollisionFinding::default()
    }
}
