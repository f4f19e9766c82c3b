//! Certificate content about tasks.

use crate::decimal::Decimal;
use serde::Deserialize;
use serde_json::value::RawValue;

/// A step of a task, with the part of the motion that executes it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExecutedStep {
    /// Number of the step in the world file, from 1.
    pub step: usize,
    /// Indices of the first and the last knot of the step's motion.
    pub knots: [usize; 2],
    /// Angle by which the wrist turns the load to the left before a place or after a pick, radians.
    pub turn: Option<Decimal>,
    /// Knots of the turn: time, angle so far and angular velocity. `None` if the arm rests during the turn.
    pub turning: Option<Vec<[Decimal; 3]>>,
    /// Knots of the stroke that lowers the tool: time, value and velocity of the stroke's joint. `None` if the arm rests
    /// during this stroke.
    pub lowering: Option<Vec<[Decimal; 3]>>,
    /// Knots of the stroke that raises the tool after the step. `None` if the arm rests during this stroke.
    pub raising: Option<Vec<[Decimal; 3]>>,
    /// Knots of the stroke that raises the tool before the first step. `None` if the arm rests during this stroke.
    pub raising_first: Option<Vec<[Decimal; 3]>>,
    /// The line as JSON, for a step along a line. The crate `cplan-check-line` reads it.
    pub line: Option<Box<RawValue>>,
}
