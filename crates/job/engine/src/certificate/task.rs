//! Evidence for a task: the motion, the part of it that performs each step, the turns of the wrist with the payload, and
//! the lines that steps follow. The positions of all objects then follow from the world.

use super::line::{motion_pieces, step_line};
use super::{NoCertificate, lines};
use crate::result::StepReport;
use cplan_geometry::can_inset_union;
use cplan_handling::{Action, FollowedLine, Object, Payload, RecordedStep, Recording, Step, Stroke, Task};
use cplan_motion::recorded::turn_profile;
use cplan_motion::{Trajectory, single};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Returns the steps of a planned task as a member of the certificate's JSON. The motion of such a task is part of the
/// result; `trajectory` has its samples.
pub(super) fn steps(task: &Task, steps: &[StepReport], trajectory: &Trajectory) -> (&'static str, String) {
    let step = |step: &StepReport| {
        let turn = step.turn.as_ref().map(|turn| Turn {
            by: turn.to - turn.from,
            seconds: turn.seconds,
            begin: match (turn.before_arrival > 0.0, turn.after_departure > 0.0) {
                (true, _) => Some(step.arrival - turn.before_arrival),
                (_, true) => Some(step.end + turn.after_departure - turn.seconds),
                _ => None,
            },
        });
        let knots = [step.first_sample, step.last_sample].map(Option::unwrap_or_default);
        let overlaps = step.stroke.map(|stroke| Overlaps {
            lowered: stroke.lowered,
            lowering: Some(step.arrival - stroke.before_arrival).filter(|_| stroke.before_arrival > 0.0),
            raised_at: Some(step.end + stroke.after_departure).filter(|_| stroke.after_departure > 0.0),
        });
        let first = step.raising.filter(|raising| raising.after_departure > 0.0);
        let first = first.map(|raising| [raising.lowered, step.begin + raising.after_departure]);
        let mut done = done(task, (step.step, knots), turn, (first, overlaps));
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
        let overlap = step.overlap;
        let overlaps = depth.zip(task.stroke.as_ref()).map(|(depth, stroke)| Overlaps {
            lowered: stroke.lowered(depth),
            lowering: Some(times[knots[1]] - overlap.before_arrival).filter(|_| overlap.before_arrival > 0.0),
            raised_at: Some(times[departure] + overlap.after_departure).filter(|_| overlap.after_departure > 0.0),
        });
        let turn = step.turn.map(|turn| Turn {
            by: turn.to - turn.from,
            seconds: turn.seconds,
            begin: match (turn.overlap.before_arrival > 0.0, turn.overlap.after_departure > 0.0) {
                (true, _) => Some(times[knots[1]] - turn.overlap.before_arrival),
                (_, true) => Some(times[departure] + turn.overlap.after_departure - turn.seconds),
                _ => None,
            },
        });
        let lowered =
            task.start_tool.lowered_by().zip(task.stroke.as_ref()).map(|(depth, stroke)| stroke.lowered(depth));
        let first = lowered.filter(|_| step.raising > 0.0).map(|lowered| [lowered, times[knots[0]] + step.raising]);
        let mut done = done(task, (step.number, knots), turn, (first, overlaps));
        if let Some((line, motion)) = followed_line(task, step.number).zip(recording.part(step.samples.clone())) {
            done["line"] = step_line(&task.arm, line, &motion.pieces());
        }
        done
    };
    ("steps", lines(&steps.iter().enumerate().map(&mut step).collect::<Vec<_>>()))
}

/// Returns the line that a step follows. `None` if the step follows no line.
fn followed_line(task: &Task, number: usize) -> Option<&FollowedLine> {
    match &task.steps().find(|step| step.number == number)?.action {
        Action::Follow(line) => Some(line),
        _ => None,
    }
}

/// The strokes of a step that overlap with motions of the arm.
struct Overlaps {
    /// The joint's value while the tool is lowered, metres.
    lowered: f64,
    /// Time at which the lowering begins, in seconds. `None` if the arm rests while the tool is lowered.
    lowering: Option<f64>,
    /// Time at which the tool is raised, in seconds. `None` if the arm rests until then.
    raised_at: Option<f64>,
}

/// A turn of the wrist.
struct Turn {
    /// Signed angle, radians.
    by: f64,
    /// Duration, in seconds.
    seconds: f64,
    /// Time at which it begins, in seconds. `None` if the arm rests during the whole turn.
    begin: Option<f64>,
}

/// Returns a step's entry. `first` is the joint's value in metres at which the tool begins to rise before the first step,
/// and the time in seconds at which it is raised, if that is during the motion.
fn done(
    task: &Task,
    (step, knots): (usize, [usize; 2]),
    turn: Option<Turn>,
    (first, overlaps): (Option<[f64; 2]>, Option<Overlaps>),
) -> Value {
    let mut done = json!({ "step": step, "knots": knots });
    if let Some(Turn { by, seconds, begin }) = turn {
        done["turn"] = json!(by);
        if let Some((begin, wrist)) = begin.zip(task.wrist) {
            let profile = turn_profile(&wrist, by.abs(), seconds);
            done["turning"] = json!(knots_of(profile, begin, [0.0, by]));
        }
    }
    let Some(stroke) = &task.stroke else { return done };
    let raised = stroke.joint.rest;
    let raising = |lowered: f64, end: f64| {
        let seconds = stroke_knots(stroke, [lowered, raised], 0.0).last().map_or(0.0, |[time, ..]| *time);
        json!(stroke_knots(stroke, [lowered, raised], end - seconds))
    };
    if let Some([lowered, end]) = first {
        done["raising_first"] = raising(lowered, end);
    }
    if let Some(Overlaps { lowered, lowering, raised_at }) = overlaps {
        if let Some(begin) = lowering {
            done["lowering"] = json!(stroke_knots(stroke, [raised, lowered], begin));
        }
        if let Some(end) = raised_at {
            done["raising"] = raising(lowered, end);
        }
    }
    done
}

/// Returns the knots of a stroke between two values of its joint: time in seconds, value, and velocity. Cubics join
/// them.
fn stroke_knots(stroke: &Stroke, [from, to]: [f64; 2], begin: f64) -> Vec<[f64; 3]> {
    knots_of(single((to - from).abs(), &stroke.limits()), begin, [from, to])
}

/// Returns the knots of a motion of one joint between two values: time in seconds, value, and velocity. `phases` are
/// seconds since the beginning, distance and speed at the ends of its phases.
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

/// Checks that the corners of all objects that rest on supports can be moved inwards, as a checker of the certificate
/// must do.
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
