//! Evidence for a motion: the curve that programs execute when they read the file. A checker needs nothing else.

use super::task::{checkable, steps_of_recording};
use super::{Member, NoCertificate, inward, lines, member, robot_members, tip_and_clearance, written};
use cplan_handling::{Interpolation, RecordedStep, Recording, Task};
use cplan_model::space::{Configuration, Topology};
use cplan_model::{Arm, Goal, Scene};
use cplan_motion::Trajectory;
use cplan_world::{Digests, Overrides};
use serde_json::{Value, json};

/// Returns the evidence of a planned motion: its samples, and the interpolations between them. Readers of tables and ROS 2
/// messages join samples by cubics; the JSON defines quartics. With limits on jerk, the JSON defines the same cubics, and readers
/// may also use quintics, which `has_quintics` includes.
pub(super) fn evidence(arm: &Arm, trajectory: &Trajectory, has_quintics: bool) -> Member {
    let is_smooth = arm.limits_jerks();
    let Trajectory { time, position, velocity, acceleration, torque: _, wrist: _ } = trajectory;
    let position = &written_inward(&arm.topology(), position);
    match (is_smooth, has_quintics) {
        (true, false) => motion_member(&["cubic"], time, &[position, velocity]),
        (true, true) => motion_member(&["cubic", "quintic"], time, &[position, velocity, acceleration]),
        (false, _) => motion_member(&["cubic", "quartic"], time, &[position, velocity, acceleration]),
    }
}

/// Returns the certificate of a recorded motion, whose samples are joined as in the recording's format. It claims that the motion
/// leads from the start of the world, or of `asked`, to the goal. If `ends` has no start or goal, the motion's own start or end
/// replaces it. A recorded task leads from the start through all its steps. The certificate refers to `files`.
///
/// # Errors
/// [`NoCertificate::Untimed`] and [`NoCertificate::Outline`].
pub fn recorded(
    scene: &Scene,
    recording: &Recording,
    steps: Option<(&Task, &[RecordedStep])>,
    (asked, files): (&Overrides, &Digests),
    ends: [Option<Goal>; 2],
) -> Result<String, NoCertificate> {
    if recording.times().is_none() && !scene.loose_obstacles().is_empty() {
        return Err(NoCertificate::Untimed);
    }
    steps.map_or(Ok(()), |(task, _)| checkable(task))?;
    let topology = &scene.arm().topology();
    let q = recording.positions();
    let own = [q[0], q[q.len() - 1]];
    let mut members = robot_members(Some(files), scene.arm());
    for (k, (end, is_asked)) in ends.iter().zip([asked.start.is_some(), asked.goal.is_some()]).enumerate() {
        let name = ["start", "goal"][k];
        match end {
            Some(Goal::Joints(q)) if is_asked => members.push(member(name, inward(topology, *q))),
            Some(_) => {}
            None if k == 1 && steps.is_some() => {}
            None => members.push(member(name, inward(topology, own[k]))),
        }
    }
    members.extend(tip_and_clearance(asked));
    let counted: Vec<f64> = (0..q.len()).map(|k| k as f64).collect();
    let rows = |values: &[Configuration]| values.iter().map(|&q| q.into()).collect::<Vec<[f64; 2]>>();
    let positions = written_inward(topology, &rows(q));
    let [velocities, accelerations] =
        [recording.velocities(), recording.accelerations()].map(|values| values.map(rows).unwrap_or_default());
    let (reading, columns) = match recording.interpolation() {
        Interpolation::Linear => ("linear", 1),
        Interpolation::Cubic => ("cubic", 2),
        Interpolation::Quartic => ("quartic", 3),
        Interpolation::Quintic => ("quintic", 3),
    };
    let all = [&positions, &velocities, &accelerations];
    let motion = motion_member(&[reading], recording.times().unwrap_or(&counted), &all[..columns]);
    let times = recording.times().unwrap_or(&counted);
    let steps = steps.map(|(task, steps)| steps_of_recording(task, steps, (recording, times)));
    Ok(written("found", members.into_iter().chain([motion]).chain(steps)))
}

/// Returns the values of the joints for a certificate, moved inwards at limits.
pub(super) fn written_inward(topology: &Topology, positions: &[[f64; 2]]) -> Vec<[f64; 2]> {
    positions.iter().map(|&q| inward(topology, q.into()).into()).collect()
}

/// Returns the motion as a member of the certificate's JSON: knots, each with a time and the values of the columns at that time.
/// `readings` are the names of the interpolations.
pub(super) fn motion_member(readings: &[&str], times: &[f64], columns: &[&Vec<[f64; 2]>]) -> Member {
    let knot =
        |k: usize| json!([times[k]].into_iter().chain(columns.iter().flat_map(|rows| rows[k])).collect::<Vec<f64>>());
    let knots: Vec<Value> = (0..times.len()).map(knot).collect();
    ("motion", format!("{{ \"interpolation\": {}, \"knots\": {} }}", json!(readings), lines(&knots)))
}
