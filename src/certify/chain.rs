//! Chains of adjacent boxes.

use super::boxes::{State, Subdivision};
use crate::space::Configuration;
use std::cmp::{Ordering, Reverse};
use std::collections::{BinaryHeap, VecDeque};

const NONE: u32 = u32::MAX;

/// The chain of adjacent open boxes from `from` to one of `ends` with the fewest undecided ones, those of the finest
/// size only if `finest`: breadth-first search in which free boxes cost nothing. `O(boxes + adjacencies)`.
pub(super) fn fewest_mixed(boxes: &Subdivision, from: u32, ends: &[u32], finest: bool) -> Option<Vec<u32>> {
    let (_, parent, last) = search(boxes, &[from], ends, finest);
    last.map(|last| back(&parent, last))
}

/// All undecided boxes, ascending, that lie on any of the chains with the fewest of them: two such searches.
pub(super) fn all_of_fewest_mixed(boxes: &Subdivision, from: u32, ends: &[u32], finest: bool) -> Vec<u32> {
    let (here, ..) = search(boxes, &[from], &[], finest);
    let (there, ..) = search(boxes, ends, &[], finest);
    let cost = |index: usize| Some(here[index].checked_add(there[index])? - cost_of(boxes, index as u32, finest)?);
    let fewest = (0..here.len()).filter_map(cost).min();
    let mixed = |index: &usize| cost_of(boxes, *index as u32, finest) == Some(1);
    (0..here.len()).filter(mixed).filter(|&index| cost(index) == fewest).map(|index| index as u32).collect()
}

/// What it costs to pass a box: nothing if it is free; none if it cannot be passed.
fn cost_of(boxes: &Subdivision, index: u32, finest: bool) -> Option<u32> {
    match boxes.nodes[index as usize].state {
        State::Free => Some(0),
        State::Mixed(_) => Some(1),
        State::Finest if finest => Some(1),
        _ => None,
    }
}

/// Costs of reaching each box from `starts`, their own included, and the box before it, until one of `ends` is reached.
fn search(boxes: &Subdivision, starts: &[u32], ends: &[u32], finest: bool) -> (Vec<u32>, Vec<u32>, Option<u32>) {
    let mut cost = vec![u32::MAX; boxes.nodes.len()];
    let mut parent = vec![NONE; boxes.nodes.len()];
    let mut queue = VecDeque::new();
    for &start in starts {
        let Some(own) = cost_of(boxes, start, finest) else { continue };
        cost[start as usize] = own;
        if own == 0 { queue.push_front((0, start)) } else { queue.push_back((own, start)) }
    }
    while let Some((so_far, index)) = queue.pop_front() {
        if so_far > cost[index as usize] {
            continue;
        }
        if ends.contains(&index) {
            return (cost, parent, Some(index));
        }
        for &next in &boxes.nodes[index as usize].neighbors {
            let Some(step) = cost_of(boxes, next, finest) else { continue };
            if so_far + step < cost[next as usize] {
                cost[next as usize] = so_far + step;
                parent[next as usize] = index;
                if step == 0 { queue.push_front((so_far, next)) } else { queue.push_back((so_far + 1, next)) }
            }
        }
    }
    (cost, parent, None)
}

/// A length in a queue.
#[derive(PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// The chain of free boxes from the start, in box `from`, to a goal along which the polyline through the middles of the
/// doors is the shortest, as far as one way into each box tells (Dijkstra). Some chain must exist.
pub(super) fn shortest(boxes: &Subdivision, start: Configuration, from: u32, goals: &[Configuration]) -> Vec<u32> {
    let topology = boxes.topology();
    let mut ends: Vec<(u32, Configuration)> = Vec::new();
    for &goal in goals {
        ends.extend(boxes.locate(goal).map(|index| (index, topology.wrap(goal))));
    }
    let mut length = vec![f64::INFINITY; boxes.nodes.len()];
    // Where each box is entered, in the fundamental domain.
    let mut entry = vec![topology.wrap(start); boxes.nodes.len()];
    let mut parent = vec![NONE; boxes.nodes.len()];
    let mut queue = BinaryHeap::from([Reverse((Length(0.0), from))]);
    let mut best = (f64::INFINITY, from);
    length[from as usize] = 0.0;
    while let Some(Reverse((Length(so_far), index))) = queue.pop() {
        if so_far >= best.0 {
            break;
        }
        let at = entry[index as usize];
        for (_, goal) in ends.iter().filter(|(end, _)| *end == index) {
            let total = so_far + (goal - at).norm();
            if total < best.0 {
                best = (total, index);
            }
        }
        let node = &boxes.nodes[index as usize];
        for &next in &node.neighbors {
            let beside = &boxes.nodes[next as usize];
            let Some(door) = node.cell.door(&beside.cell, topology).filter(|_| beside.state == State::Free) else {
                continue;
            };
            let longer = so_far + (door.middle() - at).norm();
            if longer < length[next as usize] {
                length[next as usize] = longer;
                entry[next as usize] = door.middle() - door.shift;
                parent[next as usize] = index;
                queue.push(Reverse((Length(longer), next)));
            }
        }
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
