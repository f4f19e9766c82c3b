//! Checks the joint limits of a recorded motion, also between its samples.

use super::encounter::Moment;
use super::precision::{JointPrecision, Precision};
use super::torque::torque_samples;
use cplan_dynamics::{LimitedTorque, Torques};
use cplan_handling::{Derivative, Piece, Recording};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Arm, Joint, Motors, Scene};

/// Tolerated excess over a limit, as a share of it. Programs that plan up to a limit exceed it by rounding and by printing six
/// digits. No drive can tell the difference.
const LIMIT_TOLERANCE: f64 = 1e-6;

/// Largest excess over a speed limit between samples, as a share of the limit, that rounding of positions and times may explain.
/// With six decimals at a kilohertz, rounding causes a thousandth of a radian per second. Coarser numbers define another motion,
/// which is the one that a controller executes.
const MAX_ROUNDING_SHARE: f64 = 0.01;

/// A limit of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Limit {
    /// The least and the greatest value that the joint can take.
    Position,
    /// The top speed.
    Velocity,
    /// The greatest acceleration.
    Acceleration,
    /// The greatest jerk.
    Jerk,
    /// The greatest torque or force of the joint's drive.
    Torque,
    /// A jump of the acceleration, although the jerk is limited.
    AccelerationJump,
    /// A motion that does not start at rest.
    RestAtStart,
    /// A motion that does not end at rest.
    RestAtEnd,
}

/// A violated limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitViolation {
    /// Index of the joint, 0 or 1, or [`ELBOW_MOTOR`], or [`FIRST_MOTOR`].
    pub joint: usize,
    /// The violated limit.
    pub limit: Limit,
    /// The allowed value, in the unit of `value`: the nearer end of the joint's range, or the greatest magnitude; 0 for rest and
    /// jumps.
    pub allowed: f64,
    /// The joint's position, velocity, acceleration, jerk or change of acceleration where it exceeds the limit most.
    pub value: f64,
    /// Moment at which the joint has that value.
    pub moment: Moment,
}

/// Returns every violated limit of each joint, at the moment of the greatest violation. Takes `O(n)` for `n` samples.
///
/// Position limits apply to every recording, and velocity limits if there are times. Limits of acceleration, and rest at both
/// ends, apply if there are velocities. Without velocities, the velocity jumps at the samples, so the accelerations of the
/// intended motion are unknown.
///
/// The velocities and accelerations that a file states must be within the limits. Between samples, the extremes of each piece
/// must be, with the interpolation of the file's consumer ([`cplan_handling::Interpolation`]). A limit counts as violated if the
/// excess is more than 1e-6 of it, and more than rounding of the recording's numbers explains. For a stated number, rounding
/// means half a unit of its last decimal; between samples, it means the error that such rounding causes in a motion within the
/// limits. (With six decimals and samples a millisecond apart, the acceleration of a cubic is uncertain by some radians per
/// squared second.)
///
/// Rounding may explain an excess on a short piece, but not over a long stretch. So between any two samples, a joint must not
/// move farther than its top speed allows, and its stated velocity must not change by more than its greatest acceleration allows.
///
/// If a joint has a limit on its jerk and there are velocities, the third derivative of each piece is compared with it. The
/// acceleration must then be continuous between pieces and at the ends of the motion. This is exact for motions with constant
/// jerk between samples. The accelerations of cubics through other motions jump at the samples, so a motion must have samples
/// where its jerk changes.
pub fn limit_violations(joints: &[Joint; 2], recording: &Recording) -> Vec<LimitViolation> {
    let precision = Precision::of(recording);
    let pieces = recording.pieces();
    let judged = |k: usize| {
        let (joint, precision) = (&joints[k], precision.of_joint(k));
        Judge { joint, k, pieces: &pieces, precision, worst: Vec::new() }.violations(recording)
    };
    [0, 1].map(judged).concat()
}

/// Index in [`LimitViolation::joint`] of the elbow's motor if it is mounted on the base.
pub const ELBOW_MOTOR: usize = 2;

/// Index in [`LimitViolation::joint`] of the first motor, if its torque differs from the torque of joint 1. The torque
/// is stated without the motor's gear.
pub const FIRST_MOTOR: usize = 3;

/// Returns every violated limit of the sum of joint values that the elbow's motor turns, like [`limit_violations`].
pub fn motor_violations(arm: &Arm, recording: &Recording) -> Vec<LimitViolation> {
    let Some(motors) = arm.motors else { return Vec::new() };
    let Motors { ratio, range, velocity, acceleration, jerk, .. } = motors;
    if range.is_none() && [velocity, acceleration, jerk].iter().all(Option::is_none) {
        return Vec::new();
    }
    let joint = Joint {
        range: range.map_or(JointRange::Circle, |[lower, upper]| JointRange::Interval { lower, upper }),
        velocity: velocity.unwrap_or(f64::INFINITY),
        acceleration: acceleration.unwrap_or(f64::INFINITY),
        jerk,
        ..arm.joints[1].clone()
    };
    let precision = Precision::of(recording).of_sum(ratio.abs());
    // In the converted motion, the value of joint 2 is the sum.
    let converted = recording.mapped(|row| Configuration::new(row[0], motors.joint_sum(*row)));
    let pieces = converted.pieces();
    let mut found = Judge { joint: &joint, k: 1, pieces: &pieces, precision, worst: Vec::new() }.violations(&converted);
    // The check of the joints already reports motions that do not begin or end at rest.
    found.retain(|excess| !matches!(excess.limit, Limit::RestAtStart | Limit::RestAtEnd));
    for excess in &mut found {
        excess.joint = ELBOW_MOTOR;
        excess.moment.at[1] -= ratio * excess.moment.at[0];
    }
    found
}

/// Greatest change of a torque between two examined moments, as a share of the joint's effort.
const TORQUE_TOLERANCE: f64 = 1e-4;

/// Returns, for each joint and the first motor, the moment with the greatest excess of the torque over the effort. Returns
/// nothing if motions of the scene's arm need not respect efforts.
///
/// Torques are checked if there are velocities, with the interpolation of the file's consumer, and with the same allowance for
/// rounding as accelerations. Between the examined moments, a torque may be greater by a ten-thousandth of the effort. For a
/// recording of a single sample, the torque that holds the arm there is checked.
pub fn torque_violations(scene: &Scene, recording: &Recording) -> Vec<LimitViolation> {
    let Some(torques) = Torques::limited(scene).filter(|_| recording.velocities().is_some()) else {
        return Vec::new();
    };
    let (arm, precision, pieces) = (scene.arm(), Precision::of(recording), recording.pieces());
    let inertia = torques.greatest_inertia();
    let judge = |k: usize| {
        let joint = &arm.joints[k];
        Judge { joint, k, pieces: &pieces, precision: precision.of_joint(k), worst: Vec::new() }
    };
    let both = [judge(0), judge(1)];
    let judged = |limited: LimitedTorque| (limited, judge(limited.joint.unwrap_or(0)));
    let mut judges: Vec<_> = torques.limited_torques().map(judged).collect();
    if let [q] = recording.positions() {
        let holding = torques.at(*q).holding();
        for (limited, judge) in &mut judges {
            let (value, allowed) = (limited.of(holding), limited.effort);
            if value.abs() > allowed * (1.0 + LIMIT_TOLERANCE) {
                judge.note(value.abs() - allowed, Limit::Torque, allowed, value, judge.sample(0));
            }
        }
    }
    for (index, piece) in pieces.iter().enumerate().filter(|(_, piece)| piece.to > piece.from) {
        let explained =
            both.each_ref().map(|judge| judge.rounding_part(piece, &Sensitivity::of(piece, Derivative::Acceleration)));
        for look in torque_samples(&torques, piece, TORQUE_TOLERANCE) {
            for (limited, judge) in &mut judges {
                let (value, allowed) = (limited.of(look.torque), limited.effort);
                let errors = inertia.map(|row| row[0] * explained[0] + row[1] * explained[1]);
                let may = limited.bound(errors) + LIMIT_TOLERANCE * allowed;
                if value.abs() - allowed > may {
                    judge.note(value.abs() - allowed, Limit::Torque, allowed, value, judge.moment(index, look.u));
                }
            }
        }
    }
    let found = |(limited, judge): (LimitedTorque, Judge)| {
        let joint = limited.joint.unwrap_or(FIRST_MOTOR);
        judge.worst.into_iter().map(move |(_, excess)| LimitViolation { joint, ..excess })
    };
    judges.into_iter().flat_map(found).collect()
}

/// The limits of one joint, and their greatest violations.
struct Judge<'a> {
    joint: &'a Joint,
    k: usize,
    pieces: &'a [Piece],
    precision: JointPrecision,
    /// For each violated limit, the greatest excess so far and its violation.
    worst: Vec<(f64, LimitViolation)>,
}

impl<'a> Judge<'a> {
    /// Returns every violated limit of the joint.
    fn violations(mut self, recording: &Recording) -> Vec<LimitViolation> {
        self.positions();
        let k = self.k;
        let of_joint = |rows: &[Configuration]| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
        if let Some(times) = recording.times() {
            self.velocities(&of_joint(recording.positions()), times);
            if let Some(rows) = recording.velocities() {
                let velocities = of_joint(rows);
                self.judge_stated_rates(Limit::Velocity, &velocities);
                self.accelerations(&velocities, times);
                self.judge_rest(Limit::RestAtStart, velocities[0], 0);
                self.judge_rest(Limit::RestAtEnd, velocities[velocities.len() - 1], velocities.len() - 1);
            }
            if let Some(rows) = recording.accelerations() {
                self.judge_stated_rates(Limit::Acceleration, &of_joint(rows));
            }
            if let (Some(most), Some(_)) = (self.joint.jerk, recording.velocities()) {
                self.jerks(most);
            }
        }
        self.worst.sort_by_key(|(_, excess)| excess.limit);
        self.worst.into_iter().map(|(_, excess)| excess).collect()
    }

    /// Records a value that exceeds its limit by `over` more than the tolerance.
    fn note(&mut self, over: f64, limit: Limit, allowed: f64, value: f64, moment: Moment) {
        let excess = LimitViolation { joint: self.k, limit, allowed, value, moment };
        match self.worst.iter_mut().find(|(_, known)| known.limit == limit) {
            Some((worst, _)) if *worst >= over => {}
            Some(known) => *known = (over, excess),
            None => self.worst.push((over, excess)),
        }
    }

    fn moment(&self, index: usize, u: f64) -> Moment {
        Moment::new(index, &self.pieces[index], u)
    }

    fn sample(&self, index: usize) -> Moment {
        if index < self.pieces.len() { self.moment(index, 0.0) } else { self.moment(index - 1, 1.0) }
    }

    /// Iterates over the pieces of positive duration, with their numbers.
    fn pieces_with_duration(&self) -> impl Iterator<Item = (usize, &'a Piece)> + use<'a> {
        self.pieces.iter().enumerate().filter(|(_, piece)| piece.to > piece.from)
    }

    fn positions(&mut self) {
        let JointRange::Interval { lower, upper } = self.joint.range else { return };
        for (index, piece) in self.pieces.iter().enumerate() {
            let may = self.precision.position
                + (piece.to - piece.from) * self.precision.velocity
                + self.speed(piece) * self.precision.time;
            for u in piece.critical(Derivative::Position, self.k) {
                let value = piece.at(u)[self.k];
                for (over, allowed) in [(lower - value, lower), (value - upper, upper)] {
                    if over > may + LIMIT_TOLERANCE * allowed.abs() {
                        self.note(over, Limit::Position, allowed, value, self.moment(index, u));
                    }
                }
            }
        }
    }

    /// Checks the velocities or accelerations that the file states.
    fn judge_stated_rates(&mut self, limit: Limit, values: &[f64]) {
        let (allowed, may) = match limit {
            Limit::Velocity => (self.joint.velocity, self.precision.velocity),
            _ => (self.joint.acceleration, self.precision.acceleration),
        };
        for (index, value) in values.iter().enumerate() {
            let over = value.abs() - allowed;
            if over > may + LIMIT_TOLERANCE * allowed {
                self.note(over, limit, allowed, *value, self.sample(index));
            }
        }
    }

    fn velocities(&mut self, positions: &[f64], times: &[f64]) {
        let allowed = self.joint.velocity;
        for (index, piece) in self.pieces_with_duration() {
            let of_data = Sensitivity::of(piece, Derivative::Velocity);
            let explained = self.rounding_part(piece, &of_data).min(MAX_ROUNDING_SHARE * allowed);
            self.extremes(Limit::Velocity, allowed, explained, index);
        }
        self.stretches(Limit::Velocity, allowed, self.precision.position, positions, times);
    }

    fn accelerations(&mut self, velocities: &[f64], times: &[f64]) {
        let allowed = self.joint.acceleration;
        for (index, piece) in self.pieces_with_duration() {
            let of_data = Sensitivity::of(piece, Derivative::Acceleration);
            let late = 2.0 * allowed * 2.0 * self.precision.time / (piece.to - piece.from);
            let explained = self.rounding_part(piece, &of_data) + late;
            self.extremes(Limit::Acceleration, allowed, explained, index);
        }
        self.stretches(Limit::Acceleration, allowed, self.precision.velocity, velocities, times);
    }

    /// Checks the least and the greatest value of a derivative of a piece. `explained` is the excess that rounding explains.
    fn extremes(&mut self, limit: Limit, allowed: f64, explained: f64, index: usize) {
        let piece = &self.pieces[index];
        let of = match limit {
            Limit::Velocity => Derivative::Velocity,
            Limit::Acceleration => Derivative::Acceleration,
            _ => Derivative::Jerk,
        };
        for u in piece.critical(of, self.k) {
            let value = piece.derivative(of, u)[self.k];
            let over = value.abs() - allowed;
            if over > explained + LIMIT_TOLERANCE * allowed {
                self.note(over, limit, allowed, value, self.moment(index, u));
            }
        }
    }

    /// Checks the mean rate of change of values between any two samples. The values have the rounding error `rounded`. Let `s` be
    /// a sample's value minus the allowed change up to it. The rate is too high if `s` exceeds the least earlier `s`.
    fn stretches(&mut self, limit: Limit, allowed: f64, rounded: f64, values: &[f64], times: &[f64]) {
        let most = allowed * (1.0 + LIMIT_TOLERANCE);
        let may = 2.0 * rounded + most * 2.0 * self.precision.time;
        for sign in [1.0, -1.0] {
            let beyond = |k: usize| sign * values[k] - most * (times[k] - times[0]);
            let mut least = 0;
            for k in 1..values.len() {
                if beyond(k) - beyond(least) > may {
                    let mean = (values[k] - values[least]) / (times[k] - times[least]);
                    self.note(mean.abs() - allowed, limit, allowed, mean, self.sample(k));
                }
                if beyond(k) < beyond(least) {
                    least = k;
                }
            }
        }
    }

    /// Checks the jerks of all pieces, and the jumps of the acceleration at their ends.
    fn jerks(&mut self, most: f64) {
        // A joint at rest has neither acceleration nor error.
        let still = (0.0, 0.0);
        let mut before = still;
        for (index, piece) in self.pieces_with_duration() {
            let duration = piece.to - piece.from;
            let of_time = 2.0 * self.precision.time / duration;
            let late = |value: f64| value.abs() * of_time;
            let [first, last] = [0.0, 1.0].map(|u| {
                let value = piece.derivative(Derivative::Acceleration, u)[self.k];
                let explained = self.rounding_part(piece, &Sensitivity::of(piece, Derivative::Acceleration));
                (value, explained + late(value))
            });
            self.jump(before, first, self.moment(index, 0.0));
            let explained = self.rounding_part(piece, &Sensitivity::of(piece, Derivative::Jerk));
            self.extremes(Limit::Jerk, most, explained + 2.0 * late(most), index);
            before = last;
        }
        self.jump(before, still, self.sample(self.pieces.len()));
    }

    /// Checks a jump between two accelerations, each given with its error.
    fn jump(&mut self, before: (f64, f64), after: (f64, f64), moment: Moment) {
        let value = after.0 - before.0;
        if value.abs() > before.1 + after.1 + LIMIT_TOLERANCE * self.joint.acceleration {
            self.note(value.abs(), Limit::AccelerationJump, 0.0, value, moment);
        }
    }

    fn judge_rest(&mut self, limit: Limit, value: f64, sample: usize) {
        if value.abs() > LIMIT_TOLERANCE * self.joint.velocity + self.precision.velocity {
            self.note(value.abs(), limit, 0.0, value, self.sample(sample));
        }
    }

    /// Returns the part of a derivative of a piece that rounding of the recording's numbers explains.
    fn rounding_part(&self, piece: &Piece, of: &Sensitivity) -> f64 {
        let duration = piece.to - piece.from;
        let moved = 2.0 * self.precision.position + 2.0 * self.precision.time * self.speed(piece);
        // Divides step by step, because powers of short durations are far smaller.
        let over = |value: f64, order: i32| (0..order).fold(value, |value, _| value / duration);
        over(of.position * moved, of.order)
            + over(of.velocity * self.precision.velocity, of.order - 1)
            + over(of.acceleration * self.precision.acceleration, of.order - 2)
    }

    /// Returns the greatest speed on the piece, but at most the joint's top speed, because rounding does not explain faster
    /// motion.
    fn speed(&self, piece: &Piece) -> f64 {
        let duration = piece.to - piece.from;
        let mean = if duration > 0.0 { (piece.at(1.0) - piece.at(0.0))[self.k] / duration } else { 0.0 };
        let at = |u: f64| piece.derivative(Derivative::Velocity, u)[self.k].abs();
        mean.abs().max(at(0.0)).max(at(1.0)).min(self.joint.velocity * (1.0 + LIMIT_TOLERANCE))
    }
}

/// Changes of a derivative per unit of change in the positions, velocities or accelerations that define a piece. Times are in
/// units of the piece's duration.
struct Sensitivity {
    order: i32,
    position: f64,
    velocity: f64,
    acceleration: f64,
}

impl Sensitivity {
    /// Returns the sensitivity of a piece's derivative. It follows from the polynomials that multiply the position
    /// difference, the velocities and the accelerations:
    ///
    /// - degree 3: `3 u^2 - 2 u^3`; `u - 2 u^2 + u^3` and `u^3 - u^2`.
    /// - degree 4: `4 u^3 - 3 u^4`; `u - 3 u^3 + 2 u^4` and `u^4 - u^3`; `u^2 / 2 - u^3 + u^4 / 2`.
    /// - degree 5: `10 u^3 - 15 u^4 + 6 u^5`; `u - 6 u^3 + 8 u^4 - 3 u^5` and `-4 u^3 + 7 u^4 - 3 u^5`;
    ///   `(u^2 - 3 u^3 + 3 u^4 - u^5) / 2` and `(u^3 - 2 u^4 + u^5) / 2`.
    ///
    /// The numbers are rounded up. The unit tests compare them with samples.
    fn of(piece: &Piece, derivative: Derivative) -> Self {
        let (order, [position, velocity, acceleration]) = match (derivative, piece.degree()) {
            (Derivative::Position, _) => (0, [1.0, 0.5, 0.1]),
            (Derivative::Velocity, 4) => (1, [1.78, 1.0, 0.1]),
            (Derivative::Velocity, 5) => (1, [1.875, 1.0, 0.1]),
            (Derivative::Velocity, _) => (1, [1.5, 1.0, 0.0]),
            (Derivative::Acceleration, 4) => (2, [12.0, 12.0, 1.0]),
            (Derivative::Acceleration, 5) => (2, [5.78, 6.0, 1.0]),
            (Derivative::Acceleration, _) => (2, [6.0, 6.0, 0.0]),
            (Derivative::Jerk, 4) => (3, [48.0, 48.0, 6.0]),
            (Derivative::Jerk, 5) => (3, [60.0, 60.0, 12.0]),
            (Derivative::Jerk, _) => (3, [12.0, 12.0, 0.0]),
        };
        Self { order, position, velocity, acceleration }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the sensitivities with samples of pieces whose data are unit changes.
    #[test]
    fn sensitivities_are_those_of_the_pieces() {
        let unit = |i: usize, k: usize| Configuration::repeat(if i == k { 1.0 } else { 0.0 });
        // Data 0 to 5: positions, velocities, accelerations of the beginning and the end.
        let piece = |degree: usize, k: usize| {
            let [p, v, a] = [0, 2, 4].map(|i| [unit(i, k), unit(i + 1, k)]);
            match degree {
                3 => Piece::hermite(0.0, 1.0, [p[0], v[0]], [p[1], v[1]]),
                4 => Piece::quartic(0.0, 1.0, [p[0], v[0], a[0]], [p[1], v[1]]),
                _ => Piece::quintic(0.0, 1.0, [p[0], v[0], a[0]], [p[1], v[1], a[1]]),
            }
        };
        for (degree, accelerations) in [(3, 0..0), (4, 4..5), (5, 4..6)] {
            for of in [Derivative::Velocity, Derivative::Acceleration, Derivative::Jerk] {
                let claimed = Sensitivity::of(&piece(degree, 0), of);
                let greatest = |data: std::ops::Range<usize>| {
                    let at = |u: f64| data.clone().map(|k| piece(degree, k).derivative(of, u)[0].abs()).sum::<f64>();
                    (0..=10_000).map(|i| at(f64::from(i) / 1e4)).fold(0.0, f64::max)
                };
                for (seen, claimed) in [
                    (greatest(1..2), claimed.position),
                    (greatest(2..4), claimed.velocity),
                    (greatest(accelerations.clone()), claimed.acceleration),
                ] {
                    assert!(
                        seen <= claimed + 1e-12 && claimed <= 1.6 * seen + 0.01,
                        "{degree}, {of:?}: {seen} {claimed}"
                    );
                }
            }
        }
    }
}
