//! Whether a recorded motion keeps the joints' limits, between its samples too.

use super::passage::Moment;
use crate::model::Joint;
use crate::space::{Axis, Configuration, Derivative, Piece, Recording};

/// Share of a limit by which it may be exceeded: programs that plan up to a limit exceed it by what their arithmetic
/// and six printed digits make of it, and no drive tells the two apart.
const TOLERANCE: f64 = 1e-6;

/// Numbers with this many decimals or more are taken to be rounded in the last one.
const ROUNDED_FROM: i32 = 6;

/// Numbers with fewer are as they were meant (`0.5` is a half, a time of `0.004` is the fourth millisecond), exact to
/// this many decimals: the nanosecond in which ROS counts.
const MEANT_TO: i32 = 9;

/// Units in the last place by which doubles are taken to be off: what computing a sample, and the cubic through it, costs.
const ULPS: f64 = 4.0;

/// A limit of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Its range.
    Position,
    /// Its top speed.
    Velocity,
    /// Its greatest acceleration.
    Acceleration,
    /// Its greatest jerk.
    Jerk,
    /// Its acceleration does not jump if its jerk has a limit.
    AccelerationJump,
    /// A motion starts at rest.
    RestAtStart,
    /// A motion ends at rest.
    RestAtEnd,
}

/// A limit that is not kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excess {
    /// 0 or 1.
    pub joint: usize,
    /// Which limit.
    pub limit: Limit,
    /// What the limit allows, in the unit of `value`: the nearer end of the range, or a magnitude; 0 for rest and jumps.
    pub allowed: f64,
    /// The joint's position, velocity, acceleration, jerk or change of acceleration where it exceeds the limit most.
    pub value: f64,
    /// When that is.
    pub moment: Moment,
}

/// Every limit of each joint that the motion does not keep, with the place where it is exceeded most. The extremes of
/// each cubic piece are found in closed form. `O(n)`.
///
/// Position limits hold for every recording; velocity limits where there are times; acceleration and rest at both ends
/// where there are velocities: without, the velocity jumps at the samples, which says nothing about how the motion is
/// meant. A limit counts as broken only if it is exceeded by more than 1e-6 of it and by more than the rounding of the
/// recording's own numbers explains: six decimals at a millisecond's spacing leave the acceleration open to some
/// radians per squared second.
///
/// The jerk of a joint that has such a limit is judged where there are velocities: the third derivative of each cubic, and
/// that the acceleration does not jump from one to the next, nor where the motion begins and ends. That is exact for
/// motions whose jerk is constant between samples. Others, however smooth, are not what their cubics are, and these jump
/// at the samples by as much as the square of the spacing: they are to be sampled at the ends of their phases.
#[must_use]
pub fn limits_kept(joints: &[Joint; 2], recording: &Recording) -> Vec<Excess> {
    let precision = Precision::of(recording);
    let pieces = recording.pieces();
    let mut found = Vec::new();
    for (k, joint) in joints.iter().enumerate() {
        let mut judge = Judge { joint, k, precision: precision.of_joint(k), worst: Vec::new() };
        for (index, piece) in pieces.iter().enumerate() {
            judge.position(index, piece);
            if recording.times().is_some() {
                judge.velocity(index, piece, recording.velocities().is_some());
            }
            if let Some([before, after]) = recording.velocities().and_then(|v| v.get(index..index + 2)) {
                judge.acceleration(index, piece, [before[k], after[k]]);
            }
        }
        if let Some(velocities) = recording.velocities() {
            if let Some(jerk) = joint.jerk {
                judge.jerk(&pieces, jerk);
            }
            let last = velocities.len() - 1;
            let end = (pieces.len() - 1, &pieces[pieces.len() - 1]);
            judge.rest(Limit::RestAtStart, velocities[0][k], (0, &pieces[0], 0.0));
            judge.rest(Limit::RestAtEnd, velocities[last][k], (end.0, end.1, 1.0));
        }
        found.extend(judge.worst.into_iter().map(|(_, excess)| excess));
    }
    found
}

/// One joint's limits, and how they are exceeded most.
struct Judge<'a> {
    joint: &'a Joint,
    k: usize,
    precision: JointPrecision,
    /// By how much, and how.
    worst: Vec<(f64, Excess)>,
}

impl Judge<'_> {
    /// Takes note of a value that is `over` its limit by more than may be.
    fn note(&mut self, over: f64, limit: Limit, allowed: f64, value: f64, place: (usize, &Piece, f64)) {
        let (index, piece, u) = place;
        let excess = Excess { joint: self.k, limit, allowed, value, moment: Moment::new(index, piece, u) };
        match self.worst.iter_mut().find(|(_, known)| known.limit == limit) {
            Some((worst, _)) if *worst >= over => {}
            Some(known) => *known = (over, excess),
            None => self.worst.push((over, excess)),
        }
    }

    fn position(&mut self, index: usize, piece: &Piece) {
        let Axis::Interval { lower, upper } = self.joint.axis else { return };
        let may = self.precision.position
            + (piece.to - piece.from) * self.precision.velocity
            + self.speed(piece) * self.precision.time;
        for u in piece.critical(Derivative::Position, self.k) {
            let value = piece.at(u)[self.k];
            for (over, allowed) in [(lower - value, lower), (value - upper, upper)] {
                if over > may + TOLERANCE * allowed.abs() {
                    self.note(over, Limit::Position, allowed, value, (index, piece, u));
                }
            }
        }
    }

    fn velocity(&mut self, index: usize, piece: &Piece, curved: bool) {
        let given = if curved { self.precision.velocity } else { 0.0 };
        // The cubic's velocity is the mean one times at most 1.5, and the given ones times at most 1 each.
        let may = 1.5 * self.mean_velocity_error(piece) + 2.0 * given;
        for u in piece.critical(Derivative::Velocity, self.k) {
            let value = piece.derivative(Derivative::Velocity, u)[self.k];
            let over = value.abs() - self.joint.velocity;
            if over > may + TOLERANCE * self.joint.velocity {
                self.note(over, Limit::Velocity, self.joint.velocity, value, (index, piece, u));
            }
        }
    }

    fn acceleration(&mut self, index: usize, piece: &Piece, [before, after]: [f64; 2]) {
        let duration = piece.to - piece.from;
        if duration <= 0.0 {
            return;
        }
        // The middle's is taken from the velocities: from the positions it would come with the errors of the ends.
        let middle = (after - before) / duration;
        let in_middle = 2.0 * self.precision.velocity / duration + self.late(middle, duration);
        let [first, last] = self.end_accelerations(piece);
        for (u, (value, may)) in [(0.0, first), (1.0, last), (0.5, (middle, in_middle))] {
            let over = value.abs() - self.joint.acceleration;
            if over > may + TOLERANCE * self.joint.acceleration {
                self.note(over, Limit::Acceleration, self.joint.acceleration, value, (index, piece, u));
            }
        }
    }

    /// Of all pieces: each one's own, and the jumps of the acceleration at their ends.
    fn jerk(&mut self, pieces: &[Piece], most: f64) {
        // Where nothing moves.
        let still = (0.0, 0.0);
        let mut before = still;
        for (index, piece) in pieces.iter().enumerate().filter(|(_, piece)| piece.to > piece.from) {
            let duration = piece.to - piece.from;
            let [first, last] = self.end_accelerations(piece);
            self.jump(before, first, (index, piece, 0.0));
            let value = (last.0 - first.0) / duration;
            // Twelve times the difference between the mean velocity and the mean of the velocities, over the squared time.
            let may = 12.0 * (self.mean_velocity_error(piece) + self.precision.velocity) / duration / duration;
            let over = value.abs() - most;
            if over > may + 2.0 * self.late(value, duration) + TOLERANCE * most {
                self.note(over, Limit::Jerk, most, value, (index, piece, 0.5));
            }
            before = last;
        }
        let last = pieces.len() - 1;
        self.jump(before, still, (last, &pieces[last], 1.0));
    }

    /// From one acceleration to another, each with its error.
    fn jump(&mut self, before: (f64, f64), after: (f64, f64), place: (usize, &Piece, f64)) {
        let value = after.0 - before.0;
        if value.abs() > before.1 + after.1 + TOLERANCE * self.joint.acceleration {
            self.note(value.abs(), Limit::AccelerationJump, 0.0, value, place);
        }
    }

    /// The accelerations at both ends of a piece that takes time, each with its error: they are the difference of the
    /// velocities over the time, and six times the difference between the mean velocity and the mean of the velocities.
    fn end_accelerations(&self, piece: &Piece) -> [(f64, f64); 2] {
        let duration = piece.to - piece.from;
        let of_velocities = 2.0 * self.precision.velocity / duration;
        let may = of_velocities + 6.0 * (self.mean_velocity_error(piece) + self.precision.velocity) / duration;
        [0.0, 1.0].map(|u| {
            let value = piece.derivative(Derivative::Acceleration, u)[self.k];
            (value, may + self.late(value, duration))
        })
    }

    /// Error of a quotient by the duration from the rounding of the times.
    fn late(&self, value: f64, duration: f64) -> f64 {
        value.abs() * 2.0 * self.precision.time / duration
    }

    fn rest(&mut self, limit: Limit, value: f64, place: (usize, &Piece, f64)) {
        if value.abs() > TOLERANCE * self.joint.velocity + self.precision.velocity {
            self.note(value.abs(), limit, 0.0, value, place);
        }
    }

    /// Greatest speed at which the joint passes the ends of the piece, or passes from one to the other.
    fn speed(&self, piece: &Piece) -> f64 {
        let duration = piece.to - piece.from;
        let mean = if duration > 0.0 { (piece.at(1.0) - piece.at(0.0))[self.k] / duration } else { 0.0 };
        let at = |u: f64| piece.derivative(Derivative::Velocity, u)[self.k].abs();
        mean.abs().max(at(0.0)).max(at(1.0))
    }

    /// Error of the mean velocity over the piece from the rounding of positions and times.
    fn mean_velocity_error(&self, piece: &Piece) -> f64 {
        let duration = piece.to - piece.from;
        let moved = 2.0 * self.precision.position + 2.0 * self.precision.time * self.speed(piece);
        if duration > 0.0 { moved / duration } else { 0.0 }
    }
}

/// Bounds on the rounding errors of a recording's numbers.
struct Precision {
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
}

/// The same for one joint.
struct JointPrecision {
    position: f64,
    velocity: f64,
    time: f64,
}

impl Precision {
    fn of(recording: &Recording) -> Self {
        let each = |rows: Option<&[Configuration]>| {
            [0, 1].map(|k| rows.map_or(0.0, |rows| rounding(rows.iter().map(|row| row[k]))))
        };
        Self {
            position: each(Some(recording.positions())),
            velocity: each(recording.velocities()),
            time: recording.times().map_or(0.0, |times| rounding(times.iter().copied())),
        }
    }

    fn of_joint(&self, k: usize) -> JointPrecision {
        JointPrecision { position: self.position[k], velocity: self.velocity[k], time: self.time }
    }
}

/// Half a unit of the last decimal that any of the numbers has, plus the rounding of doubles of their size.
fn rounding(values: impl Iterator<Item = f64>) -> f64 {
    let (mut most, mut largest) = (0, 0.0_f64);
    for value in values {
        largest = largest.max(value.abs());
        // Doubles have no more than 17 digits: nothing finer is to be found.
        if most < 17 {
            most = most.max(decimals(value));
        }
    }
    let digits = if most < ROUNDED_FROM { MEANT_TO } else { most };
    0.5 * 10f64.powi(-digits) + ULPS * f64::EPSILON * largest
}

/// Decimals of the shortest decimal number that reads as `value`.
fn decimals(value: f64) -> i32 {
    let text = format!("{value:e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return 0 };
    let digits = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
    digits as i32 - exponent.parse::<i32>().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_those_written() {
        for (value, expected) in [(0.0, 0), (1.0, 0), (120.0, -1), (0.25, 2), (-3.125, 3), (1e-7, 7), (1.5e-7, 8)] {
            assert_eq!(decimals(value), expected, "{value}");
        }
        assert_eq!(rounding([0.5, 1.0].into_iter()), 0.5e-9 + ULPS * f64::EPSILON);
        assert_eq!(rounding([0.5, 0.333_333].into_iter()), 0.5e-6 + 0.5 * ULPS * f64::EPSILON);
        assert!(rounding([0.123_456_789].into_iter()) < 0.6e-9);
    }
}
