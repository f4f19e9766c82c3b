//! The wrist between the motions of a task: its value after a motion, and the turn to the first value of a line.

use super::state::State;
use cplan_handling::{Task, Wrist};
use cplan_legs::wrist_state;
use cplan_model::Scene;
use cplan_motion::recorded::WristTurn;
use cplan_motion::{TimedMotion, TorqueLimit, Trajectory};
use std::sync::Arc;

/// Returns the joint's value after a motion from a state and the turn at its end. `None` if the state has none.
pub(super) fn wrist_after(task: &Task, from: &State, trajectory: &Trajectory, turn: Option<WristTurn>) -> Option<f64> {
    let (begin, wrist) = (from.wrist?, task.wrist?);
    let joint = wrist.joint?;
    let held = from.held.as_ref().map(|held| task.objects[held.object].holding);
    let last = trajectory.time.len().checked_sub(1)?;
    let [value, _] = wrist_state(&task.arm, wrist, (joint.sign, joint.rest), held, trajectory, (begin, last));
    Some(value + turn.map_or(0.0, |turn| joint.sign * (turn.to - turn.from)))
}

/// Returns a motion along a line before which the wrist turns from `begin` to its first value, while the arm rests. `share`
/// is the share of the wrist's top speed to use. A motion without a wrist is returned as it was given.
pub(super) fn turned_first(
    scene: &Scene,
    timed: &Arc<TimedMotion>,
    begin: f64,
    wrist: &Wrist,
    share: f64,
) -> Arc<TimedMotion> {
    let trajectory = &timed.trajectory;
    let (Some(&[first, ..]), Some(&position)) = (trajectory.wrist.first(), trajectory.position.first()) else {
        return timed.clone();
    };
    if first == begin {
        return timed.clone();
    }
    let mut whole = Trajectory {
        time: vec![0.0],
        position: vec![position],
        velocity: vec![[0.0; 2]],
        acceleration: vec![[0.0; 2]],
        torque: Vec::new(),
        wrist: vec![[begin, 0.0, 0.0]],
    };
    whole.append_turn(first, share * wrist.velocity, share * share * wrist.acceleration);
    whole.then(0.0, &Trajectory { torque: Vec::new(), ..trajectory.clone() });
    if !trajectory.torque.is_empty()
        && let Some(torque) = TorqueLimit::of(scene)
    {
        whole.torque = torque.along_trajectory(&whole);
    }
    Arc::new(TimedMotion { curve: timed.curve.clone(), trajectory: whole })
}
