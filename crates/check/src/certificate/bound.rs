//! Certificate content about lower bounds on the length of motions.

use crate::decimal::Decimal;
use serde::Deserialize;

/// A claim that no motion is shorter than a length.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// Target configuration. By default, this is the goal.
    pub to: Option<[Decimal; 2]>,
    /// Claimed lower bound on the length of every motion, in units of the metric.
    pub length: Decimal,
    /// Length metric.
    #[serde(default)]
    pub metric: Metric,
    /// Walls that block shorter motions.
    pub walls: Vec<Wall>,
    /// Claimed lower bounds on the length of paths to ends of walls.
    pub potentials: Vec<Potential>,
}

/// Metric: a rule that computes the length of a displacement from its two entries.
#[derive(Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// Root of the sum of squares.
    #[default]
    Euclidean,
    /// Root of the sum of squares, after each entry is multiplied by a factor.
    Weights([Decimal; 2]),
    /// The greater of the two times, seconds, that the joints need at these speeds.
    Speeds([Decimal; 2]),
    /// The greatest of three times, seconds: those of the two joints, and that of an elbow motor on the base.
    MotorSpeeds(MotorSpeeds),
    /// Root of the sum of squares of the angles of both motors. The number is the factor of joint 1 in the angle of the
    /// elbow's motor.
    Motor(Decimal),
}

/// Speeds of the joints, and of the sum `ratio q1 + q2` that the elbow's motor turns.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorSpeeds {
    /// Speeds of the joints.
    pub speeds: [Decimal; 2],
    /// Factor of joint 1 in the sum.
    pub ratio: Decimal,
    /// Speed of the sum.
    pub speed: Decimal,
}

/// A straight segment of configurations. A shape and a part overlap in all of them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// First configuration.
    pub from: [Decimal; 2],
    /// Last configuration.
    pub to: [Decimal; 2],
    /// Index into the certificate's shapes.
    pub shape: usize,
    /// Index into the certificate's parts.
    pub part: usize,
}

/// A lower bound on the length of all paths from the start to an end of a wall.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Potential {
    /// Index into the bound's walls.
    pub wall: usize,
    /// The end of the wall: 0 for its first configuration, 1 for its last.
    pub end: usize,
    /// Numbers of whole turns by which the wall as written is shifted along each joint. The bound applies to the shifted copy.
    #[serde(default)]
    pub turns: [i64; 2],
    /// The lower bound.
    pub value: Decimal,
}
