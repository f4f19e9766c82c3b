//! Subdivision of the configuration space into free boxes, collision boxes and undecided boxes.

use super::chain::{Mosaic, Openness};
use cplan_interrupt::checkpoint;
use cplan_judge::{Cell, Deviation, Posture};
use cplan_model::space::{Configuration, Segment, Topology};
use cplan_model::{Pair, Scene};

/// Returns the two halves of a box along `axis`.
fn halves(cell: &Cell, axis: usize) -> [Cell; 2] {
    let middle = cell.center()[axis];
    let (mut below, mut above) = (*cell, *cell);
    below.upper[axis] = middle;
    above.lower[axis] = middle;
    [below, above]
}

/// Returns the portal from this cell to another. `None` unless they share a piece of a side of positive length. A common corner
/// is no portal, because two other boxes have the same corner.
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
    // Seen in the direction of growing `q1`, greater `q2` is to the left. Seen in the direction of growing `q2`, lesser `q1` is
    // to the left.
    let (left, right) = if ahead == (axis == 0) { (to, from) } else { (from, to) };
    Some(Portal { left: end(left), right: end(right), shift: by })
}

/// The piece of a side that two cells share, as seen when passing from one cell to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Portal {
    /// The left end.
    pub left: Configuration,
    /// The right end.
    pub right: Configuration,
    /// Shift of the other cell that places it beside this cell: whole turns if they meet across a seam, otherwise zero.
    pub shift: Configuration,
}

impl Portal {
    /// Returns the point halfway between the ends.
    pub fn middle(&self) -> Configuration {
        (self.left + self.right) / 2.0
    }
}

/// State of a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum State {
    /// No pair comes too near anywhere in the box.
    Free,
    /// This pair is too near everywhere in the box.
    Colliding(Pair),
    /// These pairs are undecided. No other pair comes too near.
    Undecided(Vec<Pair>),
    /// Undecided, and halving would not help: the box has the finest size, or it is in a column of the finest width and only
    /// pairs of link 1 are undecided.
    Finest,
    /// The sum of joint values is not allowed anywhere in the box.
    Beyond,
    /// Replaced by two halves: the nodes with this index and the next one.
    Split(u32),
}

pub(super) struct Node {
    pub cell: Cell,
    pub state: State,
    /// Indices of the boxes that share a side with this one. Empty for collision boxes and split boxes.
    pub neighbors: Vec<u32>,
}

impl Node {
    /// Returns true if the box may contain free configurations: it is neither a collision box nor split.
    pub fn is_open(&self) -> bool {
        matches!(self.state, State::Free | State::Undecided(_) | State::Finest)
    }
}

/// A subdivision that covers the whole domain, with its adjacencies.
pub(super) struct Subdivision<'a> {
    scene: &'a Scene,
    topology: Topology,
    clearance: f64,
    pub nodes: Vec<Node>,
    /// Number of initial boxes. They come first in the list, and are not halves of other boxes.
    roots: usize,
}

/// Number of initial columns and rows. It must be at least three, so that no box is its own neighbour across a seam.
const INITIAL_COLUMNS: usize = 8;

/// Finest width of a column, as a share of the domain. On such an interval of `q1`, link 1 alone is decided. A column extends
/// over the whole domain of `q2`, so fine columns cost little. A thin wall of link 1, such as a corner that just reaches an
/// obstacle, needs them.
const MIN_COLUMN_WIDTH: f64 = 1e-8;

/// Largest number of undecided columns of one width that are halved before the search. Each end of a contact leaves a few
/// undecided columns. If there are far more, link 1 slides along an obstacle at exactly the clearance, and halving would not
/// help. Then the search halves boxes of such columns only where necessary.
const MAX_UNDECIDED_COLUMNS: usize = 512;

/// Finest size of a box, as a share of the domain along each axis. Finer boxes would be within the rounding error of a clearance.
/// Without this limit, the search would never end at a start or goal without free space around it.
const MIN_BOX_SIZE: f64 = 1e-10;

impl<'a> Subdivision<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let topology = scene.arm().topology();
        let mut this = Self { scene, topology, clearance, nodes: Vec::new(), roots: 0 };
        let (bottom, top) = topology.ranges[1].domain();
        let row = |j: usize| {
            if j == INITIAL_COLUMNS { top } else { bottom + (top - bottom) * j as f64 / INITIAL_COLUMNS as f64 }
        };
        let second: Vec<Pair> = scene.pairs().iter().copied().filter(|p| p.link > 0).collect();
        // Adjacent boxes are in the same column, in neighbouring columns, or in the first and the last column.
        let (mut end_of_first, mut previous) = (0, 0);
        for (lower, upper, state) in this.columns() {
            let begin = this.nodes.len();
            let mut add = |cell, state| {
                let now = this.nodes.len();
                let candidates: Vec<u32> =
                    (0..end_of_first).chain(previous.max(end_of_first)..now).map(index).collect();
                this.add(cell, state, &candidates);
            };
            if let State::Colliding(pair) = state {
                add(Cell { lower: [lower, bottom], upper: [upper, top] }, State::Colliding(pair));
            } else {
                let left = if let State::Undecided(left) = state { left } else { Vec::new() };
                for j in 0..INITIAL_COLUMNS {
                    let cell = Cell { lower: [lower, row(j)], upper: [upper, row(j + 1)] };
                    let state = judge_within_sum(scene, clearance, &cell, &second, &left);
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

    /// Splits the domain of `q1` into intervals, ascending, with the state of link 1: free, in collision, or undecided after all
    /// halvings.
    fn columns(&self) -> Vec<(f64, f64, State)> {
        let (lower, upper) = self.topology.ranges[0].domain();
        let first: Vec<Pair> = self.scene.pairs().iter().copied().filter(|p| p.link == 0).collect();
        let at = |i: usize| {
            if i == INITIAL_COLUMNS { upper } else { lower + (upper - lower) * i as f64 / INITIAL_COLUMNS as f64 }
        };
        let mut open: Vec<(f64, f64, Vec<Pair>)> =
            (0..INITIAL_COLUMNS).map(|i| (at(i), at(i + 1), first.clone())).collect();
        let mut columns = Vec::new();
        let middle = self.topology.ranges[1].domain().0;
        while !open.is_empty() {
            let few = open.len() <= MAX_UNDECIDED_COLUMNS;
            for (from, to, pairs) in std::mem::take(&mut open) {
                let cell = Cell { lower: [from, middle], upper: [to, middle] };
                match judge(self.scene, self.clearance, &cell, &pairs, &[]) {
                    State::Undecided(pairs) if few && to - from > MIN_COLUMN_WIDTH * (upper - lower) => {
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
            // The adjacency of two collision boxes does not matter. Split boxes no longer count.
            let matters = beside.is_open() || node.is_open() && matches!(beside.state, State::Colliding(_));
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

    /// Replaces an undecided box by its two halves, and returns true. If halving would not help, marks the box as finest, and
    /// returns false.
    pub fn split(&mut self, index: u32) -> bool {
        let State::Undecided(pairs) = &self.nodes[index as usize].state else { return false };
        let cell = self.nodes[index as usize].cell;
        let narrow = cell.upper[0] - cell.lower[0] <= MIN_COLUMN_WIDTH * self.topology.ranges[0].extent();
        let (fixed, open): (Vec<Pair>, Vec<Pair>) = pairs.iter().partition(|p| p.link == 0 && narrow);
        let longer_side = || {
            let share = |k: usize| (cell.upper[k] - cell.lower[k]) / self.topology.ranges[k].extent();
            usize::from(share(1) > share(0))
        };
        // Without undecided pairs, the range of the sum of joint values decides.
        let axis = if pairs.is_empty() { Some(longer_side()) } else { self.longer(&cell, &open) };
        let wide =
            |&axis: &usize| cell.upper[axis] - cell.lower[axis] > MIN_BOX_SIZE * self.topology.ranges[axis].extent();
        let Some(halves) = axis.filter(wide).map(|axis| halves(&cell, axis)) else {
            self.nodes[index as usize].state = State::Finest;
            return false;
        };
        let states = halves.map(|half| judge_within_sum(self.scene, self.clearance, &half, &open, &fixed));
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

    /// Returns the axis along which undecided pairs move more within the box.
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

    /// Returns all boxes that meet a segment in the domain. Split boxes are omitted.
    pub fn boxes_meeting(&self, piece: &Segment) -> Vec<u32> {
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
            State::Undecided(_) => Some(Openness::Undecided),
            State::Finest => Some(Openness::Finest),
            State::Colliding(_) | State::Beyond | State::Split(_) => None,
        }
    }

    fn for_each_neighbor(&self, index: u32, f: impl FnMut(u32)) {
        self.nodes[index as usize].neighbors.iter().copied().for_each(f);
    }

    fn locate(&self, q: Configuration) -> Option<u32> {
        self.meeting(&Segment::point(self.topology.wrap(q))).first().copied()
    }

    fn meeting(&self, piece: &Segment) -> Vec<u32> {
        let mut open = self.boxes_meeting(piece);
        open.retain(|&index| self.nodes[index as usize].is_open());
        open.truncate(if piece.is_point() { 1 } else { usize::MAX });
        open
    }

    fn topology(&self) -> &Topology {
        &self.topology
    }
}

/// Converts an index of nodes to 32 bits. It cannot overflow, because so many boxes would not fit into memory.
fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

/// Computes the state of a box, as [`judge`] does, but also respects the range of the sum of joint values. A free box that is not
/// wholly within that range is undecided, without pairs.
fn judge_within_sum(scene: &Scene, clearance: f64, cell: &Cell, pairs: &[Pair], fixed: &[Pair]) -> State {
    let topology = scene.arm().topology();
    let is_closed = |part: [f64; 2]| part[0] <= cell.lower[1] && cell.upper[1] <= part[1];
    if topology.closed_by_sum([cell.lower[0], cell.upper[0]]).any(is_closed) {
        return State::Beyond;
    }
    let corners = [0, 1].map(|k| [cell.lower[k], cell.upper[k]]);
    let allowed = |q1: f64, q2: f64| topology.sum.is_none_or(|sum| sum.contains(Configuration::new(q1, q2)));
    match judge(scene, clearance, cell, pairs, fixed) {
        State::Free if !corners[0].iter().all(|&q1| corners[1].iter().all(|&q2| allowed(q1, q2))) => {
            State::Undecided(Vec::new())
        }
        state => state,
    }
}

/// Computes the state of a box. Tests `pairs`, which were undecided in a larger box. The pairs `fixed` stay undecided without a
/// test.
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
            return State::Colliding(pair);
        }
        open.push(pair);
    }
    if open.is_empty() { State::Free } else { State::Undecided(open) }
}
