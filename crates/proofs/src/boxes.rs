//! Subdivision of the configuration space into free, stuck and mixed boxes.

use super::chain::{Mosaic, Openness};
use cplan_core::check::{Cell, Deviation, Posture};
use cplan_core::model::{Pair, Scene};
use cplan_core::space::{Configuration, Segment, Topology};
use cplan_interrupt::checkpoint;

/// The two halves along `axis`.
fn halves(cell: &Cell, axis: usize) -> [Cell; 2] {
    let middle = cell.center()[axis];
    let (mut below, mut above) = (*cell, *cell);
    below.upper[axis] = middle;
    above.lower[axis] = middle;
    [below, above]
}

/// The portal from this cell to the other, if the two share a piece of side of positive length. Corners do not count:
/// where only a corner is shared, it belongs to the two other boxes as well.
pub(super) fn portal(cell: &Cell, other: &Cell, topology: &Topology) -> Option<Portal> {
    (0..2).find_map(|axis| portal_along(cell, other, axis, topology))
}

fn portal_along(cell: &Cell, other: &Cell, axis: usize, topology: &Topology) -> Option<Portal> {
    let across = 1 - axis;
    let (from, to) = (cell.lower[across].max(other.lower[across]), cell.upper[across].min(other.upper[across]));
    if from >= to {
        return None;
    }
    let (lower, upper) = topology.ranges[axis].domain();
    let circle = topology.ranges[axis].is_circle();
    let (value, shift, ahead) = if cell.upper[axis] == other.lower[axis] {
        (cell.upper[axis], 0.0, true)
    } else if cell.lower[axis] == other.upper[axis] {
        (cell.lower[axis], 0.0, false)
    } else if circle && cell.upper[axis] == upper && other.lower[axis] == lower {
        (upper, upper - lower, true)
    } else if circle && cell.lower[axis] == lower && other.upper[axis] == upper {
        (lower, lower - upper, false)
    } else {
        return None;
    };
    let end = |along: f64| {
        let mut end = Configuration::zeros();
        (end[axis], end[across]) = (value, along);
        end
    };
    let mut by = Configuration::zeros();
    by[axis] = shift;
    // Who goes towards greater `q1` has greater `q2` to the left; who goes towards greater `q2`, lesser `q1`.
    let (left, right) = if ahead == (axis == 0) { (to, from) } else { (from, to) };
    Some(Portal { left: end(left), right: end(right), shift: by })
}

/// The piece of side that two cells share, as seen by who passes from one to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Portal {
    /// End to the left hand.
    pub left: Configuration,
    /// End to the right hand.
    pub right: Configuration,
    /// By how much the other cell is to be shifted to lie beside the first one: a turn, or nothing.
    pub shift: Configuration,
}

impl Portal {
    /// Halfway between the ends.
    pub fn middle(&self) -> Configuration {
        (self.left + self.right) / 2.0
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
    /// Undecided, and too small for halves to tell more: link 1 alone is open in a finest column, or it is of the finest
    /// size.
    Finest,
    /// Replaced by two halves: the node of this index and the next.
    Split(u32),
}

pub(super) struct Node {
    pub cell: Cell,
    pub state: State,
    /// Boxes that share a side with this one; empty if this one is stuck or split.
    pub neighbors: Vec<u32>,
}

impl Node {
    /// Whether it may hold a free configuration: neither stuck nor replaced.
    pub fn is_open(&self) -> bool {
        matches!(self.state, State::Free | State::Mixed(_) | State::Finest)
    }
}

/// A subdivision that covers the whole domain, with its adjacencies.
pub(super) struct Subdivision<'a> {
    scene: &'a Scene,
    topology: Topology,
    clearance: f64,
    pub nodes: Vec<Node>,
    /// So many nodes are halves of no other.
    roots: usize,
}

/// Columns and rows to begin with; at least three, so that across a seam no box is its own neighbour.
const FIRST: usize = 8;

/// Link 1 alone is decided on intervals of `q1`, down to this share of the domain: they are as tall as the domain, so
/// fine ones cost nothing, and a thin wall of link 1 (a corner that just reaches an obstacle) needs fine ones.
const FINEST_COLUMN: f64 = 1e-8;

/// Columns of one width are halved beforehand only if there are no more of them. The ends of contacts leave a few open ones
/// each; far more of them mean that link 1 slides along an obstacle at the very distance to keep, and halves would tell
/// nothing. Such columns are left to the search, which halves boxes where it matters.
const MOST_OPEN_COLUMNS: usize = 512;

/// Boxes of link 2 are decided down to this share of the domain along each axis. Finer ones are no wider than what
/// rounding leaves uncertain in a clearance, and a start or goal without any room would never be done with.
const FINEST_BOX: f64 = 1e-10;

impl<'a> Subdivision<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let topology = scene.arm().topology();
        let mut this = Self { scene, topology, clearance, nodes: Vec::new(), roots: 0 };
        let (bottom, top) = topology.ranges[1].domain();
        let row = |j: usize| if j == FIRST { top } else { bottom + (top - bottom) * j as f64 / FIRST as f64 };
        let second: Vec<Pair> = scene.pairs().iter().copied().filter(|p| p.link > 0).collect();
        // Only boxes of one column, of neighbouring columns, and of the first and the last one can be adjacent.
        let (mut end_of_first, mut previous) = (0, 0);
        for (lower, upper, state) in this.columns() {
            let begin = this.nodes.len();
            let mut add = |cell, state| {
                let now = this.nodes.len();
                let candidates: Vec<u32> =
                    (0..end_of_first).chain(previous.max(end_of_first)..now).map(index).collect();
                this.add(cell, state, &candidates);
            };
            if let State::Stuck(pair) = state {
                add(Cell { lower: [lower, bottom], upper: [upper, top] }, State::Stuck(pair));
            } else {
                let left = if let State::Mixed(left) = state { left } else { Vec::new() };
                for j in 0..FIRST {
                    let cell = Cell { lower: [lower, row(j)], upper: [upper, row(j + 1)] };
                    let state = judge(scene, clearance, &cell, &second, &left);
                    add(cell, state);
                }
            }
            if begin == 0 {
                end_of_first = this.nodes.len();
            }
            previous = begin;
        }
        this.roots = this.nodes.len();
        this
    }

    /// The domain of `q1` as intervals, ascending, on which link 1 is free, stuck, or (at the end of halving) mixed.
    fn columns(&self) -> Vec<(f64, f64, State)> {
        let (lower, upper) = self.topology.ranges[0].domain();
        let first: Vec<Pair> = self.scene.pairs().iter().copied().filter(|p| p.link == 0).collect();
        let at = |i: usize| if i == FIRST { upper } else { lower + (upper - lower) * i as f64 / FIRST as f64 };
        let mut open: Vec<(f64, f64, Vec<Pair>)> = (0..FIRST).map(|i| (at(i), at(i + 1), first.clone())).collect();
        let mut columns = Vec::new();
        let middle = self.topology.ranges[1].domain().0;
        while !open.is_empty() {
            let few = open.len() <= MOST_OPEN_COLUMNS;
            for (from, to, pairs) in std::mem::take(&mut open) {
                let cell = Cell { lower: [from, middle], upper: [to, middle] };
                match judge(self.scene, self.clearance, &cell, &pairs, &[]) {
                    State::Mixed(pairs) if few && to - from > FINEST_COLUMN * (upper - lower) => {
                        let half = (from + to) / 2.0;
                        open.extend([(from, half, pairs.clone()), (half, to, pairs)]);
                    }
                    state => columns.push((from, to, state)),
                }
            }
        }
        columns.sort_by(|a, b| a.0.total_cmp(&b.0));
        columns
    }

    fn add(&mut self, cell: Cell, state: State, candidates: &[u32]) {
        let new = index(self.nodes.len());
        let mut node = Node { cell, state, neighbors: Vec::new() };
        for &other in candidates {
            let beside = &mut self.nodes[other as usize];
            // Two walls side by side do not matter; split boxes are there no more.
            let matters = beside.is_open() || node.is_open() && matches!(beside.state, State::Stuck(_));
            if !matters || portal(&cell, &beside.cell, &self.topology).is_none() {
                continue;
            }
            if beside.is_open() {
                beside.neighbors.push(new);
            }
            if node.is_open() {
                node.neighbors.push(other);
            }
        }
        self.nodes.push(node);
    }

    /// Replaces a mixed box by two halves, or takes note that they would tell no more. Whether it did.
    pub fn split(&mut self, index: u32) -> bool {
        let State::Mixed(pairs) = &self.nodes[index as usize].state else { return false };
        let cell = self.nodes[index as usize].cell;
        let narrow = cell.upper[0] - cell.lower[0] <= FINEST_COLUMN * self.topology.ranges[0].extent();
        let (fixed, open): (Vec<Pair>, Vec<Pair>) = pairs.iter().partition(|p| p.link == 0 && narrow);
        let axis = self.longer(&cell, &open);
        let wide =
            |&axis: &usize| cell.upper[axis] - cell.lower[axis] > FINEST_BOX * self.topology.ranges[axis].extent();
        let Some(halves) = axis.filter(wide).map(|axis| halves(&cell, axis)) else {
            self.nodes[index as usize].state = State::Finest;
            return false;
        };
        let states = halves.map(|half| judge(self.scene, self.clearance, &half, &open, &fixed));
        let first = self::index(self.nodes.len());
        let node = &mut self.nodes[index as usize];
        node.state = State::Split(first);
        let mut candidates = std::mem::take(&mut node.neighbors);
        for &other in &candidates {
            self.nodes[other as usize].neighbors.retain(|&n| n != index);
        }
        for (half, state) in halves.into_iter().zip(states) {
            let next = self::index(self.nodes.len());
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

    /// All boxes that hold any of a segment in the domain, but for those that were replaced.
    pub fn holding(&self, piece: &Segment) -> Vec<u32> {
        let mut found = Vec::new();
        let mut waiting: Vec<u32> = (0..index(self.roots)).rev().collect();
        while let Some(index) = waiting.pop() {
            let node = &self.nodes[index as usize];
            match node.state {
                _ if !piece.meets(node.cell.lower, node.cell.upper) => {}
                State::Split(first) => waiting.extend([first + 1, first]),
                _ => found.push(index),
            }
        }
        found
    }
}

impl Mosaic for Subdivision<'_> {
    fn count(&self) -> usize {
        self.nodes.len()
    }

    fn cell(&self, index: u32) -> Cell {
        self.nodes[index as usize].cell
    }

    fn openness(&self, index: u32) -> Option<Openness> {
        match self.nodes[index as usize].state {
            State::Free => Some(Openness::Free),
            State::Mixed(_) => Some(Openness::Mixed),
            State::Finest => Some(Openness::Finest),
            State::Stuck(_) | State::Split(_) => None,
        }
    }

    fn for_each_neighbor(&self, index: u32, f: impl FnMut(u32)) {
        self.nodes[index as usize].neighbors.iter().copied().for_each(f);
    }

    fn locate(&self, q: Configuration) -> Option<u32> {
        self.meeting(&Segment::point(self.topology.wrap(q))).first().copied()
    }

    fn meeting(&self, piece: &Segment) -> Vec<u32> {
        let mut open = self.holding(piece);
        open.retain(|&index| self.nodes[index as usize].is_open());
        open.truncate(if piece.is_point() { 1 } else { usize::MAX });
        open
    }

    fn topology(&self) -> &Topology {
        &self.topology
    }
}

/// Indices of nodes have 32 bits: four thousand million boxes would not fit into memory.
fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

/// Decides a box by the pairs that are open in a box around it; `fixed` ones stay open unheard.
fn judge(scene: &Scene, clearance: f64, cell: &Cell, pairs: &[Pair], fixed: &[Pair]) -> State {
    checkpoint();
    let posture = Posture::new(scene, cell.center());
    let deviation = Deviation::Box(cell.half());
    let mut open = fixed.to_vec();
    for &pair in pairs {
        let bounded = posture.bound(pair, deviation);
        if bounded.least > 0.0 && bounded.least >= clearance {
            continue;
        }
        if bounded.here.distance < clearance && posture.greatest(pair, deviation) < clearance {
            return State::Stuck(pair);
        }
        open.push(pair);
    }
    if open.is_empty() { State::Free } else { State::Mixed(open) }
}
