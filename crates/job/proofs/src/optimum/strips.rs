//! The strips of joint 1's domain: walls on the slices between them, and barriers across them.

use super::closed::{SecondLinkWalls, Wall};
use super::portals::{Portal, free_portals, within_domain};
use cplan_geometry::merge_in_place;
use cplan_model::space::{Configuration, JointRange, Segment, Topology};
use cplan_model::{Pair, Scene};
use std::f64::consts::{PI, TAU};

/// Number of initial strips over the domain. Next to values of joint 1 at which link 1 collides, strips are narrower. There must
/// be at least three, so that no strip is its own neighbour across a seam.
const INITIAL_STRIPS: usize = 64;

/// Maximum number of strips.
const MAX_STRIPS: usize = 100_000;

/// Maximum number of barriers that are tried in a strip.
const MAX_BARRIERS: usize = 512;

/// Strips of at most this width are not halved, radians or metres. It is about the rounding error.
pub(super) const MIN_STRIP_WIDTH: f64 = 1e-9;

/// Tolerance for paths through a portal, radians or metres. They turn at the ends of portals, and rounding may put them slightly
/// outside.
pub(super) const PORTAL_TOLERANCE: f64 = 1e-9;

/// Least distance between slices, radians or metres. With it, slices also differ after shifts by whole turns. For reaches up to a
/// kilometre, it moves shapes by less than their erosion.
const MIN_SLICE_DISTANCE: f64 = 1e-12;

/// A straight closed line across a strip: its values of joint 2 on the slices before and after the strip.
type Barrier = [f64; 2];

/// A part of a strip between two barriers: a trapezium. Its ends are infinite if there is no barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub lower: Barrier,
    pub upper: Barrier,
}

impl Cell {
    /// Returns the least and the greatest value of joint 2 within the strip at `share`: 0 is the slice before it, 1 the slice
    /// after it.
    pub fn at(&self, share: f64) -> [f64; 2] {
        // Infinite ends stay infinite.
        [self.lower, self.upper].map(|[before, after]| match share {
            0.0 => before,
            1.0 => after,
            _ if before == after => before,
            _ => before + (after - before) * share,
        })
    }

    fn turned(self, turns: f64) -> Self {
        let by = turns * TAU;
        Self { lower: self.lower.map(|q2| q2 + by), upper: self.upper.map(|q2| q2 + by) }
    }
}

pub(super) struct Strip {
    pub(super) from: f64,
    pub(super) to: f64,
    /// True if link 1 collides in the whole strip.
    pub(super) closed: bool,
    /// Barriers, ascending on both slices, each with the number of its pair. `None` until needed.
    pub(super) barriers: Option<Vec<(Barrier, usize)>>,
    /// Walls halfway through the strip. `None` until needed.
    middle: Option<Vec<Wall>>,
    /// Walls on the slice at `from`, and then the portals between them. `None` until needed.
    pub(super) walls: Option<Vec<Wall>>,
    portals: Option<Vec<Portal>>,
}

impl Strip {
    fn new(from: f64, to: f64, closed: bool) -> Self {
        Self { from, to, closed, barriers: None, middle: None, walls: None, portals: None }
    }

    /// Returns the walls on the slice at `from`, if they have been computed.
    fn known_walls(&self) -> &[Wall] {
        self.walls.as_deref().unwrap_or_default()
    }
}

/// The strips, computed on demand. With a continuous joint 1, the numbers of strips continue over all turns. Strip `k` is between
/// slices `k` and `k + 1`.
pub(super) struct Strips<'a> {
    topology: Topology,
    pub(super) closed: SecondLinkWalls<'a>,
    pub(super) strips: Vec<Strip>,
    /// Walls at the end of the domain, if joint 1 has limits.
    pub(super) last: Vec<Wall>,
}

impl<'a> Strips<'a> {
    /// Creates the usual strips, cut at further values of joint 1.
    pub fn new(scene: &'a Scene, clearance: f64, slices: &[f64]) -> Self {
        let topology = scene.arm().topology();
        let (lower, upper) = topology.ranges[0].domain();
        let mut closed = SecondLinkWalls::new(scene, clearance);
        let bands = spread_bands(closed.bands(), [lower, upper]);
        let mut cuts: Vec<f64> =
            (0..=INITIAL_STRIPS).map(|i| lower + (upper - lower) * i as f64 / INITIAL_STRIPS as f64).collect();
        cuts.extend(
            slices.iter().copied().filter(|slice| lower + MIN_STRIP_WIDTH < *slice && *slice < upper - MIN_STRIP_WIDTH),
        );
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.dedup_by(|next, kept| *next - *kept < MIN_STRIP_WIDTH / 4.0);
        cuts.retain(|cut| bands.iter().flatten().all(|end| (cut - end).abs() > MIN_SLICE_DISTANCE));
        cuts.extend(bands.iter().flatten().copied().chain([lower, upper]));
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.dedup();
        let is_closed = |middle: f64| bands.iter().any(|band| band[0] < middle && middle < band[1]);
        let strips = cuts.windows(2).map(|w| Strip::new(w[0], w[1], is_closed(f64::midpoint(w[0], w[1])))).collect();
        let last = closed.walls(upper);
        Self { topology, closed, strips, last }
    }

    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Returns the pairs that are used to find walls and barriers.
    pub fn pairs(&self) -> Vec<Pair> {
        self.closed.pairs()
    }

    /// Adds the given pairs of link 2 that are not in use yet. Returns true if there were any.
    pub fn add(&mut self, mut pairs: Vec<Pair>) -> bool {
        pairs.retain(|pair| self.closed.number(*pair).is_none());
        self.closed.add(&pairs);
        if !pairs.is_empty() {
            for strip in &mut self.strips {
                *strip = Strip::new(strip.from, strip.to, strip.closed);
            }
            self.last = self.strips.last().map_or_else(Vec::new, |last| self.closed.walls(last.to));
        }
        !pairs.is_empty()
    }

    pub fn count(&self) -> usize {
        self.strips.len()
    }

    /// Returns the values of joint 1 at the slices before the strips.
    pub fn slices(&self) -> Vec<f64> {
        self.strips.iter().map(|strip| strip.from).collect()
    }

    /// Returns true if no more strips may be added.
    pub fn are_too_many(&self) -> bool {
        self.strips.len() > MAX_STRIPS.min(self.closed.max_slices())
    }

    fn place(&self, number: i64) -> (usize, f64) {
        let n = self.strips.len() as i64;
        // Most numbers are on the first turn. A division would cost more than all the rest.
        if (0..n).contains(&number) {
            return (number as usize, 0.0);
        }
        (number.rem_euclid(n) as usize, number.div_euclid(n) as f64 * TAU)
    }

    pub fn index(&self, number: i64) -> usize {
        self.place(number).0
    }

    /// Returns the shift of joint 1, in radians, from a strip's own values to those on the turn that its number means.
    pub fn turns(&self, number: i64) -> f64 {
        self.place(number).1
    }

    /// Returns the two values of joint 1 that bound a strip, by its index.
    pub fn ends(&self, index: usize) -> [f64; 2] {
        [self.strips[index].from, self.strips[index].to]
    }

    /// Returns the value of joint 1 at a slice.
    pub fn q1(&self, slice: i64) -> f64 {
        let n = self.strips.len();
        if slice == n as i64 && !self.topology.ranges[0].is_circle() {
            return self.strips[n - 1].to;
        }
        let (index, turns) = self.place(slice);
        self.strips[index].from + turns
    }

    /// Returns true if there are strips on both sides of a slice.
    pub fn is_inner(&self, slice: i64) -> bool {
        self.topology.ranges[0].is_circle() || 0 < slice && slice < self.strips.len() as i64
    }

    /// Returns the strip that contains a value of joint 1, up to the rounding of whole turns. A value at a slice counts for the
    /// strip before it.
    pub fn locate(&self, q1: f64) -> i64 {
        let last = self.strips.len() - 1;
        let (value, turns) = match self.topology.ranges[0] {
            JointRange::Interval { .. } => (q1, 0),
            JointRange::Circle => {
                let turns = ((q1 - self.strips[0].from) / TAU).floor();
                (q1 - turns * TAU, turns as i64)
            }
        };
        let index = self.strips.partition_point(|strip| strip.to < value).min(last);
        index as i64 + turns * self.strips.len() as i64
    }

    /// Returns the strips that contain a value of joint 1, which are two at a slice. Compares with the slices on that turn, so
    /// the result may differ from [`Strips::locate`] by rounding.
    pub fn strips_at(&self, q1: f64) -> Vec<i64> {
        let near = self.locate(q1);
        let exists = |strip: i64| self.topology.ranges[0].is_circle() || (0..self.strips.len() as i64).contains(&strip);
        let holds = |strip: &i64| exists(*strip) && self.q1(*strip) <= q1 && q1 <= self.q1(*strip + 1);
        (near - 1..=near + 1).filter(holds).collect()
    }

    /// Returns the cell of a strip that contains `q2` at `share`: 0 is the slice before the strip, 1 the slice after it. `None`
    /// if the strip is closed.
    pub fn cell(&mut self, strip: i64, share: f64, q2: f64) -> Option<Cell> {
        let index = self.index(strip);
        self.find_barriers(index);
        let strip = &self.strips[index];
        let barriers = strip.barriers.as_deref().unwrap_or(&[]);
        let whole = Cell { lower: [f64::NEG_INFINITY; 2], upper: [f64::INFINITY; 2] };
        let (Some(first), Some(last)) = (barriers.first(), barriers.last()) else {
            return (!strip.closed).then_some(whole);
        };
        let at = |(barrier, _): &(Barrier, usize)| barrier[0] + (barrier[1] - barrier[0]) * share;
        let round = self.topology.ranges[1].is_circle();
        let turns = if round { ((q2 - at(first)) / TAU).floor() } else { 0.0 };
        let value = q2 - turns * TAU;
        let after = barriers.partition_point(|barrier| at(barrier) <= value);
        let below = after.checked_sub(1).map(|below| barriers[below].0);
        let above = barriers.get(after).map(|above| above.0);
        let cell = if round {
            Cell {
                lower: below.unwrap_or_else(|| last.0.map(|q2| q2 - TAU)),
                upper: above.unwrap_or_else(|| first.0.map(|q2| q2 + TAU)),
            }
        } else {
            Cell { lower: below.unwrap_or(whole.lower), upper: above.unwrap_or(whole.upper) }
        };
        Some(cell.turned(turns))
    }

    /// Returns the portals of an inner slice. Each of them is within one cell of either adjacent strip.
    pub fn portals(&mut self, slice: i64) -> &[Portal] {
        let (before, after) = (self.index(slice - 1), self.index(slice));
        if self.strips[after].portals.is_none() {
            self.find_barriers(before);
            self.find_barriers(after);
            let axis = self.topology.ranges[1];
            let mut closed = Vec::new();
            for wall in self.walls(after) {
                closed.extend(within_domain(axis, wall.lower, wall.upper));
            }
            closed.extend(self.topology.closed_by_sum([self.strips[after].from; 2]));
            for (strip, side) in [(before, 1), (after, 0)] {
                let barriers = self.strips[strip].barriers.iter().flatten();
                closed.extend(barriers.map(|(barrier, _)| [axis.wrap(barrier[side]); 2]));
            }
            merge_in_place(&mut closed);
            let is_closed = self.strips[before].closed || self.strips[after].closed;
            self.strips[after].portals = Some(if is_closed { Vec::new() } else { free_portals(&closed, axis) });
        }
        self.strips[after].portals.as_deref().unwrap_or(&[])
    }

    /// Returns the free interval that contains a value of joint 2 on a slice, up to [`PORTAL_TOLERANCE`]. `None` if the value is
    /// closed. With a continuous joint, the interval ends at half a turn on either side of the value.
    pub fn free_around(&mut self, slice: i64, q2: f64) -> Option<[f64; 2]> {
        self.nearest_free(slice, q2, |portal| {
            portal.lower - PORTAL_TOLERANCE <= q2 && q2 <= portal.upper + PORTAL_TOLERANCE
        })
    }

    /// Returns the free interval nearest to `q2` among those that satisfy a condition.
    pub fn nearest_free(
        &mut self,
        slice: i64,
        q2: f64,
        mut condition: impl FnMut(&Portal) -> bool,
    ) -> Option<[f64; 2]> {
        let axis = self.topology.ranges[1];
        if !self.is_inner(slice) {
            return None;
        }
        let turns = if axis.is_circle() { ((q2 - axis.domain().0) / TAU).floor() * TAU } else { 0.0 };
        let (bottom, top) = if axis.is_circle() { (q2 - PI, q2 + PI) } else { axis.domain() };
        let portals =
            self.portals(slice).iter().flat_map(|portal| [-1.0, 0.0, 1.0].map(|by| portal.turned(by + turns / TAU)));
        let off = |portal: &Portal| f64::max(portal.lower - q2, q2 - portal.upper).max(0.0);
        let nearest = portals.filter(|portal| condition(portal)).min_by(|a, b| off(a).total_cmp(&off(b)));
        let within = nearest.map(|portal| [portal.lower.max(bottom), portal.upper.min(top)]);
        // The nearest suitable interval may be more than half a turn away.
        within.filter(|[lower, upper]| lower <= upper)
    }

    /// Returns the parts of a goal segment that are not closed, if joint 1 is constant along it. Otherwise returns the whole
    /// segment; the search excludes the parts in closed strips.
    pub fn open_goals(&mut self, piece: &Segment) -> Vec<Segment> {
        let [from, to] = piece.ends();
        let axis = self.topology.ranges[1];
        let ((bottom, top), (low, high)) = ((from[1].min(to[1]), from[1].max(to[1])), axis.domain());
        if piece.is_point() || from[0] != to[0] || bottom < low || high < top {
            return vec![*piece];
        }
        let walls = self.closed.walls(self.topology.ranges[0].wrap(from[0]));
        let mut closed: Vec<[f64; 2]> =
            walls.iter().flat_map(|wall| within_domain(axis, wall.lower, wall.upper)).collect();
        merge_in_place(&mut closed);
        let mut open = Vec::new();
        let mut at = bottom;
        for [lower, upper] in closed.into_iter().chain([[top, f64::INFINITY]]) {
            if at < lower.min(top) {
                open.push([at, lower.min(top)].map(|q2| Configuration::new(from[0], q2)));
            }
            at = at.max(upper);
        }
        open.into_iter().map(|[from, to]| Segment::new(from, to)).collect()
    }

    /// Returns the walls on the slice before a strip.
    fn walls(&mut self, index: usize) -> &[Wall] {
        let from = self.strips[index].from;
        self.strips[index].walls.get_or_insert_with(|| self.closed.walls(from))
    }

    /// Finds the barriers of a strip: lines between walls of one pair on both slices.
    fn find_barriers(&mut self, index: usize) {
        if self.strips[index].barriers.is_some() {
            return;
        }
        let mut barriers = Vec::new();
        if !self.strips[index].closed {
            let next = (index + 1) % self.strips.len();
            let is_last = next == 0 && !self.topology.ranges[0].is_circle();
            self.walls(index);
            if !is_last {
                self.walls(next);
            }
            let before = self.strips[index].known_walls();
            let after = if is_last { &self.last } else { self.strips[next].known_walls() };
            let (from, to) = (self.strips[index].from, self.strips[index].to);
            for (left, right) in limit_candidates(of_the_same_pairs(before, after)) {
                barriers.extend(self.barrier([from, to], left, right).map(|barrier| (barrier, left.pair)));
            }
            barriers.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
            // Omits barriers that cross others: cells must be convex.
            barriers.dedup_by(|(next, _), (kept, _)| next[0] <= kept[0] || next[1] <= kept[1]);
            if self.topology.ranges[1].is_circle() {
                while let [(first, _), .., (last, _)] = barriers.as_slice()
                    && (0..2).any(|side| last[side] >= first[side] + TAU)
                {
                    barriers.pop();
                }
            }
        }
        self.strips[index].barriers = Some(barriers);
    }

    /// Returns a line between two walls of a pair along which the pair is proven to be too near. The line is at a value of joint
    /// 2 that both walls contain, if there is one; otherwise it connects the middles of the walls. Lines at one value do not
    /// cross where walls split and merge.
    fn barrier(&self, slices: [f64; 2], left: &Wall, right: &Wall) -> Option<Barrier> {
        let circle = self.topology.ranges[1].is_circle();
        let middle = |wall: &Wall| f64::midpoint(wall.lower, wall.upper);
        let turns = if circle { ((middle(left) - middle(right)) / TAU).round() * TAU } else { 0.0 };
        let (lower, upper) = (left.lower.max(right.lower + turns), left.upper.min(right.upper + turns));
        let level = (lower < upper).then(|| [f64::midpoint(lower, upper); 2]);
        let slanted = [middle(left), middle(right) + turns];
        let proven = |ends: &Barrier| {
            let [from, to] = [0, 1].map(|side| Configuration::new(slices[side], ends[side]));
            self.closed.all_along(left.pair, from, to)
        };
        let barrier = [level, Some(slanted)].into_iter().flatten().find(proven)?;
        let back = self.topology.ranges[1].wrap(barrier[0]) - barrier[0];
        Some(if circle { barrier.map(|q2| q2 + back) } else { barrier })
    }

    /// Returns the distances, downwards and upwards, from `q2` to the ends of the wall that contains it halfway through a strip.
    /// `None` if no wall does.
    pub fn distances_out_of_middle(&mut self, index: usize, q2: f64) -> Option<[f64; 2]> {
        let strip = &mut self.strips[index];
        let walls = strip.middle.get_or_insert_with(|| self.closed.walls(f64::midpoint(strip.from, strip.to)));
        let axis = self.topology.ranges[1];
        let mut closed: Vec<[f64; 2]> =
            walls.iter().flat_map(|wall| within_domain(axis, wall.lower, wall.upper)).collect();
        merge_in_place(&mut closed);
        let value = axis.wrap(q2);
        let wall = closed.iter().find(|wall| wall[0] < value && value < wall[1]);
        wall.map(|wall| [wall[0] - value, wall[1] - value])
    }

    /// Halves the given strips (ascending, each once) except those of the least width. Returns true if it halved any.
    pub fn halve(&mut self, which: &[usize]) -> bool {
        let cuts: Vec<(usize, Vec<f64>)> = which.iter().map(|&index| (index, Vec::new())).collect();
        self.cut(&cuts)
    }

    /// Cuts the given strips (ascending, each once) except those of the least width. A strip is cut at the given values of joint
    /// 1 (ascending), or in half if there are none. Returns true if it cut any.
    pub fn cut(&mut self, which: &[(usize, Vec<f64>)]) -> bool {
        let before = std::mem::take(&mut self.strips);
        let count = before.len();
        self.strips.reserve(count + which.len());
        let mut which = which.iter().peekable();
        let mut is_beside = false;
        for (index, mut strip) in before.into_iter().enumerate() {
            let chosen =
                which.next_if(|(chosen, _)| *chosen == index).filter(|_| strip.to - strip.from > MIN_STRIP_WIDTH);
            if std::mem::replace(&mut is_beside, chosen.is_some()) {
                strip.portals = None;
            }
            let Some((_, cuts)) = chosen else {
                self.strips.push(strip);
                continue;
            };
            let middle = [f64::midpoint(strip.from, strip.to)];
            let apart = |cut: &f64| cut - strip.from > MIN_STRIP_WIDTH / 4.0 && strip.to - cut > MIN_STRIP_WIDTH / 4.0;
            let mut cuts: Vec<f64> = cuts.iter().copied().filter(apart).collect();
            cuts.dedup_by(|next, kept| *next - *kept < MIN_STRIP_WIDTH / 4.0);
            if cuts.is_empty() {
                cuts.extend(middle);
            }
            let ends: Vec<f64> = [strip.from].into_iter().chain(cuts).chain([strip.to]).collect();
            for pair in ends.windows(2) {
                let mut part = Strip::new(pair[0], pair[1], strip.closed);
                if pair[0] == strip.from {
                    part.walls = strip.walls.take();
                } else if pair[0] == middle[0] {
                    part.walls = strip.middle.take();
                }
                self.strips.push(part);
            }
        }
        // Across the seam.
        if is_beside && let Some(first) = self.strips.first_mut() {
            first.portals = None;
        }
        self.strips.len() > count
    }
}

/// Returns pairs of walls on two slices that belong to the same pair of shapes. Both lists must be in the order of the pairs of
/// shapes.
fn of_the_same_pairs<'w>(before: &'w [Wall], after: &'w [Wall]) -> Vec<(&'w Wall, &'w Wall)> {
    let mut both = Vec::new();
    let mut rest = after;
    for of_pair in before.chunk_by(|a, b| a.pair == b.pair) {
        let pair = of_pair[0].pair;
        rest = &rest[rest.partition_point(|wall| wall.pair < pair)..];
        let same = &rest[..rest.partition_point(|wall| wall.pair == pair)];
        both.extend(of_pair.iter().flat_map(|left| same.iter().map(move |right| (left, right))));
    }
    both
}

/// Returns the candidates for barriers. If there are too many, sorts them by the middles of their first walls, and returns some
/// that are spread evenly.
fn limit_candidates<'w>(mut candidates: Vec<(&'w Wall, &'w Wall)>) -> Vec<(&'w Wall, &'w Wall)> {
    if candidates.len() > MAX_BARRIERS {
        candidates.sort_by(|a, b| (a.0.lower + a.0.upper).total_cmp(&(b.0.lower + b.0.upper)));
        let count = candidates.len();
        candidates = (0..MAX_BARRIERS).map(|k| candidates[k * count / MAX_BARRIERS]).collect();
    }
    candidates
}

/// Adjusts ascending bands so that each is at least [`MIN_SLICE_DISTANCE`] wide, and at least as far from other bands and from
/// the ends of the domain.
fn spread_bands(bands: Vec<[f64; 2]>, [lower, upper]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut bands: Vec<[f64; 2]> = bands
        .into_iter()
        .map(|band| {
            let from = if band[0] - lower <= MIN_SLICE_DISTANCE { lower } else { band[0] };
            let to = if upper - band[1] <= MIN_SLICE_DISTANCE { upper } else { band[1] };
            [from, to]
        })
        .collect();
    bands.dedup_by(|next, kept| {
        let touch = next[0] - kept[1] <= MIN_SLICE_DISTANCE;
        if touch {
            kept[1] = kept[1].max(next[1]);
        }
        touch
    });
    bands.retain(|band| band[1] - band[0] > MIN_SLICE_DISTANCE);
    bands
}
