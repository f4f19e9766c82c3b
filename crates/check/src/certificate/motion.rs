//! What a certificate says of a motion.

use crate::decimal::Decimal;
use serde::Deserialize;

/// What is played.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// The ways in which it can be read: it is free in each.
    pub interpolation: Vec<Interpolation>,
    /// Time, both joints' values, and as far as an interpolation needs them their velocities and accelerations.
    pub knots: Vec<Vec<Decimal>>,
}

/// How knots are joined.
#[derive(Deserialize, Clone, Copy, PartialEq, PartialOrd)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight.
    Linear,
    /// By the cubic with the values and velocities of both.
    Cubic,
    /// By the polynomial of the fourth degree with value, velocity and acceleration of the first, value and velocity of the second.
    Quartic,
    /// By the polynomial of the fifth degree with the values, velocities and accelerations of both.
    Quintic,
}
