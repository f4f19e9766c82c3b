//! Selects the collision boxes that separate start and goals.

use super::boxes::{State, Subdivision};
use super::chain::Mosaic;
use cplan_judge::{CollisionBox, Disconnection};
use cplan_model::space::{Configuration, GoalSet};

/// Selects the collision boxes that separate start and goals. Precondition: the other boxes of the subdivision do not connect
/// them.
///
/// The boxes that may be free and are connected with the start form a region. Its sides are shared with collision boxes, or are
/// limits of joints. So these collision boxes suffice to separate the start from the goals.
pub(super) fn separating(boxes: &Subdivision, start: Configuration, goals: &GoalSet) -> Disconnection {
    let (here, there) = (collision_boxes_beside(boxes, &start.into()), collision_boxes_beside(boxes, goals));
    let fewer = if there.len() < here.len() { there } else { here };
    let stuck = fewer.into_iter().filter_map(|index| {
        let node = &boxes.nodes[index as usize];
        if let State::Colliding(pair) = node.state { Some(CollisionBox { cell: node.cell, pair }) } else { None }
    });
    Disconnection::new(stuck.collect())
}

/// Returns the collision boxes, ascending, that share a side with the region connected to any of the places. Also returns the
/// collision boxes that contain places, unless the place is a single configuration that another box contains as well.
fn collision_boxes_beside(boxes: &Subdivision, places: &GoalSet) -> Vec<u32> {
    let mut reached = vec![false; boxes.nodes.len()];
    let mut waiting = Vec::new();
    let mut walls = Vec::new();
    for piece in places.wrapped(boxes.topology()) {
        let open = boxes.meeting(&piece);
        if open.is_empty() || !piece.is_point() {
            walls.extend(
                boxes.boxes_meeting(&piece).into_iter().filter(|&index| !boxes.nodes[index as usize].is_open()),
            );
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
