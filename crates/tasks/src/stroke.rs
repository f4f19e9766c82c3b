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

/// The stroke of the tool: the tool is lowered, the gripper acts, and the tool is raised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolStroke {
    /// The joint's value while the tool is raised, in metres.
    pub raised: f64,
    /// The joint's value while the tool is lowered, in metres.
    pub lowered: f64,
    /// Time for lowering the tool, in seconds, rounded to whole nanoseconds. Raising it takes as long.
    pub seconds: f64,
    /// Proven lower bound on the distance to obstacles during the stroke, in metres. Infinite if no obstacle is within
    /// reach.
    pub clearance: f64,
}

/// Returns a lower bound, in seconds, on the dwell of a step and the stroke for its object, if it has one. Turns of the
/// wrist are not included. A part of the stroke may overlap with motions: see [`overlapped`].
pub(super) fn least_rest(task: &Task, step: &Step, object: Option<usize>) -> f64 {
    let down = |(stroke, object): (&Stroke, usize)| {
        rest_to_rest(stroke.depth(&task.objects[object]).abs(), stroke.velocity, stroke.acceleration)
    };
    step.dwell + 2.0 * task.stroke.as_ref().zip(object).map_or(0.0, down)
}

/// Returns the time, in seconds, by which the stroke to an object may overlap with a motion at most: its whole duration
/// down or up, or zero if the arm is at rest during strokes.
pub(super) fn most_overlap(task: &Task, object: Option<usize>) -> f64 {
    let stroke = task.stroke.as_ref().filter(|stroke| stroke.arch.is_some());
    stroke.zip(object).map_or(0.0, |(stroke, object)| stroke_seconds(stroke, stroke.depth(&task.objects[object])))
}

/// Returns the time, in seconds, in which the tool is lowered by a depth, or raised again.
pub(super) fn stroke_seconds(stroke: &Stroke, depth: f64) -> f64 {
    let motion = single(depth.abs(), stroke.velocity, stroke.acceleration);
    motion.last().map_or(0.0, |[seconds, ..]| *seconds)
}

/// Returns a lower bound, in seconds, on the part of a motion that overlaps with no stroke. `overlaps` are the longest
/// overlaps at its beginning and its end. Between them the tool is raised completely.
pub(super) fn least_without_strokes(travel: f64, overlaps: [f64; 2]) -> f64 {
    (travel - overlaps[0] - overlaps[1]).max(0.0)
}

/// Returns the stroke at a candidate's target. `None` if the tool is not lowered. Without a stroke, still checks that
/// an object is free at the place where it is put.
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
    let seconds = stroke_seconds(stroke, depth);
    let (raised, lowered) = (stroke.joint.rest, stroke.lowered(depth));
    Ok(Some(ToolStroke { raised, lowered, seconds, clearance: certified.clearance() }))
}

/// Returns the scene with the lowered tool and its payload. `None` if the tool is not lowered. After a pick the tool
/// rises with the object, and before a place step it goes down with the object. In the other direction the tool is
/// empty, so it meets no further obstacles.
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
