//! The stroke that lowers the tool at picks and places.

use super::answer::Event;
use super::least_time::rest_to_rest;
use super::motion_cache::{Refusal, require_unobstructed};
use super::state::{Candidate, State};
use cplan_core::check::certify;
use cplan_core::model::{Grip, Scene};
use cplan_core::space::Path;
use cplan_handling::{Step, Stroke, Task};
use cplan_motion::single;

/// The stroke of the tool: it is lowered, and raised again after the gripper's action.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolStroke {
    /// The joint's value while the tool is raised, ...
    pub raised: f64,
    /// ... and while it is lowered.
    pub lowered: f64,
    /// Seconds for lowering, and for raising, in whole nanoseconds.
    pub seconds: f64,
    /// Proven lower bound on the distance to obstacles during the stroke, metres; infinite if no obstacle is within
    /// reach.
    pub clearance: f64,
}

/// Returns a lower bound on the seconds that the arm stands still for a step with an object, without turns of the
/// wrist: the dwell, and the stroke down and up.
pub(super) fn least_rest(task: &Task, step: &Step, object: Option<usize>) -> f64 {
    let down = |(stroke, object): (&Stroke, usize)| {
        rest_to_rest(stroke.depth(&task.objects[object]).abs(), stroke.velocity, stroke.acceleration)
    };
    step.dwell + 2.0 * task.stroke.as_ref().zip(object).map_or(0.0, down)
}

/// Returns the stroke at a candidate's target. `None` if the tool is not lowered. A placed object must be free where it
/// lies, even without a stroke.
pub(super) fn stroke(task: &Task, from: &State, candidate: &Candidate) -> Result<Option<ToolStroke>, Refusal> {
    let Some(event) = candidate.event else { return Ok(None) };
    let Some(scene) = lowered(task, from, candidate, event) else { return Ok(None) };
    let when = if task.stroke.is_some() { "while the tool is lowered" } else { "lying there" };
    require_unobstructed(&scene, candidate.to, when)?;
    let there = Path::new(vec![candidate.to, candidate.to]);
    let certified = certify(&scene, there, scene.workspace().clearance);
    let certified = certified.map_err(|_| Refusal::new(format!("no proof that it is free {when} was found"), false))?;
    let Some(stroke) = &task.stroke else { return Ok(None) };
    let depth = stroke.depth(&task.objects[event.object()]);
    let motion = single(depth.abs(), stroke.velocity, stroke.acceleration);
    let seconds = motion.last().map_or(0.0, |[seconds, ..]| *seconds);
    let (raised, lowered) = (stroke.joint.rest, stroke.lowered(depth));
    Ok(Some(ToolStroke { raised, lowered, seconds, clearance: certified.clearance() }))
}

/// Returns the scene with the arm, and its payload, while the tool is lowered, if it is. A pick rises with its object,
/// and a place is lowered with it. In the other direction the hand is empty, and meets no more obstacles.
fn lowered(task: &Task, from: &State, candidate: &Candidate, event: Event) -> Option<Scene> {
    let left = from.after_step(task, candidate, candidate.to);
    // The wrist turns after a pick, and before a place.
    let (with, turn) = if left.held.is_some() { (&left, 0) } else { (from, 1) };
    let payload = with.held.clone().map(|mut payload| {
        if let (Grip::Level { angle, .. }, Some(turned)) = (&mut payload.grip, candidate.turn) {
            *angle = turned[turn];
        }
        payload
    });
    let is_placed = matches!(event, Event::Release { .. });
    task.lowered_scene(event.object(), is_placed, &with.poses, payload.as_ref(), with.released)
}
