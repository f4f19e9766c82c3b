//! Pieces of motions: polynomials in time.

use super::bernstein::Polynomial;
use cplan_model::space::Configuration;

/// The value of a motion, or one of its derivatives by time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// The joint values themselves.
    Position,
    /// The first derivative, per second.
    Velocity,
    /// The second derivative, per second squared.
    Acceleration,
    /// The third derivative, per second cubed.
    Jerk,
}

/// A piece of a motion: one polynomial in time per joint, of degree 3, 4 or 5.
///
/// The polynomials have Bernstein form: for the degree `n` and `u` from 0 to 1,
/// `q(u) = sum binomial(n, i) u^i (1 - u)^(n - i) c_i`. The piece lies in the box around its control points `c_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Time at which the piece begins, seconds. In a motion without times, the number of its first waypoint.
    pub from: f64,
    /// Time at which the piece ends, in the same unit.
    pub to: f64,
    curve: Polynomial<Configuration>,
}

/// The state at an end of a piece: position, velocity, acceleration.
pub type State = [Configuration; 3];

impl Piece {
    fn new<const N: usize>(from: f64, to: f64, points: [Configuration; N]) -> Self {
        Self { from, to, curve: Polynomial::new(points) }
    }

    /// Creates the straight piece from `a` to `b` at constant velocity.
    pub fn line(from: f64, to: f64, a: Configuration, b: Configuration) -> Self {
        Self::new(from, to, [a, a + (b - a) / 3.0, b - (b - a) / 3.0, b])
    }

    /// Creates the cubic with these values and velocities at its ends (Hermite).
    pub fn hermite(from: f64, to: f64, [a, va]: [Configuration; 2], [b, vb]: [Configuration; 2]) -> Self {
        let third = (to - from) / 3.0;
        Self::new(from, to, [a, a + va * third, b - vb * third, b])
    }

    /// Creates the polynomial of degree four with this position, velocity and acceleration at its start, and position
    /// and velocity at its end.
    pub fn quartic(from: f64, to: f64, [a, va, aa]: State, [b, vb]: [Configuration; 2]) -> Self {
        let h = to - from;
        Self::new(from, to, [a, a + va * (h / 4.0), a + va * (h / 2.0) + aa * (h * h / 12.0), b - vb * (h / 4.0), b])
    }

    /// Creates the polynomial of degree five with these positions, velocities and accelerations at its ends.
    pub fn quintic(from: f64, to: f64, [a, va, aa]: State, [b, vb, ab]: State) -> Self {
        let h = to - from;
        let (one, two, bend) = (h / 5.0, h * 2.0 / 5.0, h * h / 20.0);
        Self::new(from, to, [a, a + va * one, a + va * two + aa * bend, b - vb * two + ab * bend, b - vb * one, b])
    }

    /// Creates the quadratic curve with these three control points, written as a cubic.
    pub fn quadratic(from: f64, to: f64, [a, b, c]: [Configuration; 3]) -> Self {
        Self::new(from, to, [a, (a + b * 2.0) / 3.0, (b * 2.0 + c) / 3.0, c])
    }

    /// Returns the control points, including the ends: one more than the degree.
    pub fn control(&self) -> &[Configuration] {
        self.curve.coefficients()
    }

    /// Returns the degree of the polynomials: 3, 4 or 5. Straight pieces are written as cubics.
    pub fn degree(&self) -> usize {
        self.curve.degree()
    }

    /// Returns the time at a share `u` of the piece.
    pub fn time(&self, u: f64) -> f64 {
        if u == 1.0 { self.to } else { self.from + u * (self.to - self.from) }
    }

    /// Returns the configuration at a share `u` of the piece. Exact at both ends.
    pub fn at(&self, u: f64) -> Configuration {
        self.curve.at(u)
    }

    /// Returns the value, or a derivative by time, at a share `u` of the piece. Derivatives are zero for a piece
    /// without duration.
    pub fn derivative(&self, of: Derivative, u: f64) -> Configuration {
        let duration = self.to - self.from;
        if of == Derivative::Position {
            return self.at(u);
        }
        if duration <= 0.0 {
            return Configuration::zeros();
        }
        let order = of as usize;
        let Some(scaled) = self.curve.differences(order) else { return Configuration::zeros() };
        // Divides step by step, because a power of a short duration could underflow.
        (0..order).fold(scaled.at(u), |value, k| value * ((self.degree() - k) as f64 / duration))
    }

    /// Iterates over the shares of the piece at which a joint's value or derivative can be extreme: both ends, and the zeros of
    /// the next derivative.
    pub fn critical(&self, of: Derivative, joint: usize) -> impl Iterator<Item = f64> {
        let slope = self.curve.differences(of as usize + 1).map(|slope| slope.map(|d| d[joint]));
        [0.0, 1.0].into_iter().chain(slope.map_or(Vec::new(), |slope| slope.zeros()))
    }

    /// Returns bounds on a weighted sum of both joints' derivatives by time, between two shares of the piece. They are the bounds
    /// of the control points, so they are exact for linear derivatives. Zero for a piece without duration.
    pub fn bounds_of_sum(&self, of: Derivative, weights: [f64; 2], [from, to]: [f64; 2]) -> [f64; 2] {
        let (order, duration) = (of as usize, self.to - self.from);
        let Some(scaled) = self.curve.differences(order).filter(|_| duration > 0.0) else { return [0.0; 2] };
        let part = scaled.map(|d| weights[0] * d[0] + weights[1] * d[1]).restricted(from, to);
        let factor = |value: f64| (0..order).fold(value, |value, k| value * ((self.degree() - k) as f64 / duration));
        let bound = |[low, high]: [f64; 2], value: &f64| [low.min(factor(*value)), high.max(factor(*value))];
        part.coefficients().iter().fold([f64::INFINITY, f64::NEG_INFINITY], bound)
    }

    /// Returns a bound on the magnitude of each joint's second derivative by `u` between two shares. It is exact for
    /// cubics.
    pub fn bend(&self, from: f64, to: f64) -> [f64; 2] {
        let factor = (self.degree() * (self.degree() - 1)) as f64;
        let Some(second) = self.curve.differences(2) else { return [0.0; 2] };
        [0, 1].map(|k| {
            let part = second.map(|d| d[k]).restricted(from, to);
            part.coefficients().iter().map(|c| (c * factor).abs()).fold(0.0, f64::max)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn q(a: f64, b: f64) -> Configuration {
        Configuration::new(a, b)
    }

    #[test]
    fn a_still_piece_has_no_rates() {
        let piece = Piece::line(1.0, 1.0, q(0.3, 0.4), q(0.3, 0.4));
        assert_eq!(piece.at(0.7), q(0.3, 0.4));
        assert_eq!(piece.derivative(Derivative::Velocity, 0.5), q(0.0, 0.0));
        assert_eq!(piece.bend(0.0, 1.0), [0.0; 2]);
    }

    /// Returns a piece of each degree through the same states.
    fn pieces(duration: f64, [a, va, aa, b, vb, ab]: [f64; 6]) -> [Piece; 3] {
        let (first, last) = ([q(a, b), q(va, vb), q(aa, ab)], [q(b, a), q(vb, va), q(ab, aa)]);
        let two = |[p, v, _]: State| [p, v];
        [
            Piece::hermite(0.0, duration, two(first), two(last)),
            Piece::quartic(0.0, duration, first, two(last)),
            Piece::quintic(0.0, duration, first, last),
        ]
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the states at the ends of pieces with differences of the motion, and the jerk with differences of the
        /// acceleration.
        #[test]
        fn a_piece_has_the_states_of_its_ends(
            values in prop::array::uniform6(-3.0..3.0_f64), duration in 0.1..5.0_f64, u in 0.001..0.999_f64,
        ) {
            let [a, va, aa, b, vb, ab] = values;
            for piece in pieces(duration, values) {
                let at = |of, u| piece.derivative(of, u);
                prop_assert_eq!([piece.at(0.0), piece.at(1.0)], [q(a, b), q(b, a)]);
                prop_assert!((at(Derivative::Velocity, 0.0) - q(va, vb)).amax() < 1e-10);
                prop_assert!((at(Derivative::Velocity, 1.0) - q(vb, va)).amax() < 1e-10);
                if piece.degree() > 3 {
                    prop_assert!((at(Derivative::Acceleration, 0.0) - q(aa, ab)).amax() < 1e-9);
                }
                if piece.degree() > 4 {
                    prop_assert!((at(Derivative::Acceleration, 1.0) - q(ab, aa)).amax() < 1e-9);
                }
                const STEP: f64 = 1e-4;
                for (of, next) in [
                    (Derivative::Position, Derivative::Velocity),
                    (Derivative::Velocity, Derivative::Acceleration),
                    (Derivative::Acceleration, Derivative::Jerk),
                ] {
                    let slope = (at(of, u + STEP) - at(of, u - STEP)) / (2.0 * STEP * duration);
                    let size = 1.0 + (0..=20).map(|i| at(next, f64::from(i) / 20.0).amax()).fold(0.0, f64::max);
                    prop_assert!((slope - at(next, u)).amax() < 1e-4 * size, "{:?} of {}", next, piece.degree());
                }
            }
        }

        /// Checks that 2000 samples are within the bounds, and that the bounds are tight.
        #[test]
        fn extremes_bound_the_samples(
            values in prop::array::uniform6(prop_oneof![Just(0.0), -3.0..3.0_f64]), duration in 0.01..5.0_f64,
            degree in 0..3_usize,
        ) {
            let piece = pieces(duration, values)[degree];
            for of in [Derivative::Position, Derivative::Velocity, Derivative::Acceleration, Derivative::Jerk] {
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
        fn the_bend_bounds_the_distance_from_the_chord(
            values in prop::array::uniform6(-3.0..3.0_f64), ends in (0.0..1.0_f64, 0.0..1.0_f64), at in 0.0..1.0_f64,
            degree in 0..3_usize,
        ) {
            let piece = pieces(1.5, values)[degree];
            let (from, to) = (ends.0.min(ends.1), ends.0.max(ends.1));
            let chord = piece.at(from) + (piece.at(to) - piece.at(from)) * at;
            let far = piece.at(from + (to - from) * at) - chord;
            for (k, bend) in piece.bend(from, to).into_iter().enumerate() {
                prop_assert!(far[k].abs() <= bend * (to - from) * (to - from) / 8.0 + 1e-13);
            }
        }
    }
}
