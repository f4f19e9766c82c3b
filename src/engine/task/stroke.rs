//! The stroke that lowers the tool at picks and places.

use super::least_time::rest_to_rest;
use super::legs::{Refusal, unobstructed};
use super::state::{Candidate, State};
use crate::check::certify;
use crate::model::{Grip, Scene, Step, Stroke, Task};
use crate::motion::single;
use crate::space::Path;

/// The tool goes down, and up again after the gripper's work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolStroke {
    /// The joint's value while the tool is raised, ...
    pub raised: f64,
    /// ... and while it is lowered.
    pub lowered: f64,
    /// Seconds that either way takes, whole nanoseconds.
    pub seconds: f64,
    /// Proven lower bound on the distance to obstacles in it, metres; infinite if nothing can be hit.
    pub clearance: f64,
}

/// A lower bound on the seconds that the arm stands still for a step with an object, but for turns of the wrist: the dwell, and
/// down and up.
pub(super) fn least_rest(task: &Task, step: &Step, object: Option<usize>) -> f64 {
    let down = |(stroke, object): (&Stroke, usize)| {
        rest_to_rest(stroke.depth(&task.objects[object]).abs(), stroke.velocity, stroke.acceleration)
    };
    step.dwell + 2.0 * task.stroke.as_ref().zip(object).map_or(0.0, down)
}

/// The stroke at a candidate's target; none where the tool is not lowered.
pub(super) fn stroke(task: &Task, from: &State, candidate: &Candidate) -> Result<Option<ToolStroke>, Refusal> {
    let (Some(stroke), Some(event)) = (&task.stroke, candidate.event) else { return Ok(None) };
    let depth = stroke.depth(&task.objects[event.object()]);
    if depth == 0.0 {
        return Ok(None);
    }
    let scene = lowered(task, from, candidate, stroke, depth);
    unobstructed(&scene, candidate.to, "while the tool is lowered")?;
    let there = Path::new(vec![candidate.to, candidate.to]);
    let certified = certify(&scene, there, scene.workspace().clearance);
    let certified =
        certified.map_err(|_| Refusal::new("the tool cannot be shown to be free while it is lowered", false))?;
    let way = single(depth.abs(), stroke.velocity, stroke.acceleration);
    let seconds = way.last().map_or(0.0, |[seconds, ..]| *seconds);
    let (raised, lowered) = (stroke.joint.rest, stroke.lowered(depth));
    Ok(Some(ToolStroke { raised, lowered, seconds, clearance: certified.clearance() }))
}

/// The scene with the tool, and what it holds, at all heights of its stroke. A pick rises with its object, a place goes down
/// with it: the other way the hand is empty, and meets no more.
fn lowered(task: &Task, from: &State, candidate: &Candidate, stroke: &Stroke, depth: f64) -> Scene {
    let after = from.after(task, candidate, candidate.to);
    // A wrist turns after a pick, and before a place.
    let (with, turn) = if after.held.is_some() { (&after, 0) } else { (from, 1) };
    let payload = with.held.as_ref().map(|held| {
        let mut payload = held.payload(task);
        payload.heights = task.objects[held.object].handled_heights();
        if let (Grip::Level { angle, .. }, Some(turned)) = (&mut payload.grip, candidate.turn) {
            *angle = turned[turn];
        }
        payload
    });
    let allowed_contacts: Vec<usize> = with.released.iter().map(|&object| task.obstacle_number(object)).collect();
    Scene::handling_trusted(stroke.swept(&task.arm, depth), task.obstacles(&with.poses), payload, &allowed_contacts)
}
