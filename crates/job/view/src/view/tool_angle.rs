//! The strip of the tool's angle along lines against time.

use super::numbers::{Chain, number};
use crate::{Object, object};
use cplan_handling::{Task, WristJoint};
use cplan_legs::Leg;
use cplan_model::Arm;
use cplan_model::space::Configuration;
use cplan_motion::Trajectory;

/// Number of points of a line's strip, in addition to those at which the tool turns at rest.
const POINTS: f64 = 1000.0;

/// Returns the angle of the tool against time, in a motion along a line, for pages: times in seconds and angles in degrees from
/// the x axis, for all lines together and for each line. `None` if no wrist turns the tool.
pub fn of_line(arm: &Arm, joint: &WristJoint, trajectory: &Trajectory) -> Option<Object> {
    of_lines(arm, joint, trajectory.duration(), [(0.0, trajectory)].into_iter())
}

/// Returns the same for a task. `None` if no wrist turns the tool along a line.
pub fn of_task(task: &Task, legs: &[Leg]) -> Option<Object> {
    let joint = task.wrist?.joint?;
    let motions = legs.iter().map(|leg| (leg.begin, &leg.timed.trajectory));
    of_lines(&task.arm, &joint, legs.last()?.end(), motions)
}

fn of_lines<'a>(
    arm: &Arm,
    joint: &WristJoint,
    duration: f64,
    motions: impl Iterator<Item = (f64, &'a Trajectory)>,
) -> Option<Object> {
    let turning = motions.filter(|(_, trajectory)| !trajectory.wrist.is_empty());
    let lines: Vec<Chain> = turning.map(|(begin, trajectory)| angles(arm, joint, begin, trajectory)).collect();
    let motion = Chain(lines.iter().flat_map(|line| line.0.iter().copied()).collect());
    (!lines.is_empty()).then(|| object!("duration": number(duration), "motion": motion, "lines": lines))
}

/// Returns times, and angles in degrees, at samples that are about evenly spaced in time, and at all samples at rest.
fn angles(arm: &Arm, joint: &WristJoint, begin: f64, trajectory: &Trajectory) -> Chain {
    let (time, q) = (&trajectory.time, &trajectory.position);
    let step = trajectory.duration() / POINTS;
    let mut last = f64::NEG_INFINITY;
    let is_shown = |k: &usize| {
        let rests = (k.checked_sub(1).is_some_and(|before| q[before] == q[*k])) || q.get(k + 1) == Some(&q[*k]);
        let shown = rests || *k + 1 == time.len() || time[*k] - last >= step;
        last = if shown { time[*k] } else { last };
        shown
    };
    let point = |k: usize| {
        let angle = joint.tool_angle(arm, q[k], trajectory.wrist[k][0]).to_degrees();
        Configuration::new(((begin + time[k]) * 1e4).round() / 1e4, (angle * 1e2).round() / 1e2)
    };
    Chain((0..time.len()).filter(is_shown).map(point).collect())
}
