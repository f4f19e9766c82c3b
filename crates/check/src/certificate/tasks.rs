//! Certificate content about tasks.

use crate::decimal::Decimal;
use serde::Deserialize;

/// A step with its part of the motion.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExecutedStep {
    /// Number in the world file, from 1.
    pub step: usize,
    /// First and last knot of its motion.
    pub knots: [usize; 2],
    /// Angle by which the wrist turns the load to the left afterwards, while the arm is at rest.
    pub turn: Option<Decimal>,
}
