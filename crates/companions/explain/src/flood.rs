//! Sets of free IK solutions that are connected by certified straight motions, and the trees of these motions.

use super::motion_tree::Origin;
use super::reach::{Access, Reach};
use cplan_interrupt::checkpoint;
use cplan_judge::certify;
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// A free solution.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    pub place: usize,
    /// Index among the solutions of its place.
    pub index: usize,
    /// Index among all solutions.
    pub number: usize,
    pub joints: Configuration,
}

/// A solution that a flood reaches, and the origin of the straight motion to it.
#[derive(Debug, Clone, Copy)]
pub struct Reached {
    pub node: usize,
    pub origin: Origin,
}

/// A node in the queue, ordered by the length of the motion to it.
#[derive(PartialEq)]
struct Waiting {
    length: f64,
    node: usize,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.length.total_cmp(&other.length).then(self.node.cmp(&other.node))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Beginning of a straight motion: the configuration, and the length of the motion up to there.
#[derive(Clone, Copy)]
struct Beginning {
    origin: Origin,
    joints: Configuration,
    length: f64,
}

/// The free solutions of all cells.
pub struct Solutions<'a> {
    scene: &'a Scene,
    pub nodes: Vec<Node>,
    /// Index of the first node of each cell, and the number of nodes.
    firsts: Vec<usize>,
    size: [usize; 2],
    /// For each node that a flood reached, the beginning of the straight motion to it, and the length of the whole motion.
    arrivals: Vec<Option<(Beginning, f64)>>,
    /// True for the nodes of earlier floods.
    visited: Vec<bool>,
}

impl<'a> Solutions<'a> {
    /// Collects the solutions whose reachability is not known.
    pub fn new(scene: &'a Scene, reach: &Reach) -> Self {
        let mut firsts = Vec::with_capacity(reach.places.len() + 1);
        let mut nodes = Vec::new();
        let mut number = 0;
        for (place, solutions) in reach.places.iter().enumerate() {
            firsts.push(nodes.len());
            for (index, solution) in solutions.iter().enumerate() {
                if solution.access == Access::Unknown {
                    nodes.push(Node { place, index, number, joints: solution.joints });
                }
                number += 1;
            }
        }
        firsts.push(nodes.len());
        let (arrivals, visited) = (vec![None; nodes.len()], vec![false; nodes.len()]);
        Self { scene, nodes, firsts, size: reach.size, arrivals, visited }
    }

    /// Returns all nodes, those near a configuration first.
    pub fn by_distance(&self, from: Configuration) -> Vec<usize> {
        let mut order: Vec<(f64, usize)> =
            self.nodes.iter().enumerate().map(|(node, n)| (self.distance(from, n.joints), node)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        order.into_iter().map(|(_, node)| node).collect()
    }

    /// Returns true if a flood has reached a node.
    pub fn is_visited(&self, node: usize) -> bool {
        self.visited[node]
    }

    /// Finds all nodes that certified motions connect with `seed`, from cell to neighbouring cell, except those of
    /// earlier floods. `route` is the origin of the motion to the seed, with the configuration there. If a node occurs
    /// several times in the result, the last motion to it is the shortest. A certified straight motion from an earlier
    /// node replaces the detour through the cells, so motions are short and have few waypoints.
    ///
    /// This is the algorithm Theta* without a goal (Nash, Daniel, Koenig and Felner, 2007).
    pub fn flood(&mut self, seed: usize, route: Option<(Origin, Configuration)>) -> Vec<Reached> {
        let joints = self.nodes[seed].joints;
        let (origin, from) = route.unwrap_or((Origin::Solution(self.nodes[seed].number), joints));
        let beginning = Beginning { origin, joints: from, length: 0.0 };
        let length = self.distance(from, joints);
        self.arrivals[seed] = Some((beginning, length));
        let mut waiting = BinaryHeap::from([Reverse(Waiting { length, node: seed })]);
        let mut reached: Vec<Reached> = Vec::new();
        while let Some(Reverse(Waiting { length, node })) = waiting.pop() {
            checkpoint();
            let Some((before, best)) = self.arrivals[node] else { continue };
            if length > best {
                continue;
            }
            reached.push(Reached { node, origin: before.origin });
            let here = Beginning {
                origin: Origin::Solution(self.nodes[node].number),
                joints: self.nodes[node].joints,
                length,
            };
            for place in self.neighbours(self.nodes[node].place) {
                let Some(next) = self.nearest(place, here.joints).filter(|&next| !self.visited[next]) else { continue };
                for beginning in [before, here] {
                    let to = self.nodes[next].joints;
                    let length = beginning.length + self.distance(beginning.joints, to);
                    if self.arrivals[next].is_some_and(|(_, known)| known <= length) {
                        break;
                    }
                    if self.is_straight_motion_free(beginning.joints, to) {
                        self.arrivals[next] = Some((beginning, length));
                        waiting.push(Reverse(Waiting { length, node: next }));
                        break;
                    }
                }
            }
        }
        reached.iter().for_each(|Reached { node, .. }| self.visited[*node] = true);
        reached
    }

    fn distance(&self, from: Configuration, to: Configuration) -> f64 {
        self.scene.arm().topology().distance(from, to)
    }

    /// Returns the cells that share a side or a corner with a cell.
    fn neighbours(&self, place: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = self.size;
        let [x, y] = [place % columns, place / columns];
        let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let places = around(y, rows).flat_map(move |row| around(x, columns).map(move |column| row * columns + column));
        places.filter(move |&other| other != place)
    }

    /// Returns the solution of a cell that is nearest to a configuration. If the solutions have different elbows, it is
    /// the one with the same elbow.
    fn nearest(&self, place: usize, joints: Configuration) -> Option<usize> {
        let far = |&node: &usize| self.distance(joints, self.nodes[node].joints);
        (self.firsts[place]..self.firsts[place + 1]).min_by(|a, b| far(a).total_cmp(&far(b)))
    }

    /// Returns true if the straight motion between two configurations is certified. On a circle, it takes the shorter
    /// direction.
    fn is_straight_motion_free(&self, from: Configuration, to: Configuration) -> bool {
        let displacement = self.scene.arm().topology().displacement(from, to);
        certify(self.scene, Path::new(vec![from, from + displacement])).is_ok()
    }
}
