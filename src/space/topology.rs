//! Intervals and circles: the only code that wraps angles.

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

    /// The copy of `value` nearest to `near`.
    #[must_use]
    pub fn lift(self, value: f64, near: f64) -> f64 {
        match self {
            Axis::Interval { .. } => value,
            Axis::Circle => near + self.displacement(near, value),
        }
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

    /// The copy of `q` nearest to `near`.
    #[must_use]
    pub fn lift(&self, q: Configuration, near: Configuration) -> Configuration {
        near + self.displacement(near, q)
    }
}
