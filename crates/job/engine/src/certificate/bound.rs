//! Evidence that no motion is shorter than a bound: walls that motions cannot cross, and potentials of the walls' ends.
//!
//! A potential is a lower bound on the length of paths from the start to a place. The checker requires that along each leg
//! between two places, the potential grows by at most the leg's length, unless a wall bars the leg. The lengths of shortest paths
//! from the start satisfy this as long as they are below the bound. For other places, the checker takes the bound minus the least
//! remaining length, so the certificate need not state their potentials. To make the evidence, shortest paths are computed once
//! more, among the walls alone, with every leg counted slightly shorter than it is. Walls that bar no leg are then dropped.

use cplan_geometry::OpenList;
use cplan_interrupt::checkpoint;
use cplan_model::space::{Configuration, JointRange, Metric, Topology};
use cplan_proofs::ClosedSegment;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// A length, and the evidence that no motion is shorter.
pub(super) struct LeastLength {
    pub length: f64,
    pub walls: Vec<ClosedSegment>,
    pub potentials: Vec<Potential>,
}

/// A lower bound on the lengths of all paths from the start to one end of a wall. A wall is a segment of colliding
/// configurations, which paths cannot cross.
pub(super) struct Potential {
    pub wall: usize,
    pub end: usize,
    pub turns: [i64; 2],
    pub value: f64,
}

/// Fraction by which the evidence shortens each straight leg of a path, to allow for rounding.
const LEG_ROUNDING: f64 = 1e-8;

/// Fraction of the whole length by which the evidence additionally shortens each leg. It is far above rounding errors.
const TOTAL_ROUNDING: f64 = 1e-11;

/// A leg counts as crossing a wall if it crosses at least this far from the wall's ends, as a fraction of the wall's length.
const WALL_END_MARGIN: f64 = 1e-9;

/// Number of rounds in which unnecessary walls are dropped. Each round drops fewer than the previous one.
const PRUNING_ROUNDS: usize = 2;

/// Largest number of wall ends from which paths are extended.
const MAX_EXTENDED_ENDS: usize = 20_000;

/// The start and the goals of the paths, and the limits of the search for paths.
pub(super) struct PathLimits<'a> {
    pub topology: &'a Topology,
    pub metric: Metric,
    pub start: Configuration,
    pub goals: &'a [Configuration],
    /// Greatest distance from a goal at which a path may end, as a fraction of the limit.
    pub goal_tolerance: f64,
    /// Length of the longest paths that are considered.
    pub limit: f64,
}

/// A copy of a wall, shifted by whole turns.
struct WallCopy {
    wall: usize,
    turns: [i64; 2],
    ends: [Configuration; 2],
}

/// An end of a wall, at which a path can turn.
#[derive(Clone, Copy)]
struct Corner {
    wall: usize,
    end: usize,
    turns: [i64; 2],
    at: Configuration,
    line: Line,
    /// Lower bound on the length of paths from this end to a goal.
    rest: f64,
    /// Length of the shortest path to this end. Infinite if no path below the limit reaches it.
    reached: f64,
}

/// A place from which paths extend: the start, or an end of a wall.
#[derive(Clone, Copy)]
struct Source {
    at: Configuration,
    line: Option<Line>,
    potential: f64,
}

/// A line of constant joint 1: the bits of its value, and the number of whole turns.
type Line = (u64, i64);

/// Overlapping walls on one line, as a single range of joint 2. `beside` lists the walls that reach the line from either side and
/// end within the range.
struct WallRun {
    ends: [f64; 2],
    walls: Vec<usize>,
    beside: [Vec<(f64, usize)>; 2],
}

impl LeastLength {
    /// Creates the evidence from these walls. `None` if they prove no bound.
    pub(super) fn new(limits: &PathLimits, walls: Vec<ClosedSegment>) -> Option<Self> {
        let mut plane = Plane::new(limits, &walls);
        let length = plane.lengths()? - limits.leg_reduction();
        // Fewer walls have fewer ends from which paths extend, so that even fewer walls are needed.
        for _ in 0..PRUNING_ROUNDS {
            let needed = plane.needed_walls(length);
            plane.copies.retain(|copy| needed.contains(&copy.wall));
            plane.runs = runs(&plane.copies, &walls);
            plane.corners.retain(|corner| needed.contains(&corner.wall));
        }
        let kept: BTreeSet<usize> = plane.copies.iter().map(|copy| copy.wall).collect();
        let number: BTreeMap<usize, usize> = kept.iter().enumerate().map(|(new, old)| (*old, new)).collect();
        let potentials = plane.corners.iter().filter_map(|corner| {
            let value = plane.potential(length, corner)?;
            Some(Potential { wall: number[&corner.wall], end: corner.end, turns: corner.turns, value })
        });
        let potentials = potentials.collect();
        Some(Self { length, potentials, walls: kept.into_iter().map(|wall| walls[wall]).collect() })
    }
}

impl PathLimits<'_> {
    /// Returns the length by which each leg is shortened in addition to [`LEG_ROUNDING`].
    fn leg_reduction(&self) -> f64 {
        TOTAL_ROUNDING * self.limit
    }

    /// Returns the length of a leg, shortened as in the evidence.
    fn leg(&self, from: Configuration, to: Configuration) -> f64 {
        (self.metric.norm(to - from) * (1.0 - LEG_ROUNDING) - self.leg_reduction()).max(0.0)
    }

    /// Returns a lower bound on the length from a configuration to a goal, given the displacement between them.
    fn to_goal(&self, displacement: Configuration) -> f64 {
        (self.metric.norm(displacement) - self.goal_tolerance * self.limit).max(0.0)
    }

    /// Returns the numbers of whole turns of a joint that move the range from `low` to `high` to values that paths can reach.
    fn turns(&self, joint: usize, low: f64, high: f64) -> std::ops::RangeInclusive<i64> {
        let JointRange::Circle = self.topology.ranges[joint] else { return 0..=0 };
        let reach = self.limit / self.metric.least(joint);
        let from = self.start[joint];
        ((from - reach - high) / TAU).floor() as i64..=((from + reach - low) / TAU).ceil() as i64
    }
}

struct Plane<'a> {
    limits: &'a PathLimits<'a>,
    /// Copies of the walls, sorted by the least value of joint 1.
    copies: Vec<WallCopy>,
    /// Largest extent of a wall along joint 1.
    widest: f64,
    runs: BTreeMap<Line, Vec<WallRun>>,
    corners: Vec<Corner>,
    goals: Vec<Configuration>,
}

impl<'a> Plane<'a> {
    fn new(limits: &'a PathLimits<'a>, walls: &[ClosedSegment]) -> Self {
        let shifted = |at: Configuration, turns: [i64; 2]| {
            Configuration::new(at[0] + TAU * turns[0] as f64, at[1] + TAU * turns[1] as f64)
        };
        let on_all_turns = |ends: &[Configuration]| {
            let [first, second] = [0, 1].map(|k| {
                let values = || ends.iter().map(|end| end[k]);
                limits.turns(k, values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
            });
            let pairs = first.flat_map(move |a| second.clone().map(move |b| [a, b]));
            pairs.collect::<Vec<_>>()
        };
        let mut copies = Vec::new();
        for (wall, closed) in walls.iter().enumerate() {
            for turns in on_all_turns(&closed.ends) {
                copies.push(WallCopy { wall, turns, ends: closed.ends.map(|end| shifted(end, turns)) });
            }
        }
        let goals: Vec<Configuration> = limits
            .goals
            .iter()
            .flat_map(|goal| on_all_turns(&[*goal]).into_iter().map(|turns| shifted(*goal, turns)))
            .collect();
        copies.sort_by(|a, b| a.begins().total_cmp(&b.begins()));
        let widest = copies.iter().map(|copy| (copy.ends[1][0] - copy.ends[0][0]).abs()).fold(0.0, f64::max);
        let runs = runs(&copies, walls);
        let mut corners = Vec::new();
        for copy in &copies {
            for end in 0..2 {
                let (value, at) = (walls[copy.wall].ends[end], copy.ends[end]);
                let is_outside = |k: usize| match limits.topology.ranges[k] {
                    JointRange::Interval { lower, upper } => value[k] <= lower || value[k] >= upper,
                    JointRange::Circle => false,
                };
                let rest = goals.iter().map(|goal| limits.to_goal(goal - at)).fold(f64::INFINITY, f64::min);
                let line = (value[0].to_bits(), copy.turns[0]);
                let is_within = runs.get(&line).is_some_and(|runs| runs.iter().any(|run| run.contains(at[1])));
                if !is_outside(0)
                    && !is_outside(1)
                    && !is_within
                    && limits.metric.norm(at - limits.start) + rest <= limits.limit
                {
                    let reached = f64::INFINITY;
                    corners.push(Corner { wall: copy.wall, end, turns: copy.turns, at, line, rest, reached });
                }
            }
        }
        Self { limits, copies, widest, runs, corners, goals }
    }

    /// Computes the lengths of shortest paths to a goal and, as far as they are shorter, to ends of walls. `None` if there are
    /// too many ends.
    fn lengths(&mut self) -> Option<f64> {
        let corners = &self.corners;
        let mut lengths = vec![f64::INFINITY; corners.len()];
        let mut open = OpenList::default();
        let mut best = self.limits.limit;
        let mut next = Some(self.start());
        for _ in 0..MAX_EXTENDED_ENDS {
            if let Some(from) = next {
                for goal in &self.goals {
                    let leg = self.limits.leg(from.at, *goal) - self.limits.goal_tolerance * self.limits.limit;
                    let length = from.potential + leg.max(0.0);
                    if length < best && !self.is_barred(from.at, from.line, *goal, None) {
                        best = length;
                    }
                }
                for (number, corner) in corners.iter().enumerate() {
                    let length = from.potential + self.limits.leg(from.at, corner.at);
                    let is_shorter = length < lengths[number] && length + corner.rest * (1.0 - LEG_ROUNDING) < best;
                    if is_shorter && !self.is_barred(from.at, from.line, corner.at, Some(corner.line)) {
                        lengths[number] = length;
                        open.push(length, number);
                    }
                }
            }
            checkpoint();
            let Some((length, number)) = open.pop().filter(|(length, _)| *length < best) else {
                self.corners.iter_mut().zip(lengths).for_each(|(corner, length)| corner.reached = length);
                return Some(best);
            };
            next = (length == lengths[number]).then(|| Source {
                at: corners[number].at,
                line: Some(corners[number].line),
                potential: length,
            });
        }
        None
    }

    /// Returns the potential of a corner: a lower bound on the length of paths to it. `None` if no path through the
    /// corner is shorter than `length`.
    fn potential(&self, length: f64, corner: &Corner) -> Option<f64> {
        (corner.reached + corner.rest < length - self.limits.leg_reduction() / 4.0).then_some(corner.reached)
    }

    /// Returns the walls that the evidence needs. A wall is needed if it bars a leg that would make potentials too small. Walls
    /// that contain an end of a needed wall are also needed.
    fn needed_walls(&self, length: f64) -> BTreeSet<usize> {
        let known = |corner: &Corner| {
            let potential = self.potential(length, corner)?;
            Some(Source { at: corner.at, line: Some(corner.line), potential })
        };
        let start = self.start();
        let mut needed = BTreeSet::new();
        for from in self.corners.iter().filter_map(known).chain([start]) {
            let grows = |leg: f64, potential: f64| from.potential + leg < potential + self.limits.leg_reduction() / 4.0;
            for goal in self.goals.iter().filter(|goal| grows(self.limits.to_goal(**goal - from.at), length)) {
                self.bar(from, *goal, None, &mut needed);
            }
            for corner in self.corners.iter() {
                let potential = self.potential(length, corner).unwrap_or(length - corner.rest);
                if grows(self.limits.metric.norm(corner.at - from.at), potential) {
                    self.bar(from, corner.at, Some(corner.line), &mut needed);
                }
            }
            checkpoint();
        }
        // As long as another wall is present, an end within it is no corner.
        for run in self.runs.values().flatten() {
            let is_needed = |wall: &usize| needed.contains(wall);
            let ends_within = run.beside.iter().flatten().any(|(_, wall)| is_needed(wall));
            if ends_within || run.walls.iter().any(is_needed) {
                needed.extend(&run.walls);
            }
        }
        needed
    }

    fn start(&self) -> Source {
        Source { at: self.limits.start, line: Some((self.limits.start[0].to_bits(), 0)), potential: 0.0 }
    }

    /// Adds walls that bar a leg, unless a wall that is already needed does.
    fn bar(&self, from: Source, to: Configuration, line: Option<Line>, needed: &mut BTreeSet<usize>) {
        let mut first = None;
        for copy in self.near(from.at, to).filter(|copy| crosses(&copy.ends, from.at, to)) {
            if needed.contains(&copy.wall) {
                return;
            }
            first = first.or(Some(copy.wall));
        }
        if let Some(wall) = first {
            needed.insert(wall);
        } else if let Some((run, beside)) = self.barring_run(from.at, from.line, to, line) {
            needed.extend(beside);
            needed.extend(&run.walls);
        }
    }

    fn is_barred(&self, from: Configuration, line: Option<Line>, to: Configuration, other: Option<Line>) -> bool {
        self.near(from, to).any(|copy| crosses(&copy.ends, from, to))
            || self.barring_run(from, line, to, other).is_some()
    }

    /// Iterates over the walls that a leg may cross, beginning with those near the leg's beginning.
    fn near(&self, from: Configuration, to: Configuration) -> impl Iterator<Item = &WallCopy> {
        let first = self.copies.partition_point(|copy| copy.begins() < from[0].min(to[0]) - self.widest);
        let last = self.copies.partition_point(|copy| copy.begins() <= from[0].max(to[0]));
        let near = &self.copies[first..last.max(first)];
        let (onward, back) = if from[0] <= to[0] { (near, &near[..0]) } else { (&near[..0], near) };
        onward.iter().chain(back.iter().rev())
    }

    /// Returns the run of walls that bars a leg along its line, and one wall on each side that ends there. Because of these two
    /// walls, the leg cannot pass the run on either side.
    fn barring_run(
        &self,
        from: Configuration,
        line: Option<Line>,
        to: Configuration,
        other: Option<Line>,
    ) -> Option<(&WallRun, [usize; 2])> {
        let runs = self.runs.get(&line.filter(|_| line == other)?)?;
        let hair = WALL_END_MARGIN * (to[1] - from[1]).abs();
        let passed = |(y, _): &&(f64, usize)| from[1].min(to[1]) + hair < *y && *y < from[1].max(to[1]) - hair;
        runs.iter().find_map(|run| {
            let [left, right] = run.beside.each_ref().map(|side| side.iter().find(passed));
            Some((run, [left?.1, right?.1]))
        })
    }
}

impl WallCopy {
    fn begins(&self) -> f64 {
        self.ends[0][0].min(self.ends[1][0])
    }
}

impl WallRun {
    /// Returns true if a value of joint 2 is in the run by more than rounding errors.
    fn contains(&self, q2: f64) -> bool {
        let hair = WALL_END_MARGIN * (self.ends[1] - self.ends[0]);
        self.ends[0] + hair < q2 && q2 < self.ends[1] - hair
    }
}

/// Collects the runs of walls of constant joint 1, and the other walls that end within each run.
fn runs(copies: &[WallCopy], walls: &[ClosedSegment]) -> BTreeMap<Line, Vec<WallRun>> {
    let mut runs: BTreeMap<Line, Vec<WallRun>> = BTreeMap::new();
    let lines = |copy: &WallCopy| walls[copy.wall].ends.map(|end| (end[0].to_bits(), copy.turns[0]));
    for copy in copies {
        let [line, other] = lines(copy);
        if line == other {
            let [a, b] = copy.ends.map(|end| end[1]);
            let run = WallRun { ends: [a.min(b), a.max(b)], walls: vec![copy.wall], beside: [vec![], vec![]] };
            runs.entry(line).or_default().push(run);
        }
    }
    for list in runs.values_mut() {
        list.sort_by(|a, b| a.ends[0].total_cmp(&b.ends[0]));
        let mut merged: Vec<WallRun> = Vec::new();
        for run in list.drain(..) {
            match merged.last_mut() {
                Some(last) if run.ends[0] < last.ends[1] - WALL_END_MARGIN * (last.ends[1] - last.ends[0]) => {
                    last.ends[1] = last.ends[1].max(run.ends[1]);
                    last.walls.extend(run.walls);
                }
                _ => merged.push(run),
            }
        }
        *list = merged;
    }
    for copy in copies {
        let lines = lines(copy);
        if lines[0] == lines[1] {
            continue;
        }
        for (line, [at, other]) in lines.into_iter().zip([copy.ends, [copy.ends[1], copy.ends[0]]]) {
            let list = runs.get_mut(&line);
            if let Some(run) = list.and_then(|list| list.iter_mut().find(|run| run.contains(at[1]))) {
                run.beside[usize::from(at[0] < other[0])].push((at[1], copy.wall));
            }
        }
    }
    runs
}

/// Returns true if a leg crosses the interior of a wall by more than rounding errors.
fn crosses([a, b]: &[Configuration; 2], from: Configuration, to: Configuration) -> bool {
    let apart = |k: usize| from[k].max(to[k]) < a[k].min(b[k]) || a[k].max(b[k]) < from[k].min(to[k]);
    if apart(0) || apart(1) {
        return false;
    }
    let cross = |u: Configuration, v: Configuration| u[0] * v[1] - u[1] * v[0];
    let (wall, leg) = (b - a, to - from);
    let whole = cross(wall, leg);
    let (along_wall, along_leg) = (cross(from - a, leg) / whole, cross(from - a, wall) / whole);
    [along_wall, along_leg].iter().all(|share| (WALL_END_MARGIN..=1.0 - WALL_END_MARGIN).contains(share))
}
