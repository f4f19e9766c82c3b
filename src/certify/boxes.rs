//! Subdivision of the configuration space into free, stuck and mixed boxes.

use super::deviation::{Deviation, Posture};
use crate::model::{Pair, Scene};
use crate::space::{Configuration, Topology};
use std::f64::consts::PI;

/// A closed rectangle of configurations in the fundamental domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Least value of each joint.
    pub lower: [f64; 2],
    /// Greatest value of each joint.
    pub upper: [f64; 2],
}

impl Cell {
    /// The middle.
    #[must_use]
    pub fn center(&self) -> Configuration {
        Configuration::new((self.lower[0] + self.upper[0]) / 2.0, (self.lower[1] + self.upper[1]) / 2.0)
    }

    /// Half of each side; rounded up, so that the box about the middle covers the cell.
    fn half(&self) -> [f64; 2] {
        [0, 1].map(|k| (self.upper[k] - self.lower[k]) / 2.0 * (1.0 + 4.0 * f64::EPSILON) + 2.0 * f64::EPSILON * PI)
    }

    pub(super) fn contains(&self, q: Configuration) -> bool {
        (0..2).all(|k| self.lower[k] <= q[k] && q[k] <= self.upper[k])
    }

    /// The two halves along `axis`.
    fn halves(&self, axis: usize) -> [Cell; 2] {
        let middle = self.center()[axis];
        let (mut below, mut above) = (*self, *self);
        below.upper[axis] = middle;
        above.lower[axis] = middle;
        [below, above]
    }

    /// Whether the two share a piece of side of positive length; if so, by how much the other is to be shifted along
    /// which axis to lie beside this one, and the middle of the shared piece. Corners do not count: where only a corner
    /// is shared, it belongs to the two other boxes as well.
    pub(super) fn shared_side(&self, other: &Cell, topology: &Topology) -> Option<(Configuration, Configuration)> {
        for axis in 0..2 {
            let across = 1 - axis;
            let (from, to) = (self.lower[across].max(other.lower[across]), self.upper[across].min(other.upper[across]));
            if from >= to {
                continue;
            }
            let side = |value: f64, shift: f64| {
                let (mut middle, mut by) = (Configuration::zeros(), Configuration::zeros());
                middle[axis] = value;
                middle[across] = (from + to) / 2.0;
                by[axis] = shift;
                Some((by, middle))
            };
            let (lower, upper) = topology.axes[axis].domain();
            let turn = if topology.axes[axis].is_circle() { upper - lower } else { 0.0 };
            if self.upper[axis] == other.lower[axis] {
                return side(self.upper[axis], 0.0);
            }
            if self.lower[axis] == other.upper[axis] {
                return side(self.lower[axis], 0.0);
            }
            if turn > 0.0 && self.upper[axis] == upper && other.lower[axis] == lower {
                return side(upper, turn);
            }
            if turn > 0.0 && self.lower[axis] == lower && other.upper[axis] == upper {
                return side(lower, -turn);
            }
        }
        None
    }
}

/// What is known about a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum State {
    /// No pair comes too near anywhere in it.
    Free,
    /// This pair is too near everywhere in it.
    Stuck(Pair),
    /// These pairs are undecided; no other pair comes too near.
    Mixed(Vec<Pair>),
    /// Replaced by its halves.
    Split,
}

pub(super) struct Node {
    pub cell: Cell,
    pub state: State,
    pub neighbors: Vec<u32>,
}

/// A subdivision that covers the whole domain, with its adjacencies.
pub(super) struct Subdivision<'a> {
    scene: &'a Scene,
    topology: Topology,
    clearance: f64,
    pub nodes: Vec<Node>,
}

/// Columns and rows to begin with; at least three, so that across a seam no box is its own neighbour.
const FIRST: usize = 8;

/// Link 1 alone is decided on intervals of `q1`, down to this share of the domain: they are as tall as the domain, so
/// fine ones cost nothing, and a thin wall of link 1 (a corner that just reaches an obstacle) needs fine ones.
const FINEST_COLUMN: f64 = 1e-8;

impl<'a> Subdivision<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let topology = scene.arm.topology();
        let mut this = Self { scene, topology, clearance, nodes: Vec::new() };
        let (bottom, top) = topology.axes[1].domain();
        let row = |j: usize| if j == FIRST { top } else { bottom + (top - bottom) * j as f64 / FIRST as f64 };
        let second: Vec<Pair> = scene.pairs().iter().copied().filter(|p| p.link == 1).collect();
        let mut cells = Vec::new();
        for (lower, upper, state) in this.columns() {
            if let State::Stuck(pair) = state {
                cells.push((Cell { lower: [lower, bottom], upper: [upper, top] }, State::Stuck(pair)));
                continue;
            }
            let left = if let State::Mixed(left) = state { left } else { Vec::new() };
            for j in 0..FIRST {
                let cell = Cell { lower: [lower, row(j)], upper: [upper, row(j + 1)] };
                let state = this.judge(&cell, &second, &left);
                cells.push((cell, state));
            }
        }
        for (cell, state) in cells {
            let candidates: Vec<u32> = (0..this.nodes.len() as u32).collect();
            this.add(cell, state, &candidates);
        }
        this
    }

    /// The domain of `q1` as intervals on which link 1 is free, stuck, or (below the finest width) mixed.
    fn columns(&self) -> Vec<(f64, f64, State)> {
        let (lower, upper) = self.topology.axes[0].domain();
        let first: Vec<Pair> = self.scene.pairs().iter().copied().filter(|p| p.link == 0).collect();
        let at = |i: usize| if i == FIRST { upper } else { lower + (upper - lower) * i as f64 / FIRST as f64 };
        let mut open: Vec<(f64, f64, Vec<Pair>)> =
            (0..FIRST).rev().map(|i| (at(i), at(i + 1), first.clone())).collect();
        let mut columns = Vec::new();
        let middle = self.topology.axes[1].domain().0;
        while let Some((from, to, pairs)) = open.pop() {
            let cell = Cell { lower: [from, middle], upper: [to, middle] };
            match self.judge(&cell, &pairs, &[]) {
                State::Mixed(pairs) if to - from > FINEST_COLUMN * (upper - lower) => {
                    let half = (from + to) / 2.0;
                    open.push((half, to, pairs.clone()));
                    open.push((from, half, pairs));
                }
                state => columns.push((from, to, state)),
            }
        }
        columns
    }

    /// Decides a box by the pairs that are open in a box around it; `fixed` ones stay open unheard.
    fn judge(&self, cell: &Cell, pairs: &[Pair], fixed: &[Pair]) -> State {
        let posture = Posture::new(self.scene, cell.center());
        let deviation = Deviation::Box(cell.half());
        let mut open = fixed.to_vec();
        for &pair in pairs {
            let bounded = posture.bound(pair, deviation);
            if bounded.least > 0.0 && bounded.least >= self.clearance {
                continue;
            }
            if bounded.here.distance < self.clearance && posture.greatest(pair, deviation) < self.clearance {
                return State::Stuck(pair);
            }
            open.push(pair);
        }
        if open.is_empty() { State::Free } else { State::Mixed(open) }
    }

    fn add(&mut self, cell: Cell, state: State, candidates: &[u32]) {
        let index = self.nodes.len() as u32;
        let mut neighbors = Vec::new();
        // Stuck boxes are walls: who lies beside them does not matter.
        if !matches!(state, State::Stuck(_)) {
            for &other in candidates {
                let node = &mut self.nodes[other as usize];
                if matches!(node.state, State::Free | State::Mixed(_))
                    && cell.shared_side(&node.cell, &self.topology).is_some()
                {
                    node.neighbors.push(index);
                    neighbors.push(other);
                }
            }
        }
        self.nodes.push(Node { cell, state, neighbors });
    }

    /// Replaces a mixed box by two. Whether that can help: not if only link 1 is open in it, or it is too small.
    pub fn split(&mut self, index: u32) -> bool {
        let State::Mixed(pairs) = &self.nodes[index as usize].state else { return false };
        let (fixed, open): (Vec<Pair>, Vec<Pair>) = pairs.iter().partition(|p| p.link == 0);
        let cell = self.nodes[index as usize].cell;
        let Some(axis) = self.longer(&cell, &open) else { return false };
        let halves = cell.halves(axis);
        if halves.iter().any(|h| h.lower[axis] >= h.upper[axis]) {
            return false;
        }
        let states = halves.map(|half| self.judge(&half, &open, &fixed));
        let node = &mut self.nodes[index as usize];
        node.state = State::Split;
        let mut candidates = std::mem::take(&mut node.neighbors);
        for &other in &candidates {
            self.nodes[other as usize].neighbors.retain(|&n| n != index);
        }
        for (half, state) in halves.into_iter().zip(states) {
            let next = self.nodes.len() as u32;
            self.add(half, state, &candidates);
            candidates.push(next);
        }
        true
    }

    /// The axis along which the open pairs move more within the box.
    fn longer(&self, cell: &Cell, open: &[Pair]) -> Option<usize> {
        let half = cell.half();
        let posture = Posture::new(self.scene, cell.center());
        let along = |axis: usize| {
            let mut only = [0.0; 2];
            only[axis] = half[axis];
            open.iter().map(|&p| posture.farthest_motion(p, Deviation::Box(only))).fold(0.0, f64::max)
        };
        (!open.is_empty()).then(|| usize::from(along(1) > along(0)))
    }

    /// A box that holds `q`, not a stuck one if there is a choice.
    pub fn locate(&self, q: Configuration) -> Option<u32> {
        let q = self.topology.wrap(q);
        let holds = |n: &Node| n.cell.contains(q) && matches!(n.state, State::Free | State::Mixed(_));
        self.nodes.iter().position(holds).map(|i| i as u32)
    }
}
