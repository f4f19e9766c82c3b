//! Cubic pieces of motions.

use super::Configuration;

/// What of a motion is looked at: its value or a derivative by time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// The joint values themselves.
    Position,
    /// Per second.
    Velocity,
    /// Per second squared.
    Acceleration,
}

/// A piece of a motion, cubic in time for each joint; straight ones included.
///
/// In Bernstein form: with `u` from 0 to 1 over the piece, `q(u) = sum binomial(3, i) u^i (1 - u)^(3 - i) c_i`. The
/// piece lies in the box of its control points `c_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Time at which it begins, seconds; without a clock, the number of its first waypoint.
    pub from: f64,
    /// Where it ends, in the same unit.
    pub to: f64,
    control: [Configuration; 4],
}

impl Piece {
    /// From `a` to `b` at constant velocity.
    #[must_use]
    pub fn line(from: f64, to: f64, a: Configuration, b: Configuration) -> Self {
        Self { from, to, control: [a, a + (b - a) / 3.0, b - (b - a) / 3.0, b] }
    }

    /// The cubic with these values and velocities at its ends (Hermite).
    #[must_use]
    pub fn hermite(from: f64, to: f64, [a, va]: [Configuration; 2], [b, vb]: [Configuration; 2]) -> Self {
        let third = (to - from) / 3.0;
        Self { from, to, control: [a, a + va * third, b - vb * third, b] }
    }

    /// The quadratic curve with these control points, raised to a cubic.
    #[must_use]
    pub fn quadratic(from: f64, to: f64, [a, b, c]: [Configuration; 3]) -> Self {
        Self { from, to, control: [a, (a + b * 2.0) / 3.0, (b * 2.0 + c) / 3.0, c] }
    }

    /// Its control points, the ends first and last.
    #[must_use]
    pub fn control(&self) -> &[Configuration; 4] {
        &self.control
    }

    /// Time at a share of the piece.
    #[must_use]
    pub fn time(&self, u: f64) -> f64 {
        if u == 1.0 { self.to } else { self.from + u * (self.to - self.from) }
    }

    /// Configuration at a share of the piece; exact at the ends.
    #[must_use]
    pub fn at(&self, u: f64) -> Configuration {
        // Mixed so, both ends come out exactly.
        let mix = |a: Configuration, b: Configuration| a * (1.0 - u) + b * u;
        let [a, b, c, d] = self.control;
        let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
        mix(mix(ab, bc), mix(bc, cd))
    }

    /// Value of a derivative by time at a share of the piece. A piece without duration stands still.
    #[must_use]
    pub fn derivative(&self, of: Derivative, u: f64) -> Configuration {
        let duration = self.to - self.from;
        if of != Derivative::Position && duration <= 0.0 {
            return Configuration::zeros();
        }
        let [d0, d1, d2] = self.differences();
        match of {
            Derivative::Position => self.at(u),
            Derivative::Velocity => {
                let v = 1.0 - u;
                (d0 * (v * v) + d1 * (2.0 * u * v) + d2 * (u * u)) * (3.0 / duration)
            }
            Derivative::Acceleration => ((d1 - d0) * (1.0 - u) + (d2 - d1) * u) * (6.0 / duration) / duration,
        }
    }

    /// Shares of the piece among which one joint's value (or derivative) is least and greatest: both ends, and where its
    /// own derivative vanishes.
    pub fn critical(&self, of: Derivative, joint: usize) -> impl Iterator<Item = f64> {
        let [d0, d1, d2] = self.differences().map(|d| d[joint]);
        // The derivative of the value is 3 (c + b u + a u^2), that of the velocity proportional to b + 2 a u.
        let (a, b, c) = (d0 - 2.0 * d1 + d2, 2.0 * (d1 - d0), d0);
        let inner = match of {
            Derivative::Position => roots(a, b, c),
            Derivative::Velocity => [-b / (2.0 * a), f64::NAN],
            Derivative::Acceleration => [f64::NAN; 2],
        };
        [0.0, 1.0].into_iter().chain(inner.into_iter().filter(|u| 0.0 < *u && *u < 1.0))
    }

    /// Greatest magnitude of each joint's second derivative by `u` between two shares: it is linear, so at one of them.
    #[must_use]
    pub fn bend(&self, from: f64, to: f64) -> [f64; 2] {
        let [d0, d1, d2] = self.differences();
        let at = |u: f64| ((d1 - d0) * (1.0 - u) + (d2 - d1) * u) * 6.0;
        let (first, last) = (at(from), at(to));
        [0, 1].map(|k| first[k].abs().max(last[k].abs()))
    }

    fn differences(&self) -> [Configuration; 3] {
        let [a, b, c, d] = self.control;
        [b - a, c - b, d - c]
    }
}

/// Real roots of `a u^2 + b u + c` without cancellation; NaN or infinite where there is none.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let s = -0.5 * (b + discriminant.sqrt().copysign(b));
    [s / a, c / s]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn q(a: f64, b: f64) -> Configuration {
        Configuration::new(a, b)
    }

    #[test]
    fn the_cubic_of_a_quadratic_motion_is_that_motion() {
        // 1 + 0.5 t - 0.75 t^2 from t = 2 to 2.5.
        let position = |t: f64| 1.0 + 0.5 * t - 0.75 * t * t;
        let velocity = |t: f64| 0.5 - 1.5 * t;
        let ends = [2.0, 2.5].map(|t| [q(position(t), -3.0 * position(t)), q(velocity(t), -3.0 * velocity(t))]);
        let piece = Piece::hermite(2.0, 2.5, ends[0], ends[1]);
        for i in 0..=10 {
            let u = f64::from(i) / 10.0;
            let t = piece.time(u);
            for (of, value) in [
                (Derivative::Position, position(t)),
                (Derivative::Velocity, velocity(t)),
                (Derivative::Acceleration, -1.5),
            ] {
                assert!((piece.derivative(of, u) - q(value, -3.0 * value)).norm() < 1e-12, "{of:?} at {t}");
            }
        }
    }

    #[test]
    fn a_still_piece_has_no_rates() {
        let piece = Piece::line(1.0, 1.0, q(0.3, 0.4), q(0.3, 0.4));
        assert_eq!(piece.at(0.7), q(0.3, 0.4));
        assert_eq!(piece.derivative(Derivative::Velocity, 0.5), q(0.0, 0.0));
        assert_eq!(piece.bend(0.0, 1.0), [0.0; 2]);
    }

    proptest! {
        #![proptest_config(crate::random::cases(256))]

        /// Extremes against 2000 samples; what is bounded against what was seen, and never far from it.
        #[test]
        fn extremes_bound_the_samples(
            values in prop::array::uniform4(prop_oneof![Just(0.0), -3.0..3.0_f64]), duration in 0.01..5.0_f64,
        ) {
            let [a, va, b, vb] = values;
            let piece = Piece::hermite(0.0, duration, [q(a, b), q(va, vb)], [q(b, a), q(vb, va)]);
            for of in [Derivative::Position, Derivative::Velocity, Derivative::Acceleration] {
                for joint in 0..2 {
                    let value = |u: f64| piece.derivative(of, u)[joint];
                    let greatest = piece.critical(of, joint).map(value).fold(f64::NEG_INFINITY, f64::max);
                    let least = piece.critical(of, joint).map(value).fold(f64::INFINITY, f64::min);
                    let seen = (0..=2000).map(|i| value(f64::from(i) / 2000.0));
                    let (low, high) = seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
                    let size = 1e-12 * (1.0 + greatest.abs().max(least.abs()));
                    prop_assert!(high <= greatest + size && least <= low + size);
                    let step = (greatest - least) * 3e-3 + size;
                    prop_assert!(greatest <= high + step && low - step <= least);
                }
            }
        }

        #[test]
        fn a_piece_stays_as_near_to_its_chord_as_its_bend_says(
            values in prop::array::uniform4(-3.0..3.0_f64), ends in (0.0..1.0_f64, 0.0..1.0_f64), at in 0.0..1.0_f64,
        ) {
            let [a, va, b, vb] = values;
            let piece = Piece::hermite(0.0, 1.5, [q(a, b), q(va, vb)], [q(b, a), q(vb, va)]);
            let (from, to) = (ends.0.min(ends.1), ends.0.max(ends.1));
            let chord = piece.at(from) + (piece.at(to) - piece.at(from)) * at;
            let far = piece.at(from + (to - from) * at) - chord;
            for (k, bend) in piece.bend(from, to).into_iter().enumerate() {
                prop_assert!(far[k].abs() <= bend * (to - from) * (to - from) / 8.0 + 1e-13);
            }
        }
    }
}
