//! Certificate content about a motion.

use crate::decimal::Decimal;
use serde::Deserialize;

/// The motion that the robot executes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Interpolations with which the knots may be read. The motion must be free with each of them.
    pub interpolation: Vec<Interpolation>,
    /// Time, both joints' values, and their velocities and accelerations as far as an interpolation needs them.
    pub knots: Vec<Vec<Decimal>>,
}

/// Interpolation between knots.
#[derive(Deserialize, Clone, Copy, PartialEq, PartialOrd)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubic polynomials that match values and velocities at both knots.
    Cubic,
    /// Polynomials of degree 4 that match value, velocity and acceleration at the first knot, and value and velocity at
    /// the second.
    Quartic,
    /// Polynomials of degree 5 that match values, velocities and accelerations at both knots.
    Quintic,
}
