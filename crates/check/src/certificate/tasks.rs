//! What a certificate says of tasks.

use crate::decimal::Decimal;
use serde::Deserialize;

/// A step as it is done.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Done {
    /// Its number in the world file, from 1.
    pub step: usize,
    /// The first and the last knot of its motion.
    pub knots: [usize; 2],
    /// By how much the wrist turns what is carried while the arm stands still afterwards, to the left.
    pub turn: Option<Decimal>,
}
