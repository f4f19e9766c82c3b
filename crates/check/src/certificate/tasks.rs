//! What a certificate says of tasks.

use super::StuckBox;
use crate::decimal::Decimal;
use crate::domain::Rectangle;
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

/// Some of the configurations from which a step may begin, and boxes of configurations that are not free then.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The step's number in the world file, from 1; one more than the last: when all is done.
    pub step: usize,
    /// In free order: the picks of the pairs that are done before, of which the last one was done last; in whichever order if it does not say.
    pub after: Option<Vec<usize>>,
    /// Where the arm is before it; the start if it does not say.
    pub from: Option<Rectangle>,
    /// From where to where it has carried what it has let go of, turned as it happened to be: those that the certificate follows, in order.
    pub turned: Option<Vec<[Rectangle; 2]>>,
    pub boxes: Vec<StuckBox>,
    /// Configurations that are not free while the tool is lowered where the step ends.
    pub lowered: Option<Vec<StuckBox>>,
}
