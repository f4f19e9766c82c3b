//! The motion between the samples, interpolated as controllers do.

use cplan_handling::Piece;
use cplan_model::Arm;
use cplan_model::space::Configuration;
use cplan_motion::Trajectory;

/// A path shows the ends of this number of parts of each piece.
const PARTS: u32 = 2;

/// A motion in pieces, in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Played {
    /// The pieces: at least one.
    pub pieces: Vec<Piece>,
}

/// Returns true if the jerk of a joint is limited.
pub fn is_smooth(arm: &Arm) -> bool {
    arm.limits_jerks()
}

impl Played {
    /// Interpolates samples by cubics through positions and velocities. If the jerk of a joint is limited, the polynomials have
    /// degree five and also match the accelerations.
    pub fn new(arm: &Arm, trajectory: &Trajectory) -> Self {
        let state = |i: usize| {
            [trajectory.position[i].into(), trajectory.velocity[i].into(), trajectory.acceleration[i].into()]
        };
        let quintic = |i: usize| Piece::quintic(trajectory.time[i - 1], trajectory.time[i], state(i - 1), state(i));
        let mut pieces =
            if is_smooth(arm) { (1..trajectory.time.len()).map(quintic).collect() } else { trajectory.pieces() };
        if pieces.is_empty() {
            let rest: Configuration = trajectory.position[0].into();
            pieces.push(Piece::line(0.0, 0.0, rest, rest));
        }
        Self { pieces }
    }

    /// Returns the duration, seconds.
    pub fn duration(&self) -> f64 {
        self.pieces[self.pieces.len() - 1].to
    }

    /// Returns the index of the piece at a time.
    fn index(&self, time: f64) -> usize {
        self.pieces.partition_point(|piece| piece.to < time).min(self.pieces.len() - 1)
    }

    /// Returns the configuration at a time in seconds.
    pub fn at(&self, time: f64) -> Configuration {
        let piece = &self.pieces[self.index(time)];
        piece.at(((time - piece.from) / (piece.to - piece.from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0))
    }

    /// Returns the configurations at two times, and between them at the ends of pieces and of their parts.
    pub fn between(&self, from: f64, to: f64) -> Vec<Configuration> {
        let parts = |piece: &'_ Piece| {
            let piece = *piece;
            (1..=PARTS).map(move |k| f64::from(k) / f64::from(PARTS)).map(move |u| (piece.time(u), piece.at(u)))
        };
        let pieces = &self.pieces[self.index(from)..=self.index(to)];
        let inner = pieces.iter().flat_map(parts).filter(|(time, _)| from < *time && *time < to);
        std::iter::once(self.at(from)).chain(inner.map(|(_, q)| q)).chain([self.at(to)]).collect()
    }

    /// Iterates over configurations after a time. A step is a piece's duration divided by `parts`.
    pub fn after(&self, time: f64, parts: u32) -> impl Iterator<Item = Configuration> + '_ {
        let pieces = self.pieces[self.index(time)..].iter();
        let places = pieces.flat_map(move |piece| (0..=parts).map(move |k| (piece, f64::from(k) / f64::from(parts))));
        places.filter(move |(piece, u)| piece.time(*u) > time).map(|(piece, u)| piece.at(u))
    }

    /// Iterates over configurations before a time, from late to early. A step is a piece's duration divided by `parts`.
    pub fn before(&self, time: f64, parts: u32) -> impl Iterator<Item = Configuration> + '_ {
        let pieces = self.pieces[..=self.index(time)].iter().rev();
        let shares = move || (0..=parts).rev().map(move |k| f64::from(k) / f64::from(parts));
        let places = pieces.flat_map(move |piece| shares().map(move |u| (piece, u)));
        places.filter(move |(piece, u)| piece.time(*u) < time).map(|(piece, u)| piece.at(u))
    }
}
