//! Elimination in a network of unit resistances, without subtractions.

use cplan_interrupt::checkpoint;
use std::collections::VecDeque;

/// Index that stands for a missing link or node.
const NO_LINK: u32 = u32::MAX;

/// Number of right-hand sides that are solved together.
pub(super) const RIGHT_SIDES: usize = 2;

/// The remaining nodes are solved as a dense matrix once their number is at most this multiple of the least number of links of a
/// node.
const DENSE_RATIO: usize = 4;

/// A system of equations `(ground + sum of weights) u = source + sum of weight * neighbour's u`, one for each node. Its solution
/// is the potentials in a network of conductances, where `ground` is the conductance to known potentials. The network is
/// eliminated by Gauss's algorithm in the form of Grassmann, Taksar and Heyman (1985), in which a pivot is the sum of the weights
/// that lead away from the node. It only adds, multiplies and divides non-negative numbers. So every unknown has a relative error
/// of a few roundings per node on which it depends, however small it is (O'Cinneide 1993).
#[derive(Debug, Clone, Default)]
pub(super) struct Network {
    /// First link of each node. The links of an eliminated node lead to the nodes that remained when it was eliminated.
    first: Vec<u32>,
    degree: Vec<u32>,
    ground: Vec<f64>,
    source: Vec<[f64; RIGHT_SIDES]>,
    links: Vec<Link>,
    /// First unused link.
    spare: u32,
}

#[derive(Debug, Clone, Copy)]
struct Link {
    to: u32,
    next: u32,
    weight: f64,
}

impl Network {
    /// Creates nodes without links.
    pub fn new(nodes: usize) -> Self {
        Self {
            first: vec![NO_LINK; nodes],
            degree: vec![0; nodes],
            ground: vec![0.0; nodes],
            source: vec![[0.0; RIGHT_SIDES]; nodes],
            links: Vec::with_capacity(4 * nodes),
            spare: NO_LINK,
        }
    }

    /// Joins a node to known potentials. `weight` is the sum of the conductances. `source` is, for each right-hand side, the sum
    /// of the products of potential and conductance.
    pub fn ground(&mut self, node: usize, weight: f64, source: [f64; RIGHT_SIDES]) {
        self.ground[node] += weight;
        for (sum, source) in self.source[node].iter_mut().zip(source) {
            *sum += weight * source;
        }
    }

    /// Adds a link in one direction between two different nodes. The opposite direction is another link.
    pub fn join(&mut self, node: usize, to: usize, weight: f64) {
        let mut at = self.first[node];
        while at != NO_LINK {
            let link = &mut self.links[at as usize];
            if link.to as usize == to {
                link.weight += weight;
                return;
            }
            at = link.next;
        }
        self.add(node, to as u32, weight);
    }

    fn add(&mut self, node: usize, to: u32, weight: f64) {
        let link = Link { to, next: self.first[node], weight };
        let at = self.spare;
        if at == NO_LINK {
            self.first[node] = self.links.len() as u32;
            self.links.push(link);
        } else {
            self.spare = self.links[at as usize].next;
            self.links[at as usize] = link;
            self.first[node] = at;
        }
        self.degree[node] += 1;
    }

    /// Returns the unknowns. Nodes are eliminated in order of least degree, which in trees and corridors costs a constant time
    /// per node. For wide rooms, [`super::peeling`] uses another solver.
    pub fn solve(mut self) -> Vec<[f64; RIGHT_SIDES]> {
        let order = self.eliminate();
        let mut solution = vec![[0.0; RIGHT_SIDES]; self.first.len()];
        self.solve_rest(&order, &mut solution);
        for &node in order.iter().rev() {
            let node = node as usize;
            let mut value = self.source[node];
            let mut at = self.first[node];
            while at != NO_LINK {
                let link = self.links[at as usize];
                for (value, other) in value.iter_mut().zip(solution[link.to as usize]) {
                    *value += link.weight * other;
                }
                at = link.next;
            }
            // Elimination has replaced the ground by the pivot.
            solution[node] = value.map(|value| value / self.ground[node]);
        }
        solution
    }

    /// Solves for the remaining nodes, whose links form a dense matrix.
    fn solve_rest(&self, order: &[u32], solution: &mut [[f64; RIGHT_SIDES]]) {
        let mut number = vec![0; self.first.len()];
        order.iter().for_each(|&node| number[node as usize] = NO_LINK);
        let rest: Vec<usize> = (0..number.len()).filter(|&node| number[node] != NO_LINK).collect();
        rest.iter().enumerate().for_each(|(k, &node)| number[node] = k as u32);
        let n = rest.len();
        // Rows of weights. The last columns are ground and sources.
        let width = n + 1 + RIGHT_SIDES;
        let mut rows = vec![0.0; n * width];
        for (row, &node) in rows.chunks_exact_mut(width).zip(&rest) {
            let mut at = self.first[node];
            while at != NO_LINK {
                let link = self.links[at as usize];
                row[number[link.to as usize] as usize] = link.weight;
                at = link.next;
            }
            row[n] = self.ground[node];
            row[n + 1..].copy_from_slice(&self.source[node]);
        }
        for k in 0..n {
            checkpoint();
            let (done, left) = rows.split_at_mut((k + 1) * width);
            let row = &mut done[k * width..];
            row[k] = row[k + 1..=n].iter().sum();
            for other in left.chunks_exact_mut(width) {
                let share = other[k] / row[k];
                if share > 0.0 {
                    other[k + 1..].iter_mut().zip(&row[k + 1..]).for_each(|(other, own)| *other += share * own);
                }
            }
        }
        for k in (0..n).rev() {
            let row = &rows[k * width..(k + 1) * width];
            solution[rest[k]] = std::array::from_fn(|side| {
                let others = (k + 1..n).map(|l| row[l] * solution[rest[l]][side]);
                (row[n + 1 + side] + others.sum::<f64>()) / row[k]
            });
        }
    }

    /// Eliminates nodes until most of the remaining ones are linked with each other. Returns the eliminated nodes in order.
    fn eliminate(&mut self) -> Vec<u32> {
        let nodes = self.first.len();
        let mut order = Vec::with_capacity(nodes);
        let mut done = vec![false; nodes];
        // Nodes by degree, in order of arrival. Entries with an outdated degree are skipped.
        let mut waiting: Vec<VecDeque<u32>> = Vec::new();
        let enqueue = |waiting: &mut Vec<VecDeque<u32>>, degree: usize, node: u32| {
            if waiting.len() <= degree {
                waiting.resize_with(degree + 1, Default::default);
            }
            waiting[degree].push_back(node);
        };
        for node in 0..nodes {
            enqueue(&mut waiting, self.degree[node] as usize, node as u32);
        }
        let mut slot = vec![NO_LINK; nodes];
        let mut around: Vec<(u32, f64)> = Vec::new();
        let mut least = 0;
        while order.len() < nodes && nodes - order.len() > DENSE_RATIO * least {
            let Some(node) = waiting[least].pop_front() else {
                least += 1;
                continue;
            };
            let i = node as usize;
            if done[i] || self.degree[i] as usize != least {
                continue;
            }
            done[i] = true;
            order.push(node);
            checkpoint();
            around.clear();
            let mut pivot = self.ground[i];
            let mut at = self.first[i];
            while at != NO_LINK {
                let Link { to, next, weight } = self.links[at as usize];
                around.push((to, weight));
                pivot += weight;
                at = next;
            }
            let (ground, source) = (self.ground[i], self.source[i]);
            self.ground[i] = pivot;
            for &(to, weight) in &around {
                let j = to as usize;
                let share = weight / pivot;
                self.ground[j] += share * ground;
                for (sum, source) in self.source[j].iter_mut().zip(source) {
                    *sum += share * source;
                }
                self.unlink(j, node, &mut slot);
                for &(other, weight) in around.iter().filter(|other| other.0 != to) {
                    match slot[other as usize] {
                        NO_LINK => self.add(j, other, share * weight),
                        at => self.links[at as usize].weight += share * weight,
                    }
                }
                let mut at = self.first[j];
                while at != NO_LINK {
                    let link = self.links[at as usize];
                    slot[link.to as usize] = NO_LINK;
                    at = link.next;
                }
                let degree = self.degree[j] as usize;
                enqueue(&mut waiting, degree, to);
                least = least.min(degree);
            }
        }
        order
    }

    /// Removes the link from `node` to `gone`. Records the places of the node's other links in `slot`.
    fn unlink(&mut self, node: usize, gone: u32, slot: &mut [u32]) {
        let (mut before, mut at) = (NO_LINK, self.first[node]);
        while at != NO_LINK {
            let Link { to, next, .. } = self.links[at as usize];
            if to == gone {
                match before {
                    NO_LINK => self.first[node] = next,
                    before => self.links[before as usize].next = next,
                }
                self.links[at as usize].next = self.spare;
                self.spare = at;
                self.degree[node] -= 1;
            } else {
                slot[to as usize] = at;
                before = at;
            }
            at = next;
        }
    }
}
