//! The shortest path around walls and barriers.
//!
//! petgraph does not fit: nodes appear when they become visible, and the search may end at a bound instead of a goal.

use super::portals::Portal;
use super::strips::{Cell, Strips};
use cplan_geometry::{OpenList, Point};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Measure, Segment};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::hash::{BuildHasherDefault, Hasher};

/// Largest number of entries that the search takes from the open list: a thousand times the usual number, or half a second. Then
/// it ends with the bound so far. Along an arc, the number grows with the square of the number of slices.
const MAX_ENTRIES: usize = 1_000_000;

/// Initial capacity of the lists of the search.
const USUAL_ENTRIES: usize = 1024;

/// Relative difference of costs that rounding alone can cause.
const COST_TOLERANCE: f64 = 1e-12;

/// Margin by which a cone of sight extends beyond the end of a portal, as a share of the coordinates. It exceeds rounding errors.
/// Without it, a portal's end in line with two others, as on a straight side, could be in a gap between two cones.
const SIGHT_MARGIN: f64 = 4.0 * f64::EPSILON;

/// Result of the search.
pub(super) enum SearchResult {
    /// The shortest path: its length and corners.
    Shortest(f64, Vec<Point>),
    /// No path is shorter than this.
    NoneBelow(f64),
}

/// A fast hasher for a few numbers. It does not resist attacks, but all numbers come from the search itself.
#[derive(Default)]
pub(super) struct MixingHasher(u64);

impl Hasher for MixingHasher {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_ne_bytes(word));
        }
    }

    fn write_u64(&mut self, number: u64) {
        // An odd number near the golden section of 2^64 (Knuth).
        self.0 = (self.0.rotate_left(26) ^ number).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
}

/// A place where paths begin or turn.
struct Root {
    at: Point,
    cost: f64,
    before: Option<u32>,
}

#[derive(Clone, Copy)]
enum Entry {
    /// The part of a slice through which a root sees the strip beyond.
    Cone(Cone),
    /// A goal, by its node, with its point nearest to the root that sees it.
    Goal(u32, Point),
    /// A root on the edge of a strip: the root's index and the strip's number. It sees the whole cell of the strip that it
    /// touches.
    Root(u32, i64),
}

#[derive(Clone, Copy)]
struct Cone {
    root: u32,
    slice: i64,
    /// True if joint 1 grows along the path.
    ahead: bool,
    seen: Portal,
}

impl Cone {
    /// Returns the strip that the cone enters.
    fn strip(&self) -> i64 {
        if self.ahead { self.slice } else { self.slice - 1 }
    }

    /// Returns the slice beyond that strip.
    fn far_slice(&self) -> i64 {
        if self.ahead { self.slice + 1 } else { self.slice - 1 }
    }
}

/// A search by A* whose open list holds cones of sight, similar to Polyanya (Cui, Harabor, Grastien 2017). It covers the cells of
/// the strips and all their copies, shifted by whole turns. Cells are convex, so only walls on slices obstruct sight, and paths
/// turn only at the ends of portals. From such an end, a path continues either beyond the slice, towards the wall whose end it
/// passes, or along the slice to the next portal, which leads back.
///
/// The search finds the shortest path, with any number of turns. Of all paths to the end of a portal, it follows only the
/// shortest. This suffices: if a longer path could continue taut where the shortest could not, cutting the corner of the shortest
/// would make it even shorter.
pub(super) struct Search<'s, 'a> {
    strips: &'s mut Strips<'a>,
    measure: Measure,
    goals: &'s [Segment],
    /// Least and greatest value of joint 1 among the goals.
    goals_range: [f64; 2],
    /// Paths of this length or more are ignored.
    limit: f64,
    /// Range of joint 2 for paths shorter than the limit.
    range: [f64; 2],
    roots: Vec<Root>,
    /// Least cost so far at each end of a portal. The first number of the key has the slice, and whether joint 1 grows from
    /// there; the second has the value of joint 2.
    least: HashMap<(i64, u64), f64, BuildHasherDefault<MixingHasher>>,
    open: OpenList<usize>,
    entries: Vec<Entry>,
    /// Unused lists of portals, for reuse.
    unused_lists: Vec<Vec<Portal>>,
}

impl<'s, 'a> Search<'s, 'a> {
    pub fn new(strips: &'s mut Strips<'a>, measure: Measure, goals: &'s [Segment], limit: f64) -> Self {
        let values = || goals.iter().flat_map(Segment::ends).map(|goal| goal[0]);
        Self {
            strips,
            measure,
            goals,
            goals_range: [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)],
            limit,
            range: [f64::NEG_INFINITY, f64::INFINITY],
            roots: Vec::with_capacity(USUAL_ENTRIES / 8),
            least: HashMap::default(),
            open: OpenList::default(),
            entries: Vec::with_capacity(USUAL_ENTRIES),
            unused_lists: Vec::new(),
        }
    }

    /// Finds the shortest path from `start` to one of the goals.
    pub fn run(mut self, start: Point) -> SearchResult {
        let far = self.limit / self.measure.least_of_second();
        self.range = [start.y - far, start.y + far];
        self.roots.push(Root { at: start, cost: 0.0, before: None });
        for strip in self.strips.strips_at(start.x) {
            self.add_visible(0, strip, 0.0);
        }
        let mut taken = 0;
        while let Some((bound, number)) = self.open.pop() {
            checkpoint();
            taken += 1;
            if taken > MAX_ENTRIES {
                return SearchResult::NoneBelow(bound);
            }
            match self.entries[number] {
                Entry::Goal(root, goal) => return SearchResult::Shortest(bound, self.corners(root, goal)),
                Entry::Cone(cone) => self.expand(&cone, bound),
                Entry::Root(root, strip) => self.add_visible(root, strip, bound),
            }
        }
        SearchResult::NoneBelow(self.limit)
    }

    fn corners(&self, root: u32, goal: Point) -> Vec<Point> {
        let mut corners = vec![goal];
        let mut next = Some(root);
        while let Some(root) = next {
            let root = &self.roots[root as usize];
            corners.push(root.at);
            next = root.before;
        }
        corners.reverse();
        corners
    }

    fn push(&mut self, bound: f64, entry: Entry) {
        if bound < self.limit {
            self.open.push(bound, self.entries.len());
            self.entries.push(entry);
        }
    }

    /// Adds the goal that is nearest to a root, which must see all `goals`.
    fn push_goal(&mut self, root: u32, goals: &Segment, parent: f64) {
        let Root { at, cost, .. } = self.roots[root as usize];
        let goal = goals.nearest(self.measure, at);
        self.push((cost + self.measure.norm(goal - at)).max(parent), Entry::Goal(root, goal));
    }

    /// Adds a cone through the part of `portal` between `from` and `to`, unless it is empty.
    fn push_cone(&mut self, root: u32, slice: i64, ahead: bool, portal: &Portal, [from, to]: [f64; 2], parent: f64) {
        let (from, to) = (from.max(self.range[0]), to.min(self.range[1]));
        let (lower, upper) = (portal.lower.max(from), portal.upper.min(to));
        if lower > upper {
            return;
        }
        let tips = [portal.tips[0] && portal.lower >= from, portal.tips[1] && portal.upper <= to];
        let x = self.strips.q1(slice);
        let Root { at, cost, .. } = self.roots[root as usize];
        let (right, left) = if ahead { (lower, upper) } else { (upper, lower) };
        let side = if ahead { 1.0 } else { -1.0 };
        let line = [Point::new(x, right - side), Point::new(x, left + side)];
        let ends = [Point::new(x, right), Point::new(x, left)];
        let through = |goal: &Segment| self.measure.bound_through(at, ends, line, goal);
        let bound = cost + self.goals.iter().map(through).fold(f64::INFINITY, f64::min);
        let seen = Portal { lower, upper, tips };
        self.push(bound.max(parent), Entry::Cone(Cone { root, slice, ahead, seen }));
    }

    /// Adds a root at the end of a portal that is reached straight from another root. From there, joint 1 grows if `ahead` is
    /// true, otherwise it falls. Returns `None` if another path, as short or shorter, has reached the same end and continues in
    /// the same direction.
    fn turn(&mut self, from: u32, slice: i64, at: Point, ahead: bool) -> Option<u32> {
        let Root { at: before, cost, .. } = self.roots[from as usize];
        let cost = cost + self.measure.norm(at - before);
        let key = |ahead: bool| (2 * slice + i64::from(ahead), at.y.to_bits());
        let least = |ahead: bool| self.least.get(&key(ahead)).copied().unwrap_or(f64::INFINITY);
        if cost >= least(ahead) * (1.0 - COST_TOLERANCE) || cost > least(!ahead) * (1.0 + COST_TOLERANCE) {
            return None;
        }
        self.least.insert(key(ahead), cost);
        self.roots.push(Root { at, cost, before: Some(from) });
        u32::try_from(self.roots.len() - 1).ok()
    }

    /// Returns the portals of a slice, with all their copies, that meet a range of joint 2. Omits portals that no path shorter
    /// than the limit can reach. The caller returns the list to `unused_lists`.
    fn portals(&mut self, slice: i64, [lower, upper]: [f64; 2]) -> Vec<Portal> {
        let (lower, upper) = (lower.max(self.range[0]), upper.min(self.range[1]));
        let mut portals = self.unused_lists.pop().unwrap_or_default();
        portals.clear();
        if !self.strips.is_inner(slice) {
            return portals;
        }
        let round = self.strips.topology().ranges[1].is_circle();
        for gap in self.strips.portals(slice) {
            if !round || gap.lower.is_infinite() {
                if gap.lower <= upper && lower <= gap.upper {
                    portals.push(*gap);
                }
                continue;
            }
            let (first, last) = (((lower - gap.upper) / TAU).ceil(), ((upper - gap.lower) / TAU).floor());
            for turns in first as i64..=last as i64 {
                let portal = gap.turned(turns as f64);
                if portal.lower <= upper && lower <= portal.upper {
                    portals.push(portal);
                }
            }
        }
        portals
    }

    /// Returns the goals in a cell of a strip. Segments are cut to their part in the cell.
    fn goals(&self, strip: i64, cell: Cell) -> impl Iterator<Item = Segment> + use<'s> {
        let (from, to) = (self.strips.q1(strip), self.strips.q1(strip + 1));
        // Most strips contain no goals.
        let is_beside_all = to < self.goals_range[0] || self.goals_range[1] < from;
        let goals = if is_beside_all { &[] } else { self.goals };
        let beside = move |goals: &&Segment| {
            let [a, b] = goals.ends();
            a[0].max(b[0]) >= from && a[0].min(b[0]) <= to
        };
        goals.iter().filter(beside).filter_map(move |goals| {
            let part = goals.within([from, f64::NEG_INFINITY], [to, f64::INFINITY])?;
            let beyond = |part: &Segment, side: usize| {
                part.ends().map(|q| {
                    let [lower, upper] = cell.at((q[0] - from) / (to - from));
                    if side == 0 { q[1] - lower } else { upper - q[1] }
                })
            };
            (0..2).try_fold(part, |part, side| {
                let [a, b] = beyond(&part, side);
                part.where_positive(a, b)
            })
        })
    }

    /// Adds all that a root in a strip or on its edge sees in the strip.
    fn add_visible(&mut self, root: u32, strip: i64, parent: f64) {
        let at = self.roots[root as usize].at;
        let (from, to) = (self.strips.q1(strip), self.strips.q1(strip + 1));
        let Some(cell) = self.strips.cell(strip, (at.x - from) / (to - from), at.y) else { return };
        for goal in self.goals(strip, cell) {
            self.push_goal(root, &goal, parent);
        }
        for (slice, ahead, share) in [(strip, false, 0.0), (strip + 1, true, 1.0)] {
            let range = cell.at(share);
            let portals = self.portals(slice, range);
            if self.strips.q1(slice) == at.x {
                self.follow_slice(root, slice, !ahead, portals.iter(), parent);
            } else {
                for portal in &portals {
                    self.push_cone(root, slice, ahead, portal, range, parent);
                }
            }
            self.unused_lists.push(portals);
        }
    }

    /// Follows paths along a slice from a root on it to other portals of that slice, through which they lead to the strip on the
    /// other side. `ahead` is true if paths come from the strip after the slice.
    fn follow_slice<'p>(
        &mut self,
        root: u32,
        slice: i64,
        ahead: bool,
        portals: impl Iterator<Item = &'p Portal>,
        parent: f64,
    ) {
        let at = self.roots[root as usize].at;
        for portal in portals {
            let end = if portal.lower > at.y {
                portal.lower
            } else if portal.upper < at.y {
                portal.upper
            } else {
                continue;
            };
            if let Some(root) = self.turn(root, slice, Point::new(at.x, end), !ahead) {
                let Root { at, cost, .. } = self.roots[root as usize];
                let distances = self.goals.iter().map(|goal| goal.distance(self.measure, at));
                let nearest = distances.fold(f64::INFINITY, f64::min);
                self.push((cost + nearest).max(parent), Entry::Root(root, if ahead { slice - 1 } else { slice }));
            }
        }
    }

    /// Adds all that is seen through a cone, and all that paths reach by turning at the cone's ends.
    fn expand(&mut self, cone: &Cone, bound: f64) {
        let Cone { root, slice, ahead, seen } = *cone;
        let x = self.strips.q1(slice);
        let from = self.roots[root as usize].at;
        let (near, beyond) = if ahead { (0.0, 1.0) } else { (1.0, 0.0) };
        let Some(cell) = self.strips.cell(cone.strip(), near, f64::midpoint(seen.lower, seen.upper)) else { return };
        let below = if seen.tips[0] { self.turn(root, slice, Point::new(x, seen.lower), ahead) } else { None };
        let above = if seen.tips[1] { self.turn(root, slice, Point::new(x, seen.upper), ahead) } else { None };
        let hair = [seen.lower, seen.upper].map(|y| SIGHT_MARGIN * (1.0 + from.y.abs() + y.abs()));
        for goals in self.goals(cone.strip(), cell) {
            // The distance above the line from the root through a value on the slice.
            let above_line = |goals: &Segment, at: f64| {
                let slope = (at - from.y) / (x - from.x);
                goals.ends().map(|goal| goal[1] - from.y - slope * (goal[0] - from.x))
            };
            let (lowest, highest) = (seen.lower - hair[0], seen.upper + hair[1]);
            let low = above_line(&goals, lowest);
            let in_sight = goals.where_positive(low[0], low[1]).and_then(|goals| {
                let [a, b] = above_line(&goals, highest);
                goals.where_positive(-a, -b)
            });
            if let Some(goals) = in_sight {
                self.push_goal(root, &goals, bound);
            }
            let high = above_line(&goals, highest);
            let by = [below.filter(|_| low.iter().any(|a| *a < 0.0)), above.filter(|_| high.iter().any(|a| *a > 0.0))];
            for by in by.into_iter().flatten() {
                self.push_goal(by, &goals, bound);
            }
        }
        let far = cone.far_slice();
        if self.strips.is_inner(far) {
            let stretch = (self.strips.q1(far) - from.x) / (x - from.x);
            let [low, high] = [seen.lower, seen.upper].map(|y| from.y + (y - from.y) * stretch);
            let [under, over] = hair.map(|hair| hair * stretch);
            let [bottom, top] = cell.at(beyond);
            let portals = self.portals(far, [bottom, top]);
            for portal in &portals {
                self.push_cone(root, far, ahead, portal, [bottom.max(low - under), top.min(high + over)], bound);
                if let Some(below) = below.filter(|_| portal.lower < low + under) {
                    self.push_cone(below, far, ahead, portal, [bottom, top.min(low + under)], bound);
                }
                if let Some(above) = above.filter(|_| portal.upper > high - over) {
                    self.push_cone(above, far, ahead, portal, [bottom.max(high - over), top], bound);
                }
            }
            self.unused_lists.push(portals);
        }
        if below.or(above).is_some() {
            let portals = self.portals(slice, cell.at(near));
            for (root, is_below) in [(below, true), (above, false)] {
                if let Some(root) = root {
                    let beside = portals.iter().filter(|portal| (portal.upper < seen.upper) == is_below);
                    self.follow_slice(root, slice, ahead, beside, bound);
                }
            }
            self.unused_lists.push(portals);
        }
    }
}
