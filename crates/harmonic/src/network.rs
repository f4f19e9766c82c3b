//! Elimination in a network of unit resistances, without a subtraction.

use cplan_interrupt::checkpoint;
use std::collections::VecDeque;

/// No link, no node.
const NONE: u32 = u32::MAX;

/// Sides of a linear system that are solved for together.
pub(super) const SIDES: usize = 2;

/// Nodes left for each link of the node with the fewest, at which links are no longer followed one by one.
const FULL: usize = 4;

/// Unknowns, each with `(ground + sum of weights) u = source + sum of weight * neighbour's u`: the potential in a network
/// of conductances, `ground` leading to where the potential is known.
///
/// Eliminated by Gauss's algorithm in the form of Grassmann, Taksar and Heyman (1985): a pivot is computed as the sum of
/// what leads away from the node, not by subtraction, so that only non-negative numbers are ever added, multiplied and
/// divided. Every unknown then has a relative error of some roundings for each node that it depends on, however small it
/// is (O'Cinneide 1993), and however little of a walk from it ever gets to a source.
#[derive(Debug, Clone, Default)]
pub(super) struct Network {
    /// First link of each node. Of an eliminated one: links to the nodes that were left when it was.
    first: Vec<u32>,
    degree: Vec<u32>,
    ground: Vec<f64>,
    source: Vec<[f64; SIDES]>,
    links: Vec<Link>,
    /// First link that is out of use.
    spare: u32,
}

#[derive(Debug, Clone, Copy)]
struct Link {
    to: u32,
    next: u32,
    weight: f64,
}

impl Network {
    /// Nodes without links.
    pub fn new(nodes: usize) -> Self {
        Self {
            first: vec![NONE; nodes],
            degree: vec![0; nodes],
            ground: vec![0.0; nodes],
            source: vec![[0.0; SIDES]; nodes],
            links: Vec::with_capacity(4 * nodes),
            spare: NONE,
        }
    }

    /// Joins a node to known potentials: `weight` to one of 0, or times that of the source.
    pub fn ground(&mut self, node: usize, weight: f64, source: [f64; SIDES]) {
        self.ground[node] += weight;
        for (sum, source) in self.source[node].iter_mut().zip(source) {
            *sum += weight * source;
        }
    }

    /// Joins two different nodes, one way: the other is another link.
    pub fn join(&mut self, node: usize, to: usize, weight: f64) {
        let mut at = self.first[node];
        while at != NONE {
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
        if at == NONE {
            self.first[node] = self.links.len() as u32;
            self.links.push(link);
        } else {
            self.spare = self.links[at as usize].next;
            self.links[at as usize] = link;
            self.first[node] = at;
        }
        self.degree[node] += 1;
    }

    /// The unknowns. Nodes are eliminated in the order of least degree: in trees and corridors that costs the same for each;
    /// for rooms and halls see [`super::peeling`], which gives the wide ones to another solver.
    pub fn solve(mut self) -> Vec<[f64; SIDES]> {
        let order = self.eliminate();
        let mut solution = vec![[0.0; SIDES]; self.first.len()];
        self.solve_rest(&order, &mut solution);
        for &node in order.iter().rev() {
            let node = node as usize;
            let mut value = self.source[node];
            let mut at = self.first[node];
            while at != NONE {
                let link = self.links[at as usize];
                for (value, other) in value.iter_mut().zip(solution[link.to as usize]) {
                    *value += link.weight * other;
                }
                at = link.next;
            }
            // The pivot took the place of the ground.
            solution[node] = value.map(|value| value / self.ground[node]);
        }
        solution
    }

    /// Solves for the nodes that were not eliminated: their links fill a matrix.
    fn solve_rest(&self, order: &[u32], solution: &mut [[f64; SIDES]]) {
        let mut number = vec![0; self.first.len()];
        order.iter().for_each(|&node| number[node as usize] = NONE);
        let rest: Vec<usize> = (0..number.len()).filter(|&node| number[node] != NONE).collect();
        rest.iter().enumerate().for_each(|(k, &node)| number[node] = k as u32);
        let n = rest.len();
        // Rows of weights; the last columns are ground and source.
        let width = n + 1 + SIDES;
        let mut rows = vec![0.0; n * width];
        for (row, &node) in rows.chunks_exact_mut(width).zip(&rest) {
            let mut at = self.first[node];
            while at != NONE {
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

    /// Eliminates nodes until those that are left are mostly linked with each other; the order.
    fn eliminate(&mut self) -> Vec<u32> {
        let nodes = self.first.len();
        let mut order = Vec::with_capacity(nodes);
        let mut done = vec![false; nodes];
        // Nodes by degree, first come first served; those that have another degree by now are passed over.
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
        let mut slot = vec![NONE; nodes];
        let mut around: Vec<(u32, f64)> = Vec::new();
        let mut least = 0;
        while order.len() < nodes && nodes - order.len() > FULL * least {
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
            while at != NONE {
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
                        NONE => self.add(j, other, share * weight),
                        at => self.links[at as usize].weight += share * weight,
                    }
                }
                let mut at = self.first[j];
                while at != NONE {
                    let link = self.links[at as usize];
                    slot[link.to as usize] = NONE;
                    at = link.next;
                }
                let degree = self.degree[j] as usize;
                enqueue(&mut waiting, degree, to);
                least = least.min(degree);
            }
        }
        order
    }

    /// Takes the link from `node` to `gone` out of use and notes in `slot` where the others are.
    fn unlink(&mut self, node: usize, gone: u32, slot: &mut [u32]) {
        let (mut before, mut at) = (NONE, self.first[node]);
        while at != NONE {
            let Link { to, next, .. } = self.links[at as usize];
            if to == gone {
                match before {
                    NONE => self.first[node] = next,
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
