//! What a certificate says of ways that are shorter.

use crate::decimal::Decimal;
use serde::Deserialize;

/// That no motion is shorter than a length.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// Where to; by default to the goal.
    pub to: Option<[Decimal; 2]>,
    /// No motion is claimed to be shorter.
    pub length: Decimal,
    /// How lengths are measured.
    #[serde(default)]
    pub metric: Metric,
    /// What bars shorter motions.
    pub walls: Vec<Wall>,
    /// Lengths of the ways to ends of walls.
    pub potentials: Vec<Potential>,
}

/// How lengths of displacements are measured.
#[derive(Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// The root of the sum of squares, ...
    #[default]
    Euclidean,
    /// ... each entry times a factor before, ...
    Weights([Decimal; 2]),
    /// ... or the greater of the quotients by two speeds.
    Speeds([Decimal; 2]),
}

/// A straight segment of configurations in all of which a shape and a part overlap.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Where it begins.
    pub from: [Decimal; 2],
    /// Where it ends.
    pub to: [Decimal; 2],
    /// Into the shapes.
    pub shape: usize,
    /// Into the parts.
    pub part: usize,
}

/// A length that no way from the start to an end of a wall falls short of.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Potential {
    /// Into the walls.
    pub wall: usize,
    /// 0 where it begins, 1 where it ends.
    pub end: usize,
    /// Whole turns of each joint from where the wall is written to where it is meant.
    #[serde(default)]
    pub turns: [i64; 2],
    /// The length.
    pub value: Decimal,
}
