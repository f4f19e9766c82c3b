//! Chains of adjacent boxes.
//!
//! These searches do not use petgraph for three reasons. Boxes are split between searches, so a graph would have to be built
//! again each time. Free boxes cost nothing, so a double-ended queue can replace a heap. The cost of a path depends on the point
//! where it enters a box.

use super::boxes::portal;
use cplan_geometry::OpenList;
use cplan_interrupt::checkpoint;
use cplan_judge::Cell;
use cplan_model::space::{Configuration, GoalSet, Measure, Metric, Segment, Topology};
use std::collections::VecDeque;

const NO_BOX: u32 = u32::MAX;

/// State of a box that may contain free configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Openness {
    /// Entirely free.
    Free,
    /// Neither proven free nor proven in collision.
    Undecided,
    /// Undecided, and halving would not help.
    Finest,
}

/// Boxes, identified by indices, that cover the domain without overlapping.
pub(super) trait Mosaic {
    /// Returns an upper bound on indices: all are below it.
    fn count(&self) -> usize;
    /// Returns the configurations of a box.
    fn cell(&self, index: u32) -> Cell;
    /// Returns the state of a box. `None` for a collision box or a split box.
    fn openness(&self, index: u32) -> Option<Openness>;
    /// Calls `f`, in a fixed order, with the boxes that share a side with this one.
    fn for_each_neighbor(&self, index: u32, f: impl FnMut(u32));
    /// Returns a box that contains `q` and is not a collision box.
    fn locate(&self, q: Configuration) -> Option<u32>;
    /// Returns all boxes that meet a segment in the domain and are not collision boxes. For a point, one of them suffices.
    fn meeting(&self, piece: &Segment) -> Vec<u32>;
    /// Returns the topology of the configuration space.
    fn topology(&self) -> &Topology;
}

/// The index of a box, and a goal segment within the box.
pub(super) type End = (u32, Segment);

/// Returns the parts of goals in boxes that are not collision boxes, sorted by the boxes' indices.
pub(super) fn ends(boxes: &impl Mosaic, goals: &GoalSet) -> Vec<End> {
    let mut ends: Vec<End> = Vec::new();
    for piece in goals.wrapped(boxes.topology()) {
        ends.extend(boxes.meeting(&piece).into_iter().map(|index| (index, boxes.cell(index).part(&piece))));
    }
    ends.sort_by_key(|end| end.0);
    ends
}

/// Returns the goals within a box. `ends` must be sorted by the boxes' indices.
pub(super) fn ends_in(ends: &[End], index: u32) -> impl Iterator<Item = &Segment> {
    let first = ends.partition_point(|end| end.0 < index);
    ends[first..].iter().take_while(move |end| end.0 == index).map(|end| &end.1)
}

/// Finds the chain of adjacent boxes from `from` to one of `ends` with the fewest undecided boxes. Uses boxes that halving would
/// not decide only if `finest` is true. A breadth-first search in which free boxes cost nothing: `O(boxes + adjacencies)`.
pub(super) fn fewest_undecided(boxes: &impl Mosaic, from: u32, ends: &[End], finest: bool) -> Option<Vec<u32>> {
    let (_, parent, last) = search(boxes, &[from], ends, finest);
    last.map(|last| chain_to(&parent, last))
}

/// Returns all undecided boxes, ascending, on chains with the fewest undecided boxes. Takes two searches.
pub(super) fn all_of_fewest_undecided(boxes: &impl Mosaic, from: u32, ends: &[End], finest: bool) -> Vec<u32> {
    let (here, ..) = search(boxes, &[from], &[], finest);
    let starts: Vec<u32> = ends.iter().map(|end| end.0).collect();
    let (there, ..) = search(boxes, &starts, &[], finest);
    let cost = |index: usize| Some(here[index].checked_add(there[index])? - cost_of(boxes, index as u32, finest)?);
    let fewest = (0..here.len()).filter_map(cost).min();
    let mixed = |index: &usize| cost_of(boxes, *index as u32, finest) == Some(1);
    (0..here.len()).filter(mixed).filter(|&index| cost(index) == fewest).map(|index| index as u32).collect()
}

/// Returns the cost of passing a box: 0 if it is free, 1 if it is undecided. `None` if it cannot be passed.
fn cost_of(boxes: &impl Mosaic, index: u32, finest: bool) -> Option<u32> {
    match boxes.openness(index) {
        Some(Openness::Free) => Some(0),
        Some(Openness::Undecided) => Some(1),
        Some(Openness::Finest) if finest => Some(1),
        _ => None,
    }
}

/// Computes for each box the least cost of a chain from `starts` to it, including both ends, and the previous box on that chain.
/// Stops at the first of `ends`, and returns the index of its box.
fn search(boxes: &impl Mosaic, starts: &[u32], ends: &[End], finest: bool) -> (Vec<u32>, Vec<u32>, Option<u32>) {
    let mut cost = vec![u32::MAX; boxes.count()];
    let mut parent = vec![NO_BOX; boxes.count()];
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

/// Finds a chain of free boxes from the start, in box `from`, to a goal. Such a chain must exist. Dijkstra's search, with one
/// entry point per box, makes the polyline through the middles of its portals approximately the shortest.
pub(super) fn shortest(boxes: &impl Mosaic, start: Configuration, from: u32, ends: &[End]) -> Vec<u32> {
    let topology = boxes.topology();
    let mut length = vec![f64::INFINITY; boxes.count()];
    // The wrapped point at which the chain enters each box.
    let mut entry = vec![topology.wrap(start); boxes.count()];
    let mut parent = vec![NO_BOX; boxes.count()];
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
    chain_to(&parent, best.1)
}

/// Returns the chain that leads to `last`.
fn chain_to(parent: &[u32], last: u32) -> Vec<u32> {
    let mut chain = vec![last];
    let mut at = last;
    while parent[at as usize] != NO_BOX {
        at = parent[at as usize];
        chain.push(at);
    }
    chain.reverse();
    chain
}
