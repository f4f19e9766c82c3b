//! The proof that there is no path.

use super::cell::Cell;
use crate::model::Pair;

/// A box of configurations in which one and the same pair is too near everywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct StuckBox {
    /// Which configurations.
    pub cell: Cell,
    /// Which shapes.
    pub pair: Pair,
}

/// Proof that no motion leads from the start to any goal: what the stuck boxes leave of the domain does not connect
/// them. Whether they really do, [`super::recheck`] says.
#[derive(Debug, Clone, PartialEq)]
pub struct Disconnection {
    stuck: Vec<StuckBox>,
}

impl Disconnection {
    /// The stuck boxes: those around what can be reached from the start, or those around what can be reached from the
    /// goals, whichever are fewer.
    #[must_use]
    pub fn stuck(&self) -> &[StuckBox] {
        &self.stuck
    }

    /// The same of a scene in which the pairs are others: those that `pair` names. It is for [`super::recheck`] to say
    /// whether that proves anything.
    pub(crate) fn of_pairs(mut self, pair: impl Fn(Pair) -> Pair) -> Self {
        self.stuck.iter_mut().for_each(|stuck| stuck.pair = pair(stuck.pair));
        self
    }

    /// The proof that consists of these boxes.
    pub fn new(stuck: Vec<StuckBox>) -> Self {
        Self { stuck }
    }
}
