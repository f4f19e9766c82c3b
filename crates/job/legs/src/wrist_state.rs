//! The value of the wrist's joint during the motions of a task.
//!
//! A level payload keeps its orientation, so the joint compensates the rotation of link 2. With a rigid payload, the joint rests.
//! Without a payload, it returns towards its rest position, as far as its limits allow. Along a line that states the tool's
//! angle, the motion itself has the joint's values.

use cplan_handling::{Holding, Wrist, WristJoint};
use cplan_model::Arm;
use cplan_motion::Trajectory;

/// Returns value and velocity of the wrist's joint at sample `k` of a motion, at whose beginning the joint is at `from`, radians.
/// `rest` is its default value, and `sign` the direction in which greater values turn the tool. Turns of the payload are not
/// included.
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
        // The cubic below would begin with a jump of the acceleration.
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

/// Returns the part of `distance` that the wrist can cover in `duration`, from rest to rest along a cubic. A cubic's top speed is
/// 1.5 times its mean speed, and its greatest acceleration is 6 times the distance divided by the squared time.
fn reachable_part(distance: f64, duration: f64, limits: Wrist) -> f64 {
    let most = (limits.velocity * duration / 1.5).min(limits.acceleration * duration * duration / 6.0);
    distance.clamp(-most, most)
}
