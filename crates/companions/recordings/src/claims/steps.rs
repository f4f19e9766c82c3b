//! Checks a result's claims about the steps of a task.

use super::{FalseClaim, Ledger, TIME_TOLERANCE};
use crate::replay::{GripperEvent, PLACE_TOLERANCE, ReplayedStep, angle_between};
use cplan_geometry::Point;
use cplan_handling::{Action, Claims, EventClaim, PoseClaim, RecordedStep, Recording, Task, TimedScene};
use cplan_model::space::Configuration;
use cplan_motion::recorded::turn_resolution;

/// Returns the false claims of a result about the step with this `index`, given its replay.
pub fn false_step_claims(
    task: &Task,
    recording: &Recording,
    replayed: &ReplayedStep,
    whole: &Claims,
    index: usize,
) -> Vec<FalseClaim> {
    let mut ledger = Ledger::default();
    let ReplayedStep { scene, trajectories, collision_check, .. } = replayed;
    let timed = TimedScene { scene, trajectories };
    let Some(motion) = recording.part(replayed.recorded.samples.clone()) else { return Vec::new() };
    ledger.clearance(whole.clearance, timed, &motion, collision_check);
    ledger.turn(task, replayed, whole.clearance.filter(Option::is_some), "clearance");
    ledger.within = format!("steps[{index}].");
    let Some(claims) = whole.task.steps.get(index) else { return ledger.found };
    let name = |object: Option<usize>| object.map_or("null".to_owned(), |object| task.objects[object].name.clone());
    if let Some(action) = &claims.action {
        let is = match replayed.step.action {
            Action::Pick { .. } => "pick",
            Action::Place { .. } => "place",
            Action::Move(_) => "move",
            Action::Follow(_) => "follow",
        };
        ledger.check_equal("action", action, &is.to_owned());
    }
    let objects = [("object", &claims.object, replayed.object), ("carried", &claims.carried, replayed.carried)];
    for (what, claim, is) in objects {
        if let Some(claim) = claim {
            ledger.check_equal(what, &claim.clone().unwrap_or_else(|| "null".into()), &name(is));
        }
    }
    let [begin, arrival, end] = replayed.times;
    ledger.number("begin", claims.begin, begin, TIME_TOLERANCE);
    ledger.number("arrival", claims.arrival, arrival, TIME_TOLERANCE);
    ledger.number("end", claims.end, end, TIME_TOLERANCE);
    if let Some(path) = &claims.path {
        ledger.path(scene, &motion, path, claims.length, claims.blends);
    }
    ledger.clearance(claims.clearance, timed, &motion, collision_check);
    ledger.turn(task, replayed, claims.clearance.filter(Option::is_some), "clearance");
    ledger.turn(task, replayed, claims.turn_clearance, "turn.clearance");
    ledger.found
}

/// Returns the false claims of a result about the whole task: the times and places of gripper events, the assignment of
/// samples to steps, and general claims. `happened` lists the actual events.
pub fn false_task_claims(
    task: &Task,
    recording: &Recording,
    recorded: &[RecordedStep],
    happened: &[GripperEvent],
    claims: &Claims,
) -> Vec<FalseClaim> {
    let mut ledger = Ledger::default();
    ledger.general(&task.arm, recording, claims);
    ledger.gap("", recording.duration().unwrap_or(0.0), claims.task.lower_bound, claims.task.gap);
    let steps = &claims.task.steps;
    let paths: Option<Vec<&Vec<Configuration>>> = steps.iter().map(|step| step.path.as_ref()).collect();
    if let (Some(path), Some(paths)) = (&claims.path, paths.filter(|paths| !paths.is_empty())) {
        let mut whole: Vec<Configuration> = Vec::new();
        for path in paths {
            let shared = !whole.is_empty() && whole.last() == path.first();
            whole.extend(path.iter().skip(usize::from(shared)));
        }
        if *path != whole {
            ledger.note("path", "not equal to the paths of the steps, one after the other".into());
        }
    }
    let lengths: Option<Vec<f64>> = steps.iter().map(|step| step.length).collect();
    if let Some(lengths) = lengths.filter(|lengths| !lengths.is_empty()) {
        let sum = lengths.iter().fold(0.0, |sum, length| sum + length);
        ledger.number("length", claims.length, sum, super::NUMBER_TOLERANCE * (1.0 + sum));
    }
    if let Some(stated) = &claims.task.step_of_sample {
        // The time before the first motion belongs to the first step.
        let first = |step: usize| match recorded.get(step) {
            _ if step == 0 => 0,
            Some(step) => *step.samples.start(),
            None => recording.positions().len(),
        };
        let is: Vec<usize> =
            (0..recorded.len()).flat_map(|step| std::iter::repeat_n(step, first(step + 1) - first(step))).collect();
        if *stated != is {
            ledger.note("trajectory.step", "wrong: the samples belong to other steps".into());
        }
    }
    if let Some(events) = &claims.task.events {
        ledger.events(task, events, happened);
    }
    ledger.found
}

impl Ledger {
    /// Checks a stated clearance of a turn of the wrist. It must not exceed the proven lower bound by more than the
    /// resolution of the proof.
    fn turn(&mut self, task: &Task, replayed: &ReplayedStep, stated: Option<Option<f64>>, claim: &str) {
        let (Some(stated), Some(Ok(free))) = (stated, replayed.turn.map(|turn| turn.verdict)) else { return };
        let most = free.clearance + turn_resolution(&task.arm, task.workspace.fixed.clearance);
        match stated {
            Some(stated) if stated > most => {
                self.too_large(claim, stated, most, "during the turn of the wrist the object comes");
            }
            None if free.clearance.is_finite() => {
                let why = "stated as null (no obstacle within reach), but the object can meet one";
                self.note(claim, why.into());
            }
            _ => {}
        }
    }

    fn events(&mut self, task: &Task, stated: &[EventClaim], happened: &[GripperEvent]) {
        if stated.len() != happened.len() {
            self.note(
                "events",
                format!("{} events are stated, but the gripper acts {} times", stated.len(), happened.len()),
            );
        }
        for (index, (event, is)) in stated.iter().zip(happened).enumerate() {
            self.within = format!("events[{index}].");
            let word = if is.pose.is_some() { "release" } else { "grasp" };
            self.check_equal("event", &event.event, &word.to_owned());
            self.check_equal("object", &event.object, &task.objects[is.object].name);
            self.check_equal("step", &event.step, &is.step);
            self.check_equal("cycle", &event.cycle, &is.cycle);
            self.number("time", Some(event.time), is.time, TIME_TOLERANCE);
            self.place("tip", event.tip, is.tip);
            match (event.pose, is.pose) {
                (Some(PoseClaim { at, angle }), Some(pose)) => {
                    self.place("pose.at", at, pose.translation);
                    let is = pose.rotation.angle();
                    if angle_between(angle, is) > PLACE_TOLERANCE {
                        self.note("pose.angle", format!("stated as {angle}, but it is {is}"));
                    }
                }
                (Some(_), None) => self.note("pose", "is stated, but no object is released".into()),
                (None, Some(_)) => self.note("pose", "is missing, so the object's position is unknown".into()),
                (None, None) => {}
            }
        }
        self.within.clear();
    }

    fn place(&mut self, claim: &str, [x, y]: [f64; 2], is: Point) {
        if (Point::new(x, y) - is).norm() > PLACE_TOLERANCE {
            self.note(claim, format!("stated as ({x}, {y}) m, but it is ({}, {}) m", is.x, is.y));
        }
    }
}
