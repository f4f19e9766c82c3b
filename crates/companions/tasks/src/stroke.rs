//! The stroke that lowers the tool at picks and places.

use super::least_time::least_of_tool;
use super::refusal::{Refusal, require_unobstructed};
use super::state::{Candidate, State};
use cplan_handling::{Item, Step, Stroke, Task};
use cplan_judge::certify;
use cplan_legs::{Event, StandstillScene, ToolStroke};
use cplan_model::space::{Configuration, Path};
use cplan_model::{Grip, Scene};
use cplan_motion::single;

/// The time of a stroke, as a phrase for messages.
const WHILE_LOWERED: &str = "while the tool is lowered";

/// Returns a lower bound, in seconds, on the dwell of a step and its stroke: down and up for its object, if it has one, or
/// only down at the end of a move. Turns of the wrist are not included. A part of the stroke may overlap with motions: see
/// [`most_overlap`].
pub(super) fn least_rest(task: &Task, step: &Step, object: Option<usize>) -> f64 {
    let strokes = if object.is_some() { 2.0 } else { 1.0 };
    step.dwell + strokes * stroke_depth(task, step, object).map_or(0.0, |depth| least_stroke(task, depth))
}

/// Returns a lower bound, in seconds, on the duration of a stroke down to a depth, or up from there.
pub(super) fn least_stroke(task: &Task, depth: f64) -> f64 {
    task.stroke.as_ref().map_or(0.0, |stroke| least_of_tool(depth.abs(), &stroke.limits()))
}

/// Returns a lower bound on the time for raising the tool at the start, in seconds. `seconds` is the duration of a stroke
/// over a length in metres.
///
/// If the first step's depth is on the other side of the raised position, one stroke leads through that position without a
/// stop, unless the world demands one. Then the first step's own stroke counts in full, and the raising only for the rest.
pub(super) fn least_raising_at_start(task: &Task, seconds: impl Fn(f64) -> f64) -> f64 {
    let Some(from) = task.start_tool.lowered_by() else { return 0.0 };
    let may_pass = task.stroke.as_ref().is_some_and(|stroke| stroke.arch.is_some());
    let raising = |step: &Step| match stroke_depth(task, step, step.action.picked()) {
        Some(to) if may_pass && from * to < 0.0 => seconds((from - to).abs()) - seconds(to.abs()),
        _ => seconds(from.abs()),
    };
    let first = task.items.iter().find_map(|item| match item {
        Item::Step(step) => Some(raising(step)),
        Item::AnyOrder(pairs) => Some(pairs.iter().map(|[pick, _]| raising(pick)).fold(f64::INFINITY, f64::min)),
        Item::Renew(_) => None,
    });
    first.unwrap_or_else(|| seconds(from.abs()))
}

/// Returns the depth in metres to which a step lowers the tool for its object, or at the end of a move.
pub(super) fn stroke_depth(task: &Task, step: &Step, object: Option<usize>) -> Option<f64> {
    let of_object =
        |object: usize| task.stroke.as_ref().map(|stroke| stroke.depth(&task.objects[object]) - step.elevation);
    object.map_or(step.tool.lowered_by(), of_object)
}

/// Returns the time, in seconds, by which a stroke to a depth may overlap with a motion at most: its whole duration down
/// or up, or zero if the arm is at rest during strokes.
pub(super) fn most_overlap(task: &Task, depth: Option<f64>) -> f64 {
    let stroke = task.stroke.as_ref().filter(|stroke| stroke.arch.is_some());
    stroke.zip(depth).map_or(0.0, |(stroke, depth)| stroke_seconds(stroke, depth))
}

/// Returns the time, in seconds, in which the tool is lowered by a depth, or raised again.
pub(super) fn stroke_seconds(stroke: &Stroke, depth: f64) -> f64 {
    let motion = single(depth.abs(), &stroke.limits());
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
    let Some(standing) = stroke_scene(task, from, candidate) else {
        return if candidate.depth(task).is_some() && task.stroke.is_none() { Err(no_tool()) } else { Ok(None) };
    };
    let clearance = clearance_at(&standing, candidate.to)?;
    Ok(task.stroke.as_ref().zip(candidate.depth(task)).map(|(stroke, depth)| tool_stroke(stroke, depth, clearance)))
}

/// Returns the scene while the tool is lowered at a candidate's target. `None` if it is not lowered.
pub(super) fn stroke_scene(task: &Task, from: &State, candidate: &Candidate) -> Option<StandstillScene> {
    let Some(event) = candidate.event else {
        let after = from.after_step(task, candidate, candidate.to);
        return empty_stroke_scene(task, &after, candidate.depth(task)?);
    };
    let when = if task.stroke.is_some() { WHILE_LOWERED } else { "where the object is put down" };
    lowered(task, from, candidate, event).map(|scene| StandstillScene { when, scene })
}

fn tool_stroke(stroke: &Stroke, depth: f64, clearance: f64) -> ToolStroke {
    let (raised, lowered) = (stroke.joint.rest, stroke.lowered(depth));
    ToolStroke { raised, lowered, seconds: stroke_seconds(stroke, depth), clearance }
}

/// Returns the stroke with which the motion from a state begins, because the tool is lowered there. `None` if it is raised.
pub(super) fn raising_first(task: &Task, from: &State) -> Result<Option<ToolStroke>, Refusal> {
    let Some(depth) = from.rising.filter(|_| from.is_lowered) else { return Ok(None) };
    let (standing, stroke) = raising_scene(task, from).zip(task.stroke.as_ref()).ok_or_else(no_tool)?;
    Ok(Some(tool_stroke(stroke, depth, clearance_at(&standing, from.q)?)))
}

/// Returns the scene while the tool is raised before the motion from a state. `None` if it is already raised.
pub(super) fn raising_scene(task: &Task, from: &State) -> Option<StandstillScene> {
    empty_stroke_scene(task, from, from.rising.filter(|_| from.is_lowered)?)
}

/// Returns the scene of a stroke of the empty tool in a state, down to a depth or up from there.
fn empty_stroke_scene(task: &Task, state: &State, depth: f64) -> Option<StandstillScene> {
    let scene = task.empty_lowered_scene(depth, &state.poses, state.released)?;
    Some(StandstillScene { when: WHILE_LOWERED, scene })
}

fn no_tool() -> Refusal {
    Refusal::new("the arm has no joint that lowers the tool", false)
}

/// Returns a proven lower bound, in metres, on the distance to obstacles in a configuration in which the arm stands still.
fn clearance_at(StandstillScene { when, scene }: &StandstillScene, q: Configuration) -> Result<f64, Refusal> {
    require_unobstructed(scene, q, when)?;
    let certified = certify(scene, Path::new(vec![q, q]));
    let certified =
        certified.map_err(|_| Refusal::new(format!("not proven to be free of collisions {when}"), false))?;
    Ok(certified.clearance())
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
    let lowered = (event.object(), candidate.step.elevation);
    task.lowered_scene(lowered, is_placed, &with.poses, payload.as_ref(), with.released)
}
