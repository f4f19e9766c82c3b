//! Chains of adjacent boxes.
//!
//! Own searches, not petgraph's: boxes are split between one search and the next, so that there is no graph to keep; where
//! free boxes cost nothing a queue with two ends does for a heap; and what a way costs depends on where it has entered a box.

use super::boxes::portal;
use cplan_core::check::Cell;
use cplan_core::space::{Configuration, GoalSet, Measure, Metric, Segment, Topology};
use cplan_geometry::OpenList;
use cplan_interrupt::checkpoint;
use std::collections::VecDeque;

const NONE: u32 = u32::MAX;

/// What is known about a box that may hold free configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Openness {
    /// All of it is free.
    Free,
    /// Neither proven free nor proven stuck.
    Mixed,
    /// Undecided, and halves would tell no more.
    Finest,
}

/// Boxes side by side that cover the domain, by number.
pub(super) trait Mosaic {
    /// One more than the greatest number of a box.
    fn count(&self) -> usize;
    /// The configurations that a box holds.
    fn cell(&self, index: u32) -> Cell;
    /// None for a stuck box, or one that is there no more.
    fn openness(&self, index: u32) -> Option<Openness>;
    /// Calls `f` with the boxes that share a side with this one, in a fixed order.
    fn for_each_neighbor(&self, index: u32, f: impl FnMut(u32));
    /// A box that holds `q` and is not stuck.
    fn locate(&self, q: Configuration) -> Option<u32>;
    /// Boxes that are not stuck and hold any of a segment in the domain: all of them, but for a point one will do.
    fn meeting(&self, piece: &Segment) -> Vec<u32>;
    /// Of the configuration space.
    fn topology(&self) -> &Topology;
}

/// Goals in a box.
pub(super) type End = (u32, Segment);

/// The boxes that are not stuck and hold goals, and which, by number.
pub(super) fn ends(boxes: &impl Mosaic, goals: &GoalSet) -> Vec<End> {
    let mut ends: Vec<End> = Vec::new();
    for piece in goals.wrapped(boxes.topology()) {
        ends.extend(boxes.meeting(&piece).into_iter().map(|index| (index, boxes.cell(index).part(&piece))));
    }
    ends.sort_by_key(|end| end.0);
    ends
}

/// The goals in a box, of those given by number.
pub(super) fn ends_in(ends: &[End], index: u32) -> impl Iterator<Item = &Segment> {
    let first = ends.partition_point(|end| end.0 < index);
    ends[first..].iter().take_while(move |end| end.0 == index).map(|end| &end.1)
}

/// The chain of adjacent open boxes from `from` to one of `ends` with the fewest undecided ones, those of the finest
/// size only if `finest`: breadth-first search in which free boxes cost nothing. `O(boxes + adjacencies)`.
pub(super) fn fewest_mixed(boxes: &impl Mosaic, from: u32, ends: &[End], finest: bool) -> Option<Vec<u32>> {
    let (_, parent, last) = search(boxes, &[from], ends, finest);
    last.map(|last| back(&parent, last))
}

/// All undecided boxes, ascending, that lie on any of the chains with the fewest of them: two such searches.
pub(super) fn all_of_fewest_mixed(boxes: &impl Mosaic, from: u32, ends: &[End], finest: bool) -> Vec<u32> {
    let (here, ..) = search(boxes, &[from], &[], finest);
    let starts: Vec<u32> = ends.iter().map(|end| end.0).collect();
    let (there, ..) = search(boxes, &starts, &[], finest);
    let cost = |index: usize| Some(here[index].checked_add(there[index])? - cost_of(boxes, index as u32, finest)?);
    let fewest = (0..here.len()).filter_map(cost).min();
    let mixed = |index: &usize| cost_of(boxes, *index as u32, finest) == Some(1);
    (0..here.len()).filter(mixed).filter(|&index| cost(index) == fewest).map(|index| index as u32).collect()
}

/// What it costs to pass a box: nothing if it is free; none if it cannot be passed.
fn cost_of(boxes: &impl Mosaic, index: u32, finest: bool) -> Option<u32> {
    match boxes.openness(index) {
        Some(Openness::Free) => Some(0),
        Some(Openness::Mixed) => Some(1),
        Some(Openness::Finest) if finest => Some(1),
        _ => None,
    }
}

/// Costs of reaching each box from `starts`, their own included, and the box before it, until one of `ends` is reached.
fn search(boxes: &impl Mosaic, starts: &[u32], ends: &[End], finest: bool) -> (Vec<u32>, Vec<u32>, Option<u32>) {
    let mut cost = vec![u32::MAX; boxes.count()];
    let mut parent = vec![NONE; boxes.count()];
    let mut queue = VecDeque::new();
    for &start in starts {
        let Some(own) = cost_of(boxes, start, finest) else { continue };
        cost[start as usize] = own;
        if own == 0 { queue.push_front((0, start)) } else { queue.push_back((own, start)) }
    }
    while let Some((so_far, index)) = queue.pop_front() {
        checkpoint();
        if so_far > cost[index as usize] {
            continue;
        }
        if ends_in(ends, index).next().is_some() {
            return (cost, parent, Some(index));
        }
        boxes.for_each_neighbor(index, |next| {
            let Some(step) = cost_of(boxes, next, finest) else { return };
            if so_far + step < cost[next as usize] {
                cost[next as usize] = so_far + step;
                parent[next as usize] = index;
                if step == 0 { queue.push_front((so_far, next)) } else { queue.push_back((so_far + 1, next)) }
            }
        });
    }
    (cost, parent, None)
}

/// The chain of free boxes from the start, in box `from`, to a goal along which a polyline through the middles of the portals is
/// the shortest, as far as one way into each box tells (Dijkstra). Some chain must exist.
pub(super) fn shortest(boxes: &impl Mosaic, start: Configuration, from: u32, ends: &[End]) -> Vec<u32> {
    let topology = boxes.topology();
    let mut length = vec![f64::INFINITY; boxes.count()];
    // Where each box is entered, in the fundamental domain.
    let mut entry = vec![topology.wrap(start); boxes.count()];
    let mut parent = vec![NONE; boxes.count()];
    let mut open = OpenList::default();
    open.push(0.0, from);
    let mut best = (f64::INFINITY, from);
    length[from as usize] = 0.0;
    while let Some((so_far, index)) = open.pop() {
        checkpoint();
        if so_far >= best.0 {
            break;
        }
        if so_far > length[index as usize] {
            continue;
        }
        let at = entry[index as usize];
        for goals in ends_in(ends, index) {
            let total = so_far + goals.distance(Measure::from(Metric::Euclidean), at);
            if total < best.0 {
                best = (total, index);
            }
        }
        let cell = boxes.cell(index);
        boxes.for_each_neighbor(index, |next| {
            if boxes.openness(next) != Some(Openness::Free) {
                return;
            }
            let Some(portal) = portal(&cell, &boxes.cell(next), topology) else { return };
            let place = portal.middle();
            let longer = so_far + (place - at).norm();
            if longer < length[next as usize] {
                length[next as usize] = longer;
                entry[next as usize] = place - portal.shift;
                parent[next as usize] = index;
                open.push(longer, next);
            }
        });
    }
    back(&parent, best.1)
}

/// The chain that leads to `last`.
fn back(parent: &[u32], last: u32) -> Vec<u32> {
    let mut chain = vec![last];
    let mut at = last;
    while parent[at as usize] != NONE {
        at = parent[at as usize];
        chain.push(at);
    }
    chain.reverse();
    chain
}
