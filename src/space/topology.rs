//! Intervals and circles: the only code that wraps configurations.

use super::Configuration;
use std::f64::consts::{PI, TAU};

/// The values one joint can take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Axis {
    /// From `lower` to `upper`, both included. For a revolute joint it may be longer than a full turn: then postures
    /// repeat within it, but configurations do not.
    Interval {
        /// Least value.
        lower: f64,
        /// Greatest value.
        upper: f64,
    },
    /// A joint without limits: values that differ by whole turns are one configuration.
    Circle,
}

impl Axis {
    /// Whether this is a circle.
    #[must_use]
    pub fn is_circle(self) -> bool {
        matches!(self, Axis::Circle)
    }

    /// The interval that represents every value once: the limits, or `[-pi, pi]`.
    #[must_use]
    pub fn domain(self) -> (f64, f64) {
        match self {
            Axis::Interval { lower, upper } => (lower, upper),
            Axis::Circle => (-PI, PI),
        }
    }

    /// Length of [`Axis::domain`].
    #[must_use]
    pub fn extent(self) -> f64 {
        let (lower, upper) = self.domain();
        upper - lower
    }

    /// Whether `value` is allowed. Circles allow all.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        match self {
            Axis::Interval { lower, upper } => lower <= value && value <= upper,
            Axis::Circle => value.is_finite(),
        }
    }

    /// The representative of `value` in the domain: itself on an interval, in `[-pi, pi)` on a circle.
    #[must_use]
    pub fn wrap(self, value: f64) -> f64 {
        match self {
            Axis::Interval { .. } => value,
            Axis::Circle if (-PI..PI).contains(&value) => value,
            Axis::Circle => {
                let wrapped = (value + PI).rem_euclid(TAU) - PI;
                if wrapped >= PI { -PI } else { wrapped }
            }
        }
    }

    /// The shortest signed way from `from` to `to`; on a circle in `[-pi, pi)`.
    #[must_use]
    pub fn displacement(self, from: f64, to: f64) -> f64 {
        match self {
            Axis::Interval { .. } => to - from,
            Axis::Circle => self.wrap(to - from),
        }
    }

    /// The copy of `value` nearest to `near`; exactly `value` on an interval, and on a circle where no turn is added.
    #[must_use]
    pub fn lift(self, value: f64, near: f64) -> f64 {
        match self {
            Axis::Interval { .. } => value,
            Axis::Circle => value + TAU * ((near - value) / TAU).round_ties_even(),
        }
    }

    /// The copies of `value` from `lower` to `upper`, ascending: on an interval only the value itself, wherever it lies.
    /// The bounds must be finite.
    pub fn copies_within(self, value: f64, (lower, upper): (f64, f64)) -> impl Iterator<Item = f64> {
        let turns = match self {
            Axis::Interval { .. } => 0..=0,
            Axis::Circle => ((lower - value) / TAU).ceil() as i64..=((upper - value) / TAU).floor() as i64,
        };
        turns.map(move |turn| value + turn as f64 * TAU)
    }
}

/// The configuration space as a manifold: a product of two axes (rectangle, cylinder or torus).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Topology {
    /// Base to tip.
    pub axes: [Axis; 2],
}

impl Topology {
    /// Whether both values are allowed.
    #[must_use]
    pub fn contains(&self, q: Configuration) -> bool {
        self.axes[0].contains(q[0]) && self.axes[1].contains(q[1])
    }

    /// The representative of `q` in the fundamental domain.
    #[must_use]
    pub fn wrap(&self, q: Configuration) -> Configuration {
        Configuration::new(self.axes[0].wrap(q[0]), self.axes[1].wrap(q[1]))
    }

    /// The shortest displacement from `from` to `to`.
    #[must_use]
    pub fn displacement(&self, from: Configuration, to: Configuration) -> Configuration {
        Configuration::new(self.axes[0].displacement(from[0], to[0]), self.axes[1].displacement(from[1], to[1]))
    }

    /// Euclidean length of the shortest displacement.
    #[must_use]
    pub fn distance(&self, from: Configuration, to: Configuration) -> f64 {
        self.displacement(from, to).norm()
    }

    /// The copy of `q` nearest to `near`, axis by axis as [`Axis::lift`].
    #[must_use]
    pub fn lift(&self, q: Configuration, near: Configuration) -> Configuration {
        Configuration::new(self.axes[0].lift(q[0], near[0]), self.axes[1].lift(q[1], near[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lifting_to_where_the_value_is_changes_no_bit() {
        let interval = Axis::Interval { lower: -7.0, upper: 7.0 };
        for (value, near) in [(0.1, 0.7), (-2.9, 3.0), (6.5, -6.5), (0.3, 1e9)] {
            assert_eq!(interval.lift(value, near), value);
        }
        for (value, near) in [(0.1, 0.7), (1e-17, 0.3), (3.0, 0.1), (-2.0, 1.0), (0.0, PI)] {
            assert_eq!(Axis::Circle.lift(value, near), value);
        }
        let cylinder = Topology { axes: [Axis::Circle, interval] };
        let lifted = cylinder.lift(Configuration::new(-3.0, 0.1), Configuration::new(3.0, -5.0));
        assert_eq!(lifted, Configuration::new(TAU - 3.0, 0.1));
    }

    #[test]
    fn copies_within_a_window_are_whole_turns_apart() {
        let copies = |axis: Axis, value, window| axis.copies_within(value, window).collect::<Vec<_>>();
        assert_eq!(copies(Axis::Circle, 1.0, (-TAU, TAU)), [1.0 - TAU, 1.0]);
        assert_eq!(copies(Axis::Circle, 0.0, (-TAU, TAU)), [-TAU, 0.0, TAU]);
        assert!(copies(Axis::Circle, 0.0, (1.0, 2.0)).is_empty());
        assert_eq!(copies(Axis::Interval { lower: 0.0, upper: 1.0 }, 0.5, (2.0, 3.0)), [0.5]);
    }

    proptest! {
        #![proptest_config(crate::random::cases(256))]

        #[test]
        fn copies_are_the_same_posture_and_the_lift_is_the_nearest(value in -50.0..50.0_f64, near in -50.0..50.0_f64) {
            let lifted = Axis::Circle.lift(value, near);
            for copy in [lifted, Axis::Circle.wrap(value), near + Axis::Circle.displacement(near, value)] {
                prop_assert!((copy.sin() - value.sin()).hypot(copy.cos() - value.cos()) < 1e-12);
            }
            prop_assert!((-PI..PI).contains(&Axis::Circle.wrap(value)));
            prop_assert!((lifted - near).abs() <= PI + 1e-12);
            prop_assert!(((lifted - near).abs() - Axis::Circle.displacement(near, value).abs()).abs() < 1e-12);
        }
    }
}
