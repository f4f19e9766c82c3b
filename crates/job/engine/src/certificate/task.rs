//! Evidence for a task: the motion, the part of it for each step, the wrist's turns with the payload, and the lines that steps
//! follow. With the world, these determine the positions of all objects.

use super::line::{motion_pieces, step_line};
use super::{NoCertificate, lines};
use crate::result::StepReport;
use cplan_geometry::can_inset_union;
use cplan_handling::{
    Action, FollowedLine, Object, Payload, RecordedOverlap, RecordedStep, Recording, Step, Stroke, Task,
};
use cplan_motion::recorded::turn_profile;
use cplan_motion::{Trajectory, single};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Returns the steps of a planned task as a member of the certificate's JSON. `trajectory` has the samples of the whole motion.
pub(super) fn steps(task: &Task, steps: &[StepReport], trajectory: &Trajectory) -> (&'static str, String) {
    let step = |step: &StepReport| {
        let turn = step.turn.as_ref();
        let knots = [step.first_sample, step.last_sample].map(Option::unwrap_or_default);
        let raising = step.raising.filter(|raising| raising.after_departure > 0.0);
        let mut done = DoneStep {
            number: step.step,
            knots,
            ends: [step.arrival, step.end],
            turn: turn.map(|turn| (turn.to - turn.from, turn.seconds, [turn.before_arrival, turn.after_departure])),
            stroke: step.stroke.map(|stroke| (stroke.lowered, [stroke.before_arrival, stroke.after_departure])),
            first: raising.map(|raising| [raising.lowered, step.begin + raising.after_departure]),
        }
        .entry(task);
        if let Some(line) = followed_line(task, step.step) {
            done["line"] = step_line(&task.arm, line, &motion_pieces(trajectory, knots));
        }
        done
    };
    ("steps", lines(&steps.iter().map(step).collect::<Vec<_>>()))
}

/// Returns the steps of a recorded task as a member of the certificate's JSON. `times` are those of the samples of the
/// recording, in seconds.
pub(super) fn steps_of_recording(
    task: &Task,
    steps: &[RecordedStep],
    (recording, times): (&Recording, &[f64]),
) -> (&'static str, String) {
    let mut held = None;
    let mut step = |(index, step): (usize, &RecordedStep)| {
        let knots = [*step.samples.start(), *step.samples.end()];
        let asked = task.steps().find(|asked| asked.number == step.number);
        held = asked.and_then(|asked| asked.action.picked()).or(held);
        let depth = match held {
            Some(object) => {
                let elevation = asked.map_or(0.0, |asked| asked.elevation);
                task.stroke.as_ref().map(|stroke| stroke.depth(&task.objects[object]) - elevation)
            }
            None => asked.and_then(|asked| asked.tool.lowered_by()),
        };
        let departure = steps.get(index + 1).map_or(times.len() - 1, |next| *next.samples.start());
        let seconds = |overlap: RecordedOverlap| [overlap.before_arrival, overlap.after_departure];
        let lowered = |depth: Option<f64>| task.stroke.as_ref().zip(depth).map(|(stroke, depth)| stroke.lowered(depth));
        let first = lowered(task.start_tool.lowered_by()).filter(|_| step.raising > 0.0);
        let mut done = DoneStep {
            number: step.number,
            knots,
            ends: [times[knots[1]], times[departure]],
            turn: step.turn.map(|turn| (turn.to - turn.from, turn.seconds, seconds(turn.overlap))),
            stroke: lowered(depth).map(|lowered| (lowered, seconds(step.overlap))),
            first: first.map(|lowered| [lowered, times[knots[0]] + step.raising]),
        }
        .entry(task);
        if let Some((line, motion)) = followed_line(task, step.number).zip(recording.part(step.samples.clone())) {
            done["line"] = step_line(&task.arm, line, &motion.pieces());
        }
        done
    };
    ("steps", lines(&steps.iter().enumerate().map(&mut step).collect::<Vec<_>>()))
}

/// Returns the line that a step follows, if it follows one.
fn followed_line(task: &Task, number: usize) -> Option<&FollowedLine> {
    match &task.steps().find(|step| step.number == number)?.action {
        Action::Follow(line) => Some(line),
        _ => None,
    }
}

/// An executed step. An overlap with motions of the arm has the seconds before its arrival and after its departure.
struct DoneStep {
    number: usize,
    /// First and last sample of the motion.
    knots: [usize; 2],
    /// Times of arrival and departure of the arm, in seconds.
    ends: [f64; 2],
    /// The turn of the wrist: its signed angle in radians, its duration in seconds, and its overlaps.
    turn: Option<(f64, f64, [f64; 2])>,
    /// The joint's value while the tool is lowered, in metres, and the overlaps of the strokes.
    stroke: Option<(f64, [f64; 2])>,
    /// If the tool rises before the first step: the joint's value from which it rises, in metres, and the time at which it is
    /// raised, in seconds.
    first: Option<[f64; 2]>,
}

impl DoneStep {
    /// Returns the step's entry.
    fn entry(&self, task: &Task) -> Value {
        let [arrival, departure] = self.ends;
        let mut done = json!({ "step": self.number, "knots": self.knots });
        if let Some((by, seconds, [before, after])) = self.turn {
            done["turn"] = json!(by);
            let late = (after > 0.0).then_some(departure + after - seconds);
            let begin = if before > 0.0 { Some(arrival - before) } else { late };
            if let Some((begin, wrist)) = begin.zip(task.wrist) {
                done["turning"] = json!(knots_of(turn_profile(&wrist, by.abs(), seconds), begin, [0.0, by]));
            }
        }
        let Some(stroke) = &task.stroke else { return done };
        let raised = stroke.joint.rest;
        let raising = |lowered: f64, end: f64| {
            let seconds = stroke_knots(stroke, [lowered, raised], 0.0).last().map_or(0.0, |[time, ..]| *time);
            json!(stroke_knots(stroke, [lowered, raised], end - seconds))
        };
        if let Some([lowered, end]) = self.first {
            done["raising_first"] = raising(lowered, end);
        }
        let Some((lowered, [before, after])) = self.stroke else { return done };
        if before > 0.0 {
            done["lowering"] = json!(stroke_knots(stroke, [raised, lowered], arrival - before));
        }
        if after > 0.0 {
            done["raising"] = raising(lowered, departure + after);
        }
        done
    }
}

/// Returns the knots of a stroke between two values of its joint: time in seconds, value, and velocity. Cubics join
/// them.
fn stroke_knots(stroke: &Stroke, [from, to]: [f64; 2], begin: f64) -> Vec<[f64; 3]> {
    knots_of(single((to - from).abs(), &stroke.limits()), begin, [from, to])
}

/// Returns the knots of a motion of one joint between two values: time in seconds, value, and velocity. `phases` has seconds
/// since the beginning, distance and speed at the ends of the phases.
fn knots_of(phases: Vec<[f64; 3]>, begin: f64, [from, to]: [f64; 2]) -> Vec<[f64; 3]> {
    let sign = (to - from).signum();
    let mut knots: Vec<[f64; 3]> = phases
        .into_iter()
        .map(|[time, distance, speed]| [begin + time, from + sign * distance, sign * speed + 0.0])
        .collect();
    // The last value is exact.
    knots.last_mut().into_iter().for_each(|last| last[1] = to);
    knots
}

/// Returns the indices of the objects that rest on supports when a step picks or places them.
fn pressed_objects(task: &Task) -> BTreeSet<usize> {
    let mut picked = None;
    let rests = |step: &Step| {
        picked = step.action.picked().or(picked);
        let (Action::Pick { supports, .. } | Action::Place { supports, .. }) = &step.action else { return None };
        picked.filter(|_| !supports.is_empty())
    };
    task.steps().filter_map(rests).collect()
}

/// Checks that the corners of all objects on supports can be moved inwards, which a checker of the certificate does.
///
/// # Errors
/// [`NoCertificate::Outline`].
pub(super) fn checkable(task: &Task) -> Result<(), NoCertificate> {
    let allowance = Payload::penetration_allowance(&task.arm);
    for object in pressed_objects(task) {
        let Object { name, pieces, .. } = &task.objects[object];
        if !can_inset_union(pieces, allowance) {
            return Err(NoCertificate::Outline(name.clone()));
        }
    }
    Ok(())
}
