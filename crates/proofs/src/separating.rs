//! Which stuck boxes separate start and goals.

use super::boxes::{State, Subdivision};
use super::chain::Mosaic;
use cplan_core::check::{Disconnection, StuckBox};
use cplan_core::space::{Configuration, GoalSet};

/// Of the stuck boxes of a subdivision whose open boxes do not connect start and goals, those that separate them.
///
/// What open boxes connect with the start is bounded by pieces of side that it shares with stuck boxes (or by the
/// limits), so these boxes alone separate it from all else.
pub(super) fn separating(boxes: &Subdivision, start: Configuration, goals: &GoalSet) -> Disconnection {
    let (here, there) = (around(boxes, &start.into()), around(boxes, goals));
    let fewer = if there.len() < here.len() { there } else { here };
    let stuck = fewer.into_iter().filter_map(|index| {
        let node = &boxes.nodes[index as usize];
        if let State::Stuck(pair) = node.state { Some(StuckBox { cell: node.cell, pair }) } else { None }
    });
    Disconnection::new(stuck.collect())
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
