//! The value of the wrist's joint during the motions of a task.
//!
//! A level payload keeps its orientation, so the joint compensates the rotation of link 2. With a rigid payload, the joint
//! rests. Without a payload, it returns towards its rest position, as far as its limits allow. Along a line for which the
//! tool has an angle, the motion itself has the joint's values.

use super::state::State;
use cplan_handling::{Holding, Task, Wrist, WristJoint};
use cplan_model::{Arm, Scene};
use cplan_motion::recorded::WristTurn;
use cplan_motion::{TimedMotion, TorqueLimit, Trajectory};
use std::sync::Arc;

/// Returns value and velocity of the wrist's joint at sample `k` of a motion at whose beginning it is at `from`, radians.
/// `rest` is its default value, and `sign` the direction in which greater values turn the tool. Turns of the payload are
/// not included.
#[must_use]
pub fn wrist_state(
    arm: &Arm,
    limits: Wrist,
    (sign, rest): (f64, f64),
    held: Option<Holding>,
    trajectory: &Trajectory,
    (from, k): (f64, usize),
) -> [f64; 2] {
    if let Some([value, rate, _]) = trajectory.wrist.get(k) {
        return [*value, *rate];
    }
    let angle = |planned: [f64; 2]| WristJoint::link_2_angle(arm, planned);
    match held {
        Some(Holding::Rigid) => [from, 0.0],
        Some(Holding::Level) => {
            let turned = angle(trajectory.position[k]) - angle(trajectory.position[0]);
            [from - sign * turned, -sign * angle(trajectory.velocity[k])]
        }
        // The cubic below begins with a jump of the acceleration.
        None if limits.jerk.is_some() => [from, 0.0],
        None => {
            let duration = trajectory.duration();
            if duration == 0.0 {
                return [from, 0.0];
            }
            let distance = reachable_part(rest - from, duration, limits);
            let u = trajectory.time[k] / duration;
            [from + distance * u * u * (3.0 - 2.0 * u), distance * 6.0 * u * (1.0 - u) / duration]
        }
    }
}

/// Returns the part of `distance` that the wrist can cover in `duration`, from rest to rest along a cubic. The top
/// speed of a cubic is 1.5 times the mean speed. Its greatest acceleration is 6 times the distance over the squared
/// time.
fn reachable_part(distance: f64, duration: f64, limits: Wrist) -> f64 {
    let most = (limits.velocity * duration / 1.5).min(limits.acceleration * duration * duration / 6.0);
    distance.clamp(-most, most)
}

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
