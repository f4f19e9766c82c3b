//! Torques along a motion.

use cplan_dynamics::{LimitedTorque, Rates, Torques};
use cplan_handling::{Derivative, Piece};
use cplan_model::space::Configuration;

/// Greatest number of samples of a piece.
const MAX_SAMPLES_PER_PIECE: f64 = 4096.0;

/// A sample of the torques.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueSample {
    /// Fraction of the piece's time.
    pub u: f64,
    /// Torques of both joints, N m or N.
    pub torque: Configuration,
    /// Torques that hold the arm at rest there.
    pub holding: Configuration,
    /// Bound on the increase of each torque until the next sample.
    pub off: [f64; 2],
}

/// Samples the torques along a piece so densely that they change by at most a share of the efforts between two samples. Takes at
/// most some thousands of samples.
pub fn torque_samples<'a>(
    torques: &Torques<'a>,
    piece: &Piece,
    fine: f64,
) -> impl Iterator<Item = TorqueSample> + use<'a> {
    let duration = piece.to - piece.from;
    let greatest = |of: Derivative| {
        [0, 1].map(|k| piece.critical(of, k).map(|u| piece.derivative(of, u)[k].abs()).fold(0.0, f64::max))
    };
    let rates = Rates {
        first: greatest(Derivative::Velocity),
        second: greatest(Derivative::Acceleration),
        third: greatest(Derivative::Jerk),
    };
    let rate = torques.change(piece.at(0.5), duration / 2.0, &rates);
    let share = |limited: LimitedTorque| limited.bound(rate) * duration / (2.0 * fine * limited.effort);
    let share = torques.limited_torques().map(share).fold(0.0, f64::max);
    let count = share.ceil().clamp(1.0, MAX_SAMPLES_PER_PIECE);
    let off = rate.map(|rate| rate * duration / (2.0 * count));
    let (torques, piece) = (*torques, *piece);
    (0..count as u32).map(move |i| {
        let u = (f64::from(i) + 0.5) / count;
        let q = piece.at(u);
        let [velocity, acceleration] =
            [Derivative::Velocity, Derivative::Acceleration].map(|of| piece.derivative(of, u));
        let here = torques.at(q);
        let holding = here.holding();
        let torque = here.inertial(acceleration) + here.centrifugal(velocity) + holding;
        TorqueSample { u, torque, holding, off }
    })
}
