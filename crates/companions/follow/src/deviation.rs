//! The proven distance between a line and a motion as controllers play it.
//!
//! Controllers join samples by polynomials of several kinds. [`Deviation`] bounds the distance for cubics. This module
//! adds bounds on the differences between cubics and the other polynomials.

use cplan_deviation::{Deviation, Kinematics, ToolDeviation};
use cplan_handling::{Derivative, Piece, WristJoint};
use cplan_model::space::Configuration;
use cplan_motion::Trajectory;

/// Returns an upper bound on the distance between a line and each piece of a motion, metres. The bound holds for all
/// polynomials by which controllers join the samples: cubics through positions and velocities, polynomials with the
/// stated acceleration at the beginning, and with `quintics` also those with the stated accelerations at both ends.
pub(crate) fn bounds(deviation: &Deviation, trajectory: &Trajectory, quintics: bool) -> Vec<f64> {
    let pieces = trajectory.pieces();
    let mut bounds = deviation.of_pieces(&pieces);
    for (i, (bound, piece)) in bounds.iter_mut().zip(&pieces).enumerate() {
        *bound += difference(deviation.kinematics, trajectory, i, piece, quintics);
    }
    bounds
}

/// Returns a bound on how far the tip moves if polynomials with the stated accelerations replace the cubic between two
/// samples. Polynomials and cubic differ by `u^2 (1 - u)^2` times a polynomial. The values of the latter at the ends
/// are half the differences of the accelerations.
fn difference(kinematics: &Kinematics, trajectory: &Trajectory, index: usize, piece: &Piece, quintics: bool) -> f64 {
    let duration = piece.to - piece.from;
    let off = |sample: usize, u: f64| {
        let stated = Configuration::from(trajectory.acceleration[sample]);
        (stated - piece.derivative(Derivative::Acceleration, u)).abs() * (duration * duration / 2.0)
    };
    let first = off(index, 0.0);
    let greatest = if quintics { first.sup(&off(index + 1, 1.0)) } else { first };
    let q = piece.at(0.5);
    let beside = Configuration::from_fn(|k, _| {
        piece.control().iter().map(|c| (c[k] - q[k]).abs()).fold(0.0, f64::max) + greatest[k]
    });
    kinematics.motion_within(q, beside, greatest) / 16.0
}

/// Returns an upper bound on the difference between the angle of the tool and the required one, radians, for the same
/// motions as [`bounds`]. The trajectory must have a wrist.
pub(crate) fn tool_bound(tool: &ToolDeviation, joint: &WristJoint, trajectory: &Trajectory, quintics: bool) -> f64 {
    let arm = tool.deviation.kinematics.arm;
    let rate = |planned: [f64; 2], turning: f64| WristJoint::link_2_angle(arm, planned) + joint.sign * turning;
    let end = |k: usize| {
        let [value, turning, _] = trajectory.wrist[k];
        let angle = joint.tool_angle(arm, trajectory.position[k], value);
        [angle, rate(trajectory.velocity[k], turning)].map(|x| Configuration::new(x, 0.0))
    };
    let time = &trajectory.time;
    let angles: Vec<Piece> =
        (1..time.len()).map(|k| Piece::hermite(time[k - 1], time[k], end(k - 1), end(k))).collect();
    let bounds = tool.of_pieces(&trajectory.pieces(), &angles);
    let difference = |index: usize| {
        let duration = time[index + 1] - time[index];
        let off = |sample: usize, u: f64| {
            let stated = rate(trajectory.acceleration[sample], trajectory.wrist[sample][2]);
            (stated - angles[index].derivative(Derivative::Acceleration, u)[0]).abs() * (duration * duration / 2.0)
        };
        let first = off(index, 0.0);
        (if quintics { first.max(off(index + 1, 1.0)) } else { first }) / 16.0
    };
    bounds.into_iter().enumerate().map(|(index, bound)| bound + difference(index)).fold(0.0, f64::max)
}
