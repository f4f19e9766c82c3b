//! A wrist that keeps the angle of the tool during a motion with limited jerks.
//!
//! For a fixed angle, the value of the wrist's joint is a linear function of the two planned joints. So the motion is
//! computed first, and then slowed down if the wrist would be too fast.

use crate::wrist::WristAlong;
use cplan_handling::{Derivative, Piece, WristJoint};
use cplan_model::Arm;
use cplan_motion::Trajectory;

/// Adds a wrist to a motion that keeps the angle of the tool. `first` is the joint's first value, radians.
pub(crate) fn add_wrist(arm: &Arm, wrist: &WristAlong, first: f64, trajectory: &mut Trajectory) {
    let Some(&start) = trajectory.position.first() else { return };
    let angle = wrist.joint.tool_angle(arm, start, first);
    let rate = |planned: [f64; 2]| -wrist.joint.sign * WristJoint::link_2_angle(arm, planned) + 0.0;
    let row = |k: usize| {
        let value = wrist.joint.value(arm, trajectory.position[k], angle);
        [value, rate(trajectory.velocity[k]), rate(trajectory.acceleration[k])]
    };
    trajectory.wrist = (0..trajectory.time.len()).map(row).collect();
}

/// Returns the factor by which the motion must be slowed down so that the wrist uses at most `share` of its limits. The
/// factor is at most 1 if it already does.
pub(crate) fn excess(wrist: &WristAlong, share: f64, trajectory: &Trajectory) -> f64 {
    let [velocity, acceleration] = [share * wrist.velocity, share * share * wrist.acceleration];
    let pieces = trajectory.wrist_pieces();
    let greatest = |piece: &Piece, of: Derivative| {
        piece.bounds_of_sum(of, [1.0, 0.0], [0.0, 1.0]).into_iter().map(f64::abs).fold(0.0, f64::max)
    };
    let speed = pieces.iter().map(|piece| greatest(piece, Derivative::Velocity)).fold(0.0, f64::max) / velocity;
    // Polynomials with the stated initial acceleration differ from the cubics by at most this acceleration.
    let off =
        |k: usize, piece: &Piece| (trajectory.wrist[k][2] - piece.derivative(Derivative::Acceleration, 0.0)[0]).abs();
    let gains = pieces.iter().enumerate().map(|(k, piece)| greatest(piece, Derivative::Acceleration) + off(k, piece));
    speed.max((gains.fold(0.0, f64::max) / acceleration).sqrt())
}
