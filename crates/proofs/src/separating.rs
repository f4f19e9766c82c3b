//! Selection of the collision boxes that separate start and goals.

use super::boxes::{State, Subdivision};
use super::chain::Mosaic;
use cplan_core::check::{CollisionBox, Disconnection};
use cplan_core::space::{Configuration, GoalSet};

/// Selects the collision boxes that separate start and goals. The boxes of the subdivision that may be free must not
/// connect them.
///
/// The region that these boxes connect with the start is bounded by sides that it shares with collision boxes, or by
/// the limits. So these collision boxes alone separate it from everything else.
pub(super) fn separating(boxes: &Subdivision, start: Configuration, goals: &GoalSet) -> Disconnection {
    let (here, there) = (around(boxes, &start.into()), around(boxes, goals));
    let fewer = if there.len() < here.len() { there } else { here };
    let stuck = fewer.into_iter().filter_map(|index| {
        let node = &boxes.nodes[index as usize];
        if let State::Colliding(pair) = node.state { Some(CollisionBox { cell: node.cell, pair }) } else { None }
    });
    Disconnection::new(stuck.collect())
}

/// Returns the collision boxes, ascending, that share a side with the region connected to any of the places, and those
/// that contain places themselves. If there is only a single place, the latter count only if no other box contains it.
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
