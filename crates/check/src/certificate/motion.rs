//! Certificate content about a motion.

use crate::decimal::Decimal;
use serde::Deserialize;

/// The motion that the robot executes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Interpolations that a controller may use between the knots. The motion must be free with each of them.
    pub interpolation: Vec<Interpolation>,
    /// The knots. Each has the time, both joints' values, then their velocities, then their accelerations. Velocities
    /// and accelerations may be absent if no interpolation needs them.
    pub knots: Vec<Vec<Decimal>>,
}

/// Interpolation between knots.
#[derive(Deserialize, Clone, Copy, PartialEq, PartialOrd)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines between the values at the knots.
    Linear,
    /// Cubic polynomials that match values and velocities at both knots.
    Cubic,
    /// Polynomials of degree 4 that match value, velocity and acceleration at the first knot, and value and velocity at
    /// the second.
    Quartic,
    /// Polynomials of degree 5 that match values, velocities and accelerations at both knots.
    Quintic,
}
