//! The proven distance between a line and a motion as controllers play it.
//!
//! Controllers join samples by polynomials of several kinds. [`Deviation`] bounds the distance for cubics; here, the
//! differences of the others from these cubics are added.

use cplan_core::space::Configuration;
use cplan_deviation::{Deviation, Kinematics};
use cplan_handling::{Derivative, Piece};
use cplan_motion::Trajectory;

/// Returns an upper bound on the distance between a line and each piece of a motion, metres. Every motion counts that
/// readers of the samples may play: cubics through positions and velocities, polynomials that also have the accelerations
/// at their beginnings, and with `quintics` those that have them at both ends.
pub(crate) fn bounds(deviation: &Deviation, trajectory: &Trajectory, quintics: bool) -> Vec<f64> {
    let pieces = trajectory.pieces();
    let mut bounds = deviation.of_pieces(&pieces);
    for (i, (bound, piece)) in bounds.iter_mut().zip(&pieces).enumerate() {
        *bound += difference(deviation.kinematics, trajectory, i, piece, quintics);
    }
    bounds
}

/// Returns a bound on the distance of the tip between the cubic through two samples and the polynomials that also have
/// the accelerations there. Their difference is `u^2 (1 - u)^2` times a polynomial whose values at the ends are half
/// the differences of the accelerations.
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
