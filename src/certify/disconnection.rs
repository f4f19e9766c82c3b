//! The proof that there is no path.

use super::boxes::{Cell, State, Subdivision};
use super::chain::Mosaic;
use crate::model::Pair;
use crate::space::{Configuration, GoalSet};

/// A box of configurations in which one and the same pair is too near everywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct StuckBox {
    /// Which configurations.
    pub cell: Cell,
    /// Which shapes.
    pub pair: Pair,
}

/// Proof that no motion leads from the start to any goal: what the stuck boxes leave of the domain does not connect
/// them. Only [`super::connectivity`] and [`super::slab_connectivity`] make one; anybody can check it, see [`super::recheck`].
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
    pub(super) fn of(stuck: Vec<StuckBox>) -> Self {
        Self { stuck }
    }

    /// Of the stuck boxes of a subdivision whose open boxes do not connect start and goals, those that separate them.
    ///
    /// What open boxes connect with the start is bounded by pieces of side that it shares with stuck boxes (or by the
    /// limits), so these boxes alone separate it from all else.
    pub(super) fn between(boxes: &Subdivision, start: Configuration, goals: &GoalSet) -> Self {
        let (here, there) = (around(boxes, &start.into()), around(boxes, goals));
        let fewer = if there.len() < here.len() { there } else { here };
        let stuck = fewer.into_iter().filter_map(|index| {
            let node = &boxes.nodes[index as usize];
            if let State::Stuck(pair) = node.state { Some(StuckBox { cell: node.cell, pair }) } else { None }
        });
        Self { stuck: stuck.collect() }
    }
}

/// The stuck boxes, ascending, that share a side with what open boxes connect with any of the places, and those that hold
/// places themselves; of a single place only if no open box holds it.
fn around(boxes: &Subdivision, places: &GoalSet) -> Vec<u32> {
    let mut reached = vec![false; boxes.nodes.len()];
    let mut waiting = Vec::new();
    let mut walls = Vec::new();
    for piece in places.wrapped(boxes.topology()) {
        let open = boxes.meeting(&piece);
        if open.is_empty() || !piece.is_point() {
            walls.extend(boxes.holding(&piece).into_iter().filter(|&index| !boxes.nodes[index as usize].is_open()));
        }
        waiting.extend(open);
    }
    waiting.iter().chain(&walls).for_each(|&index| reached[index as usize] = true);
    while let Some(index) = waiting.pop() {
        for &next in &boxes.nodes[index as usize].neighbors {
            if !std::mem::replace(&mut reached[next as usize], true) {
                let open = boxes.nodes[next as usize].is_open();
                if open { waiting.push(next) } else { walls.push(next) }
            }
        }
    }
    walls.sort_unstable();
    walls.dedup();
    walls
}
