//! A proven lower bound on the length of motions.

mod closed;
mod slice_evidence;
mod portals;
mod jumps;
mod refine;
mod search;
mod sleeve;
mod strips;

use crate::evidence::BoundEvidence;
use closed::MAX_PAIRS;
use cplan_geometry::{OrderedF64, Point};
use cplan_judge::{CertifiedPath, Rejection, Vicinity};
use cplan_model::space::{Configuration, GoalSet, Measure, Metric, Path, Segment, Topology, funnel_path};
use cplan_model::{Pair, Scene};
use refine::{PathTolerance, RefinedPieces, crossed_strips};
use search::{Search, SearchResult};
use std::f64::consts::TAU;
use strips::Strips;

/// Margin for rounding, and for the tie-break between equal travel times, as a share of a shortest length.
const ROUNDING: f64 = 1e-9;

/// Rounding error of the ends of a path, as a share of their coordinates. Far from zero, doubles are sparse, so a short path has
/// fewer correct digits.
const COORDINATE_ROUNDING: f64 = 1024.0 * f64::EPSILON;

/// Maximum number of refinements of the strips.
const MAX_REFINEMENTS: usize = 64;

/// From this number of searches on, a path may be found by pulling the previous one taut. As long as strips are wide, paths often
/// lead through passages that do not exist.
const MIN_SEARCHED_PATHS: usize = 2;

/// Largest number of paths, from searches or pulled taut. Most of them follow a refused certificate.
const MAX_PATHS: usize = 128;

/// Largest product of the numbers of searches and pairs. It corresponds to about a second.
const MAX_SEARCH_WORK: usize = 80_000;

/// The path is certified once its length grows from one round to the next by less than this share.
const SETTLED_GROWTH: f64 = 1e-6;

/// Largest product of the numbers of refused certificates and pairs. It corresponds to some seconds.
const MAX_REFUSAL_WORK: usize = 500_000;

/// Number of pairs that are added where a path collides with a pair not in use.
const PAIRS_PER_COLLISION: usize = 256;

/// The search ends after this number of consecutive rounds with hardly any improvement.
const MAX_IDLE_ROUNDS: usize = 3;

/// Fraction of the extra clearance `kept` by which paths may enter grown obstacles within strips. The rest suffices for a
/// certificate. The greater the fraction, the fewer slices are needed.
const STRIP_CLEARANCE_SHARE: f64 = 0.9;

/// Largest number of pairs for which [`STRIP_CLEARANCE_SHARE`] applies. Among more pairs, a path passes many small pieces, and
/// certificates need more space.
const FEW_PAIRS: usize = 1000;

/// Replaces [`STRIP_CLEARANCE_SHARE`] among more than [`FEW_PAIRS`] pairs.
const STRIP_CLEARANCE_SHARE_OF_MANY: f64 = 0.5;

/// Strips that contribute less than this share of the requested gap are not halved.
const MAX_STRIP_GAP_SHARE: f64 = 1e-3;

/// Least initial limit on the lengths of paths in a search, as a share of the final limit.
const MIN_LIMIT_SHARE: f64 = 1.0 / 64.0;

/// The requested motions, and the metric of their lengths.
#[derive(Debug, Clone, Copy)]
pub struct MotionQuery<'a> {
    /// The arm and the obstacles.
    pub scene: &'a Scene,
    /// Start configuration.
    pub start: Configuration,
    /// Goals, with any number of whole turns.
    pub goals: &'a GoalSet,
    /// Required distance from every obstacle, metres. If 0, the distance must still be positive.
    pub clearance: f64,
    /// Metric in which lengths of motions are measured.
    pub metric: Metric,
}

/// Returns a lower bound on the length of all `motions`. It is at most `limit`, which must be finite and should be the length of
/// some motion. The bound is improved until it is within the share `gap` of the limit, or until it cannot be improved.
///
/// *Slices* cut joint 1's domain into strips. On a slice, contact angles give exactly the values of joint 2 that are closed:
/// *walls*. Between walls of one pair on both sides of a strip, a straight *barrier* may be proven to be closed along its whole
/// length. No motion crosses walls or barriers, so no motion is shorter than the shortest path around them.
///
/// Between two slices, this path may enter closed regions. For a smooth boundary, the error is of second order in the strip's
/// width. Strips are cut only there, so some dozens of slices suffice, most of them where the path touches obstacles. `slices`
/// are the initial slices.
///
/// The search for the path is complete up to the rounding of coordinates, for which a share of 1e-9 is subtracted. Walls are made
/// of slightly eroded shapes, so every passage is some nanometres wider than in reality. Pairs of two shapes without area make no
/// walls, which lowers the bound.
pub fn least_length(motions: &MotionQuery, limit: f64, gap: f64, slices: &[f64]) -> f64 {
    bounded(&MotionQuery { scene: &motions.scene.inner(), ..*motions }, limit, gap, slices, &mut |_| ()).0
}

/// Returns evidence for a checker: walls and barriers that close all paths shorter than the bound that [`least_length`] finds
/// without initial slices.
pub fn bound_evidence(motions: &MotionQuery, limit: f64, gap: f64) -> BoundEvidence {
    let scene = &*motions.scene.inner();
    let (_, search) = bounded(&MotionQuery { scene, ..*motions }, limit, gap, &[], &mut |_| ());
    BoundEvidence { slices: search.strips.evidence(scene) }
}

/// A round of the search for a lower bound.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundRound {
    /// The bound after the round.
    pub lower: f64,
    /// The shortest path around all that is known to be closed so far. It may still cross closed regions. Empty if all paths are
    /// longer than the limit.
    pub path: Vec<Configuration>,
    /// Values of joint 1 at the slices, ascending.
    pub slices: Vec<f64>,
}

/// Returns the rounds in which [`least_length`], without initial slices, improves the bound. The bounds never fall. The first
/// round knows no walls.
pub fn bound_rounds(motions: &MotionQuery, limit: f64, gap: f64) -> Vec<BoundRound> {
    let mut rounds = Vec::new();
    bounded(&MotionQuery { scene: &motions.scene.inner(), ..*motions }, limit, gap, &[], &mut |round| {
        rounds.push(round)
    });
    rounds
}

fn bounded<'a>(
    motions: &MotionQuery<'a>,
    limit: f64,
    gap: f64,
    slices: &[f64],
    watch: &mut dyn FnMut(BoundRound),
) -> (f64, ShortestPathSearch<'a>) {
    let mut search = ShortestPathSearch::new(*motions, limit, slices);
    watch(search.straight_round());
    let enough = limit / (1.0 + gap);
    let (mut best, mut idle) = (0.0, 0);
    for _ in 0..MAX_REFINEMENTS {
        let (length, corners) = search.shortest();
        idle = if length - best > gap / 8.0 * limit { 0 } else { idle + 1 };
        best = f64::max(best, length);
        watch(BoundRound {
            lower: search.rounded(best.min(limit)),
            path: if corners.is_empty() {
                Vec::new()
            } else {
                search.path(motions.start, &corners).waypoints().to_vec()
            },
            slices: search.strips.slices(),
        });
        if best >= enough
            || idle >= MAX_IDLE_ROUNDS
            || !search.refine(&corners, PathTolerance::Detour(gap * limit * MAX_STRIP_GAP_SHARE))
        {
            break;
        }
    }
    (search.rounded(best.min(limit)), search)
}

/// Finds a certified motion that is about the shortest of `motions`, and shorter than `limit`. Returns `None` if it finds none,
/// for example if a passage is too narrow for `kept`.
///
/// `judge` receives a [`ProposedPath`], and certifies it or a path derived from it. The proposed path keeps the clearance and a
/// part of the extra clearance `kept`, metres, so it is slightly longer than the shortest motion.
///
/// The proposed path is the shortest path of [`least_length`] among obstacles grown by `kept`. Strips are cut where the path
/// enters the grown obstacles by more than a share of `kept` (0.9, or 0.5 among many pairs), and where the judge refuses it.
/// Among the finer strips, the path is pulled taut through its portals, which is much faster than a search. If the judge finds
/// such a path too long, or refuses the same path twice, all later paths come from searches.
pub fn short_motion(
    motions: &MotionQuery,
    kept: f64,
    limit: f64,
    mut judge: impl FnMut(ProposedPath) -> Result<CertifiedPath, RefusalReason>,
) -> Option<NearShortestMotion> {
    let MotionQuery { scene, start, clearance, .. } = *motions;
    let mut search = ShortestPathSearch::new(MotionQuery { clearance: clearance + kept, ..*motions }, limit, &[]);
    let (mut before, mut refused, mut last, mut is_pulled) = (0.0, 0, Vec::new(), true);
    let deepest = if scene.pairs().len() <= FEW_PAIRS { STRIP_CLEARANCE_SHARE } else { STRIP_CLEARANCE_SHARE_OF_MANY };
    let allowed = PathTolerance::Depth(deepest * kept);
    let (most, mut searched) = (MAX_SEARCH_WORK / search.strips.pairs().len().max(1), 0);
    for _ in 0..MAX_PATHS {
        let taut = (is_pulled && searched >= MIN_SEARCHED_PATHS).then(|| search.taut(&last)).flatten();
        let is_shortest = taut.is_none();
        if is_shortest && searched == most {
            return None;
        }
        searched += usize::from(is_shortest);
        let (length, corners) = taut.unwrap_or_else(|| search.shortest());
        if corners.is_empty() {
            return None;
        }
        // Among thousands of adjacent pieces, each path meets another piece, although its length hardly changes.
        let is_settled = length - before <= SETTLED_GROWTH * length;
        before = length;
        if !is_settled && search.refine(&corners, allowed) {
            last = corners;
            continue;
        }
        let proposed = ProposedPath { path: search.path(start, &corners), slices: search.strips.slices(), is_shortest };
        let nearest = match judge(proposed) {
            Ok(path) => return Some(NearShortestMotion { path, free: search.portals_on_path(start, &corners) }),
            Err(RefusalReason::TooLong) => {
                (before, is_pulled) = (0.0, false);
                continue;
            }
            Err(RefusalReason::By(Rejection::TooClose(nearest) | Rejection::Undecided(nearest))) => nearest.at,
            Err(RefusalReason::By(Rejection::OutOfLimits { .. })) => return None,
        };
        refused += 1;
        let is_finer = search.add_nearby_pairs(nearest)
            || is_settled && search.refine(&corners, allowed)
            || search.halve_at(nearest[0]);
        if !is_finer || refused * scene.pairs().len() > MAX_REFUSAL_WORK {
            return None;
        }
        // Finer strips did not reveal the obstacle on the path, so the next path comes from a search.
        is_pulled &= corners != last;
        last = corners;
    }
    None
}

/// A path proposed for certification.
#[derive(Debug, Clone)]
pub struct ProposedPath {
    /// The path.
    pub path: Path,
    /// Values of joint 1 at all slices. They are dense where the path touches obstacles.
    pub slices: Vec<f64>,
    /// True if this is the shortest path among these slices. If false, it is only the shortest path through its own
    /// portals.
    pub is_shortest: bool,
}

/// The reason why a proposed path is refused.
#[derive(Debug, Clone)]
pub enum RefusalReason {
    /// The path cannot be certified.
    By(Rejection),
    /// There may be a shorter path. Not allowed if [`ProposedPath::is_shortest`] is true.
    TooLong,
}

/// A motion that is about the shortest.
#[derive(Debug, Clone)]
pub struct NearShortestMotion {
    /// The certified path of the motion.
    pub path: CertifiedPath,
    /// Free stretches of slices that the path crosses, in order. Each is given by the configurations with the least and the
    /// greatest value of joint 2.
    pub free: Vec<[Configuration; 2]>,
}

/// The search for the shortest path around walls and barriers, among ever finer strips.
struct ShortestPathSearch<'a> {
    motions: MotionQuery<'a>,
    vicinity: Vicinity<'a>,
    strips: Strips<'a>,
    measure: Measure,
    start: Point,
    /// Copies of the goals on all turns.
    goals: Vec<Segment>,
    limit: f64,
    /// Paths shorter than this are searched first. Longer paths could reach goals and portals with more whole turns, which costs
    /// time.
    near: f64,
    /// Greatest absolute coordinate of start and goals.
    largest: f64,
    /// Pieces of paths that need no refinement. All refinements must use the same [`PathTolerance`].
    fine: RefinedPieces,
}

impl<'a> ShortestPathSearch<'a> {
    fn new(motions: MotionQuery<'a>, limit: f64, slices: &[f64]) -> Self {
        let MotionQuery { scene, start, goals, clearance, metric } = motions;
        let mut strips = Strips::new(scene, clearance, slices);
        // The start is wrapped, because doubles are densest near zero, and turns are equivalent.
        let start = strips.topology().wrap(start);
        let goals: Vec<Segment> = goals.wrapped(strips.topology()).collect();
        let largest = goals.iter().flat_map(Segment::ends).map(|q| q.amax()).fold(start.amax(), f64::max);
        let measure = Measure::from(metric);
        let goals: Vec<Segment> = goals.iter().flat_map(|piece| strips.open_goals(piece)).collect();
        let mut goals = copies(strips.topology(), metric, start, &goals, limit);
        let straight = |goals: &Segment| goals.distance(measure, start);
        goals.retain(|copy| straight(copy) < limit);
        let nearest = goals.iter().map(straight).fold(limit, f64::min);
        // A caller that knows slices also knows about the shortest length.
        let near = if slices.is_empty() { f64::max(1.5 * nearest, limit * MIN_LIMIT_SHARE).min(limit) } else { limit };
        let vicinity = Vicinity::of(scene, strips.pairs().into());
        Self { motions, vicinity, strips, measure, start, goals, limit, near, largest, fine: RefinedPieces::default() }
    }

    /// Returns the round before any slice: no motion is shorter than the straight line to the nearest goal.
    fn straight_round(&self) -> BoundRound {
        let distance = |goals: &&Segment| OrderedF64(goals.distance(self.measure, self.start));
        let nearest = self.goals.iter().min_by_key(distance).map(|goals| goals.nearest(self.measure, self.start));
        let lower = nearest.map_or(self.limit, |goal| self.measure.norm(goal - self.start));
        let path =
            nearest.map_or_else(Vec::new, |goal| vec![self.motions.start, goal + self.motions.start - self.start]);
        BoundRound { lower: self.rounded(lower.min(self.limit)), path, slices: Vec::new() }
    }

    /// Returns length and corners of the shortest path around all known walls and barriers. No corners if all paths are longer
    /// than the limit.
    fn shortest(&mut self) -> (f64, Vec<Point>) {
        let straight = |goals: &Segment| goals.distance(self.measure, self.start);
        if self.strips.count() == 0 {
            // Joint 1 cannot move, and walls on the path of joint 2 are not examined.
            return (self.goals.iter().map(straight).fold(self.limit, f64::min), Vec::new());
        }
        loop {
            let near: Vec<Segment> = self.goals.iter().copied().filter(|goal| straight(goal) < self.near).collect();
            match Search::new(&mut self.strips, self.measure, &near, self.near).run(self.start) {
                SearchResult::Shortest(length, corners) => return (length, corners),
                SearchResult::NoneBelow(length) if length < self.near || self.near >= self.limit => {
                    return (length, Vec::new());
                }
                SearchResult::NoneBelow(_) => self.near = (2.0 * self.near).min(self.limit),
            }
        }
    }

    /// Returns length and corners of the shortest path through the portals of another path. `None` if it is not shorter than the
    /// limit, or if the portals are not known.
    fn taut(&mut self, corners: &[Point]) -> Option<(f64, Vec<Point>)> {
        let (&start, &goal) = (corners.first()?, corners.last()?);
        // If a goal is a segment, another point of it may be nearest.
        let sleeve = self.goals.iter().all(Segment::is_point).then(|| self.strips.sleeve(corners)).flatten()?;
        let corners = funnel_path(start, goal, &sleeve);
        let length = corners.windows(2).map(|ends| self.measure.norm(ends[1] - ends[0])).sum();
        (length < self.limit).then_some((length, corners))
    }

    /// Cuts the strips in which a path enters closed regions by more than the tolerance. Returns true if any strip was
    /// cut.
    fn refine(&mut self, corners: &[Point], allowed: PathTolerance) -> bool {
        if self.strips.count() == 0 || self.strips.are_too_many() {
            return false;
        }
        let passed = crossed_strips(&self.motions, &self.vicinity, &mut self.strips, corners, allowed, &mut self.fine);
        !passed.is_empty() && self.strips.cut(&passed)
    }

    /// Adds pairs that are near in a configuration, if not all are in use. Returns true if it added any.
    fn add_nearby_pairs(&mut self, q: Configuration) -> bool {
        let scene = self.motions.scene;
        if scene.pairs().len() <= MAX_PAIRS {
            return false;
        }
        let mut near: Vec<(OrderedF64, Pair)> = scene
            .separations(q)
            .filter(|contact| contact.pair.link > 0)
            .map(|contact| (OrderedF64(contact.separation.distance), contact.pair))
            .collect();
        near.sort_unstable();
        let is_new = self.strips.add(near.into_iter().take(PAIRS_PER_COLLISION).map(|(_, pair)| pair).collect());
        if is_new {
            self.vicinity = Vicinity::of(scene, self.strips.pairs().into());
            self.fine.clear();
        }
        is_new
    }

    /// Halves the strips that contain a value of joint 1. Returns true if any strip was halved.
    fn halve_at(&mut self, q1: f64) -> bool {
        let value = self.strips.topology().ranges[0].wrap(q1);
        let mut which: Vec<usize> =
            self.strips.strips_at(value).into_iter().map(|strip| self.strips.index(strip)).collect();
        which.sort_unstable();
        which.dedup();
        !self.strips.are_too_many() && self.strips.halve(&which)
    }

    /// Subtracts the rounding error from a length.
    fn rounded(&self, length: f64) -> f64 {
        (length - f64::max(length * ROUNDING, self.largest * COORDINATE_ROUNDING)).max(0.0)
    }

    /// Returns the path with these corners, shifted by the whole turns between the wrapped start and `start`.
    fn path(&self, start: Configuration, corners: &[Point]) -> Path {
        let lift = start - self.start;
        Path::new(std::iter::once(start).chain(corners[1..].iter().map(|corner| corner + lift)).collect())
    }

    /// Returns the portals that a path passes, shifted by the whole turns between the wrapped start and `start`.
    fn portals_on_path(&mut self, start: Configuration, corners: &[Point]) -> Vec<[Configuration; 2]> {
        let lift = start - self.start;
        let mut passed = Vec::new();
        for ends in corners.windows(2) {
            let (from, to) = (ends[0], ends[1]);
            let (first, last) = (self.strips.locate(from.x.min(to.x)), self.strips.locate(from.x.max(to.x)));
            let slices: Vec<i64> = (first + 1..=last).collect();
            let slices: Vec<i64> = if from.x <= to.x { slices } else { slices.into_iter().rev().collect() };
            for slice in slices {
                let q1 = self.strips.q1(slice);
                let q2 = from.y + (to.y - from.y) * ((q1 - from.x) / (to.x - from.x));
                passed.extend(
                    self.strips.free_around(slice, q2).map(|free| free.map(|q2| Configuration::new(q1, q2) + lift)),
                );
            }
        }
        passed
    }
}

/// Returns all copies of the goals, shifted by whole turns, that may be nearer than the limit.
fn copies(topology: &Topology, metric: Metric, start: Point, goals: &[Segment], limit: f64) -> Vec<Segment> {
    let turns = |k: usize, goals: &Segment| {
        let far = limit / metric.least(k);
        let [from, to] = goals.ends().map(|goal| goal[k]);
        let (least, greatest) = (from.min(to), from.max(to));
        let window = (start[k] - far - (greatest - least), start[k] + far);
        let copies = topology.ranges[k].copies_within(least, window);
        copies.map(|copy| ((copy - least) / TAU).round()).collect::<Vec<_>>()
    };
    let mut copies = Vec::new();
    for goals in goals {
        let (first, second) = (turns(0, goals), turns(1, goals));
        copies.extend(first.iter().flat_map(|&first| second.iter().map(move |&second| goals.turned([first, second]))));
    }
    copies
}
