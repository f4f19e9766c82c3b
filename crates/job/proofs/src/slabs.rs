//! Decides whether a path exists, by slabs of joint 1: finds a path, or proves that no path exists.
//!
//! The domain of joint 1 is cut into slabs. In each slab, closed forms give the values of joint 2 that are free all over the
//! slab, and those in collision all over it ([`super::slab`]). Other values are undecided. As long as free and undecided spans
//! together connect start and goal, but free ones alone do not, slabs with undecided spans of the connection are halved. So easy
//! questions need few slabs, and a narrow passage needs fine slabs only along itself.

mod proof;

use super::bands::{Kind, bands};
use super::chain::{Mosaic, Openness, all_of_fewest_undecided, ends, fewest_undecided};
use super::channel::Channel;
use super::connectivity::{Connectivity, Occupancy, proven};
use super::slab::{SecondLink, Verdicts};
use cplan_geometry::merge_in_place;
use cplan_judge::{Cell, CollisionBox};
use cplan_model::Scene;
use cplan_model::space::{Configuration, GoalSet, Segment, Topology};

/// Number of initial slabs over the domain. Next to values of joint 1 at which link 1 collides, slabs are narrower. Later slabs
/// are halves. There must be at least three, so that no slab is its own neighbour across a seam.
const INITIAL_SLABS: usize = 16;

/// Largest number of times that a slab is halved. In finer slabs, link 2 would move by less than the rounding error.
const MAX_HALVINGS: usize = 26;

/// From this number of slabs on, all connections with the fewest undecided spans are refined at once. Otherwise, separate
/// searches for each connection would take most of the time.
const MIN_BATCH_SLABS: usize = 512;

/// Slabs whose widths differ by at most this share are of the same level. It is far above the rounding of their ends.
const LEVEL_TOLERANCE: f64 = 1e-6;

/// A stretch of `q1` and its spans.
#[derive(Clone, Copy)]
struct Slab {
    from: f64,
    to: f64,
    level: usize,
    /// True if link 1 is free in the whole slab. If false, no span is free, but spans in which link 2 collides still count as
    /// colliding.
    clear: bool,
    /// True if link 2 has been examined. Before that, the slab has a single undecided span.
    judged: bool,
    /// Index of the first span, and one past the last.
    spans: [u32; 2],
    /// Index into the walls, if link 1 collides in the slab; otherwise `None`.
    wall: Option<u32>,
}

/// An interval of `q2` in a slab that is free or undecided.
#[derive(Clone, Copy)]
struct Span {
    lower: f64,
    upper: f64,
    openness: Openness,
    slab: u32,
}

struct Slabs<'a> {
    topology: Topology,
    second: SecondLink<'a>,
    /// The slabs, by ascending values of joint 1.
    slabs: Vec<Slab>,
    /// The spans, including unused ones of slabs that were halved.
    spans: Vec<Span>,
    walls: Vec<CollisionBox>,
    verdicts: Verdicts,
}

/// Decides whether there is a motion from `start` to one of `goals` whose distance from every obstacle is positive and at least
/// `clearance`. Uses at most `max_slabs` slabs of joint 1, and at most `max_boxes` boxes for a proof.
///
/// This answers the same question as [`super::connectivity`], usually much faster: a slab decides all values of `q2` at once, in
/// `O(m log m)` for `m` contacts. Proofs consist of the same kind of boxes. The answer is undecided if only shapes without area
/// close a passage, or if only some nanometres of free space remain.
pub fn slab_connectivity(
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
    max_slabs: usize,
    max_boxes: usize,
) -> Connectivity {
    proven(scene, |scene| decide(&mut Slabs::new(scene, clearance), start, goals, max_slabs, max_boxes))
}

/// Returns the final boxes of [`slab_connectivity`]. They lie side by side and cover the domain.
pub fn slab_boxes(
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
    max_slabs: usize,
) -> Vec<(Cell, Occupancy)> {
    let mut slabs = Slabs::new(scene, clearance);
    decide(&mut slabs, start, goals, max_slabs, 0);
    slabs.boxes()
}

fn decide(
    slabs: &mut Slabs,
    start: Configuration,
    goals: &GoalSet,
    max_slabs: usize,
    max_boxes: usize,
) -> Connectivity {
    // A domain with a joint that cannot move has no area to cut.
    if slabs.topology.ranges.iter().any(|axis| axis.extent() <= 0.0) {
        return Connectivity::Undecided { boxes: 0, closed: false };
    }
    loop {
        let ends = ends(slabs, goals);
        let count = slabs.slabs.len();
        let undecided = |closed: bool| Connectivity::Undecided { boxes: count, closed };
        let Some(from) = slabs.locate(start) else { return undecided(false) };
        let connection = |finest| fewest_undecided(slabs, from, &ends, finest);
        let Some(chain) = connection(false).or_else(|| connection(true)) else {
            let proof = slabs.disconnection(start, goals, max_boxes);
            return proof.map_or_else(|| undecided(true), Connectivity::Disconnected);
        };
        if chain.iter().all(|&i| slabs.spans[i as usize].openness == Openness::Free) {
            return Connectivity::Connected(Channel::new(slabs, &chain, start, &ends));
        }
        let chain = if slabs.slabs.len() < MIN_BATCH_SLABS {
            chain
        } else {
            let all = all_of_fewest_undecided(slabs, from, &ends, false);
            if all.is_empty() { chain } else { all }
        };
        let mut mixed: Vec<u32> = chain
            .into_iter()
            .filter(|&i| slabs.spans[i as usize].openness == Openness::Undecided)
            .map(|i| slabs.spans[i as usize].slab)
            .collect();
        mixed.sort_unstable();
        mixed.dedup();
        if mixed.is_empty() || slabs.slabs.len() + mixed.len() > max_slabs {
            return undecided(false);
        }
        slabs.halve(&mixed);
    }
}

impl<'a> Slabs<'a> {
    fn new(scene: &'a Scene, clearance: f64) -> Self {
        let topology = scene.arm().topology();
        let mut this = Self {
            topology,
            second: SecondLink::new(scene, clearance),
            slabs: Vec::new(),
            spans: Vec::new(),
            walls: Vec::new(),
            verdicts: Verdicts::default(),
        };
        for stretch in bands(this.second.contacts(), clearance) {
            match stretch.kind {
                Kind::Free => this.add_slabs(stretch.from, stretch.to, true),
                Kind::Wall(stuck) => {
                    let [from, to] = [stuck.cell.lower[0], stuck.cell.upper[0]];
                    this.add_slabs(stretch.from, from, false);
                    let wall = Some(index(this.walls.len()));
                    this.walls.push(stuck);
                    let spans = [index(this.spans.len()); 2];
                    this.slabs.push(Slab { from, to, level: 0, clear: false, judged: true, spans, wall });
                    this.add_slabs(to, stretch.to, false);
                }
                // A graze at a single value cannot be halved, but blocks the passage.
                Kind::Unknown if stretch.from == stretch.to => {
                    let (from, to, spans) = (stretch.from, stretch.to, this.add_full_span(Openness::Finest));
                    this.slabs.push(Slab { from, to, level: 0, clear: false, judged: false, spans, wall: None });
                }
                Kind::Unknown => this.add_slabs(stretch.from, stretch.to, false),
            }
        }
        this.number();
        this
    }

    /// Adds slabs for a stretch of `q1`, without examining them. Cuts the stretch at the ends of initial slabs, so that all slabs
    /// of a level have the same width.
    fn add_slabs(&mut self, from: f64, to: f64, clear: bool) {
        let (lower, upper) = self.topology.ranges[0].domain();
        let at = |i: usize| lower + (upper - lower) * i as f64 / INITIAL_SLABS as f64;
        let mut from = from;
        for cut in (1..INITIAL_SLABS).map(at).chain([to]) {
            if from < cut && cut <= to {
                let spans = self.add_full_span(Openness::Undecided);
                self.slabs.push(Slab { from, to: cut, level: 0, clear, judged: false, spans, wall: None });
                from = cut;
            }
        }
    }

    /// Adds one span for all values of joint 2.
    fn add_full_span(&mut self, openness: Openness) -> [u32; 2] {
        let (lower, upper) = self.topology.ranges[1].domain();
        let first = index(self.spans.len());
        self.spans.push(Span { lower, upper, openness, slab: 0 });
        [first, first + 1]
    }

    /// Adds a slab and examines it.
    fn add(&mut self, from: f64, to: f64, clear: bool) {
        // The finest level whose slabs are at least as wide. The ends of initial slabs are rounded.
        let fits = |&level: &usize| (to - from) / 2.0 <= half_of_level(&self.topology, level) * (1.0 + LEVEL_TOLERANCE);
        let level = (0..=MAX_HALVINGS).take_while(fits).last().unwrap_or(0);
        self.second.judge(
            from,
            to,
            level,
            half_of_level(&self.topology, level) * (1.0 + 2.0 * LEVEL_TOLERANCE),
            &mut self.verdicts,
        );
        let first = index(self.spans.len());
        self.cut(level, clear);
        self.slabs.push(Slab {
            from,
            to,
            level,
            clear,
            judged: true,
            spans: [first, index(self.spans.len())],
            wall: None,
        });
    }

    /// Adds the spans of a slab that its colliding intervals leave.
    fn cut(&mut self, level: usize, clear: bool) {
        let (bottom, top) = self.topology.ranges[1].domain();
        let Verdicts { outer, inner, beyond } = &mut self.verdicts;
        merge_in_place(outer);
        let mut stuck: Vec<[f64; 2]> = inner.iter().map(|i| i.1).chain(beyond.iter().copied()).collect();
        merge_in_place(&mut stuck);
        let openness = if level < MAX_HALVINGS { Openness::Undecided } else { Openness::Finest };
        let free = if clear { Openness::Free } else { openness };
        let spans = &mut self.spans;
        let mut add = |lower: f64, upper: f64, openness| {
            if lower < upper {
                spans.push(Span { lower, upper, openness, slab: 0 });
            }
        };
        let mut stuck = stuck.into_iter().peekable();
        let mut at = bottom;
        for &[lower, upper] in outer.iter() {
            add(at, lower, free);
            at = lower.max(at);
            while let Some([from, to]) = stuck.next_if(|s| s[0] < upper) {
                add(at, from, openness);
                at = to.max(at);
            }
            add(at, upper, openness);
            at = upper.max(at);
        }
        add(at, top, free);
    }

    /// Stores in each span the number of its slab.
    fn number(&mut self) {
        for (number, slab) in self.slabs.iter().enumerate() {
            for span in &mut self.spans[slab.spans[0] as usize..slab.spans[1] as usize] {
                span.slab = index(number);
            }
        }
    }

    /// Replaces the given slabs (ascending) by their halves. Examines them first if necessary.
    fn halve(&mut self, which: &[u32]) {
        let before = std::mem::take(&mut self.slabs);
        self.slabs.reserve(before.len() + which.len());
        let mut which = which.iter().peekable();
        for (number, slab) in before.into_iter().enumerate() {
            if which.next_if(|&&w| w as usize == number).is_none() {
                self.slabs.push(slab);
                continue;
            }
            let middle = (slab.from + slab.to) / 2.0;
            if !slab.judged {
                self.add(slab.from, slab.to, slab.clear);
            } else if slab.from < middle && middle < slab.to {
                self.add(slab.from, middle, slab.clear);
                self.add(middle, slab.to, slab.clear);
            } else {
                let range = slab.spans[0] as usize..slab.spans[1] as usize;
                self.spans[range].iter_mut().for_each(|span| {
                    if span.openness == Openness::Undecided {
                        span.openness = Openness::Finest;
                    }
                });
                self.slabs.push(slab);
            }
        }
        self.number();
    }

    /// Returns all spans, and the colliding stretches between them, as boxes.
    fn boxes(&self) -> Vec<(Cell, Occupancy)> {
        let (bottom, top) = self.topology.ranges[1].domain();
        let mut boxes = Vec::new();
        for slab in &self.slabs {
            let mut add = |lower: f64, upper: f64, occupancy| {
                if lower < upper {
                    boxes.push((Cell { lower: [slab.from, lower], upper: [slab.to, upper] }, occupancy));
                }
            };
            let mut at = bottom;
            for span in &self.spans[slab.spans[0] as usize..slab.spans[1] as usize] {
                let is_free = span.openness == Openness::Free;
                add(at, span.lower, Occupancy::Colliding);
                add(span.lower, span.upper, if is_free { Occupancy::Free } else { Occupancy::Undecided });
                at = span.upper;
            }
            add(at, top, Occupancy::Colliding);
        }
        boxes
    }

    /// Returns the neighbours of a slab.
    fn neighbors(&self, slab: u32) -> impl Iterator<Item = u32> {
        let last = index(self.slabs.len()) - 1;
        let round = self.topology.ranges[0].is_circle();
        let before = if slab > 0 { Some(slab - 1) } else { round.then_some(last) };
        let after = if slab < last { Some(slab + 1) } else { round.then_some(0) };
        before.into_iter().chain(after)
    }

    fn spans_of(&self, slab: u32) -> impl Iterator<Item = u32> + use<> {
        let [first, end] = self.slabs[slab as usize].spans;
        first..end
    }
}

/// Returns half the width of the slabs of a level.
fn half_of_level(topology: &Topology, level: usize) -> f64 {
    topology.ranges[0].extent() / INITIAL_SLABS as f64 / 2.0 * 0.5_f64.powi(level as i32)
}

impl Mosaic for Slabs<'_> {
    fn count(&self) -> usize {
        self.spans.len()
    }

    fn cell(&self, index: u32) -> Cell {
        let span = &self.spans[index as usize];
        let slab = &self.slabs[span.slab as usize];
        Cell { lower: [slab.from, span.lower], upper: [slab.to, span.upper] }
    }

    fn openness(&self, index: u32) -> Option<Openness> {
        Some(self.spans[index as usize].openness)
    }

    fn for_each_neighbor(&self, index: u32, mut f: impl FnMut(u32)) {
        let span = self.spans[index as usize];
        for slab in self.neighbors(span.slab) {
            for other in self.spans_of(slab) {
                let beside = &self.spans[other as usize];
                if span.lower.max(beside.lower) < span.upper.min(beside.upper) {
                    f(other);
                }
            }
        }
        let [first, end] = self.slabs[span.slab as usize].spans;
        if index > first && self.spans[index as usize - 1].upper == span.lower {
            f(index - 1);
        }
        if index + 1 < end && self.spans[index as usize + 1].lower == span.upper {
            f(index + 1);
        }
        let axis = self.topology.ranges[1];
        if axis.is_circle() && first + 1 < end {
            let (bottom, top) = axis.domain();
            let (lowest, highest) = (first, end - 1);
            if self.spans[lowest as usize].lower == bottom && self.spans[highest as usize].upper == top {
                if index == lowest {
                    f(highest);
                } else if index == highest {
                    f(lowest);
                }
            }
        }
    }

    fn locate(&self, q: Configuration) -> Option<u32> {
        let q = self.topology.wrap(q);
        let first = self.slabs.partition_point(|s| s.to < q[0]);
        let slabs = (first..self.slabs.len()).take_while(|&s| self.slabs[s].from <= q[0]).map(index);
        let holds = |&s: &u32| self.spans[s as usize].lower <= q[1] && q[1] <= self.spans[s as usize].upper;
        let mut held: Vec<u32> = slabs.flat_map(|s| self.spans_of(s)).filter(holds).collect();
        held.sort_by_key(|&s| self.spans[s as usize].openness != Openness::Free);
        held.first().copied()
    }

    fn meeting(&self, piece: &Segment) -> Vec<u32> {
        let [from, to] = piece.ends();
        if piece.is_point() {
            return self.locate(from).into_iter().collect();
        }
        let (least, greatest) = (from[0].min(to[0]), from[0].max(to[0]));
        let first = self.slabs.partition_point(|slab| slab.to < least);
        let slabs = (first..self.slabs.len()).take_while(|&slab| self.slabs[slab].from <= greatest).map(index);
        let meets = |&span: &u32| {
            let cell = self.cell(span);
            piece.meets(cell.lower, cell.upper)
        };
        slabs.flat_map(|slab| self.spans_of(slab)).filter(meets).collect()
    }

    fn topology(&self) -> &Topology {
        &self.topology
    }
}

/// Converts a number of spans to 32 bits. It cannot overflow, because so many spans would not fit into memory.
fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}
