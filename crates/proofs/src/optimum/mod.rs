//! How short a motion may be at best: a proven lower bound.

mod closed;
mod evident;
mod portals;
mod jumps;
mod refine;
mod search;
mod sleeve;
mod strips;

use crate::evidence::BoundEvidence;
use closed::MOST_PAIRS;
use cplan_core::check::{CertifiedPath, Rejection, Vicinity};
use cplan_core::model::{Pair, Scene};
use cplan_core::space::{Configuration, GoalSet, Measure, Metric, Path, Segment, Topology, funnel_path};
use cplan_geometry::{Ordered, Point};
use refine::{Allowed, Fine, passed};
use search::{Search, Way};
use std::f64::consts::TAU;
use strips::Strips;

/// What rounding and the tie-break of travel times may add to a shortest length, as a share of it.
const ROUNDING: f64 = 1e-9;

/// What rounding makes of the ends of a way, as a share of their coordinates: far from zero doubles lie far apart, and a short
/// way there is known to fewer digits.
const COORDINATES: f64 = 1024.0 * f64::EPSILON;

/// Times that strips are halved at most.
const ROUNDS: usize = 64;

/// The first ways are searched for: among wide strips they often lead where there is none.
const SEARCHED: usize = 2;

/// Ways at most, searched for or pulled taut: most of them answer a certificate that was refused.
const TRIES: usize = 128;

/// Pairs times searches at most, a second's worth or some.
const MOST_TRIED: usize = 80_000;

/// A way is looked at by the certificate once it has grown by no more than this share of its length.
const SETTLED: f64 = 1e-6;

/// Pairs times certificates that were refused, at most: seconds' worth.
const MOST_REFUSED: usize = 500_000;

/// So many pairs are looked at about a place where one was met that was not.
const NEAREST: usize = 256;

/// Rounds in a row that hardly make the bound better, after which it is as good as it gets.
const MOST_IDLE_ROUNDS: usize = 3;

/// Share of what a way is to keep beyond the clearance by which strips may let it fall short of that. What is left is enough for a
/// certificate, and a greater share takes fewer slices ...
const DEEPEST: f64 = 0.9;

/// ... but among more pairs than this a way leads past many small things, where certificates need more room: ...
const FEW_PAIRS: usize = 1000;

/// ... this share.
const DEEPEST_AMONG_MANY: f64 = 0.5;

/// Share of the gap asked for that a single strip may leave open without being halved.
const WORTH: f64 = 1e-3;

/// Share of the limit below which ways are looked for at first, at least.
const LEAST_SHARE: f64 = 1.0 / 64.0;

/// The motions that are asked for, and how their lengths are measured.
#[derive(Debug, Clone, Copy)]
pub struct Motions<'a> {
    /// Arm and obstacles.
    pub scene: &'a Scene,
    /// Where they begin.
    pub start: Configuration,
    /// Where they may end, on whichever turns.
    pub goals: &'a GoalSet,
    /// What they keep from every obstacle, metres: more than zero, and at least this.
    pub clearance: f64,
    /// What makes one short.
    pub metric: Metric,
}

/// A lower bound on the length of every one of the `motions`; at most `limit`, finite, which some motion's length should be. It
/// is made better until it is within the share `gap` of the limit, or cannot be.
///
/// Joint 1's domain is cut into strips by *slices*, at which contact angles say exactly which values of joint 2 are closed:
/// *walls*. Where a pair makes walls at both slices of a strip, a straight *barrier* between them is proven to be closed all
/// along. What is free lies beyond neither, so no motion is shorter than the shortest way around walls and barriers. Ways
/// may bulge into what is closed between two slices, by an amount of second order in the strip's width as far as the boundary
/// bends. Strips are cut where the way does, so it costs some dozens of slices, most of them where the way touches. Those at
/// the values `slices` of joint 1 are there from the beginning.
///
/// The search for the way is complete up to the rounding of coordinates, for which a share of 1e-9 is taken off: every
/// passage is some nanometres wider than it is in truth, because walls are made of shapes eroded by that. Two shapes
/// without area make no walls, which makes the bound lower.
#[must_use]
pub fn least_length(motions: &Motions, limit: f64, gap: f64, slices: &[f64]) -> f64 {
    bounded(&Motions { scene: &motions.scene.inner(), ..*motions }, limit, gap, slices).0
}

/// Returns what closes the ways that are shorter than [`least_length`] without further slices: evidence for a checker.
#[must_use]
pub fn bound_evidence(motions: &Motions, limit: f64, gap: f64) -> BoundEvidence {
    let scene = &*motions.scene.inner();
    let (_, ways) = bounded(&Motions { scene, ..*motions }, limit, gap, &[]);
    BoundEvidence { slices: ways.strips.evident(scene) }
}

fn bounded<'a>(motions: &Motions<'a>, limit: f64, gap: f64, slices: &[f64]) -> (f64, Ways<'a>) {
    let mut ways = Ways::new(*motions, limit, slices);
    let enough = limit / (1.0 + gap);
    let (mut best, mut idle) = (0.0, 0);
    for _ in 0..ROUNDS {
        let (length, corners) = ways.shortest();
        idle = if length - best > gap / 8.0 * limit { 0 } else { idle + 1 };
        best = f64::max(best, length);
        if best >= enough || idle >= MOST_IDLE_ROUNDS || !ways.refine(&corners, Allowed::Detour(gap * limit * WORTH)) {
            break;
        }
    }
    (ways.rounded(best.min(limit)), ways)
}

/// About the shortest of the `motions`, shorter than `limit`, certified by `judge`, which gets a [`Proposed`] path, and may certify
/// one that is made of it. It keeps more than the clearance, by `kept` metres less what strips leave open, most of that; and is
/// longer than the shortest by what that costs.
///
/// It is the shortest way of [`least_length`] among obstacles that are grown by `kept`: strips are cut where it leads deeper
/// into these than by most of that, and where the judge says so. Among finer strips the way is pulled taut through the portals
/// that it passes, which takes a small part of the time of a search; where the judge takes such a way for too long, or refuses the same one
/// twice, all later ones are searched for. None if that does not get there, as where a passage is narrower than `kept` leaves it.
#[must_use]
pub fn short_motion(
    motions: &Motions,
    kept: f64,
    limit: f64,
    mut judge: impl FnMut(Proposed) -> Result<CertifiedPath, Refused>,
) -> Option<ShortMotion> {
    let Motions { scene, start, clearance, .. } = *motions;
    let mut ways = Ways::new(Motions { clearance: clearance + kept, ..*motions }, limit, &[]);
    let (mut before, mut refused, mut last, mut is_pulled) = (0.0, 0, Vec::new(), true);
    let deepest = if scene.pairs().len() <= FEW_PAIRS { DEEPEST } else { DEEPEST_AMONG_MANY };
    let allowed = Allowed::Depth(deepest * kept);
    let (most, mut searched) = (MOST_TRIED / ways.strips.pairs().len().max(1), 0);
    for _ in 0..TRIES {
        let taut = (is_pulled && searched >= SEARCHED).then(|| ways.taut(&last)).flatten();
        let is_shortest = taut.is_none();
        if is_shortest && searched == most {
            return None;
        }
        searched += usize::from(is_shortest);
        let (length, corners) = taut.unwrap_or_else(|| ways.shortest());
        if corners.is_empty() {
            return None;
        }
        // Where thousands of pieces lie side by side there is always one more to go round, and nothing is gained by it.
        let is_settled = length - before <= SETTLED * length;
        before = length;
        if !is_settled && ways.refine(&corners, allowed) {
            last = corners;
            continue;
        }
        let proposed = Proposed { path: ways.path(start, &corners), slices: ways.strips.slices(), is_shortest };
        let nearest = match judge(proposed) {
            Ok(path) => return Some(ShortMotion { path, free: ways.passed(start, &corners) }),
            Err(Refused::TooLong) => {
                (before, is_pulled) = (0.0, false);
                continue;
            }
            Err(Refused::By(Rejection::TooClose(nearest) | Rejection::Undecided(nearest))) => nearest.at,
            Err(Refused::By(Rejection::OutOfLimits { .. })) => return None,
        };
        refused += 1;
        let is_finer =
            ways.look_about(nearest) || is_settled && ways.refine(&corners, allowed) || ways.halve_at(nearest[0]);
        if !is_finer || refused * scene.pairs().len() > MOST_REFUSED {
            return None;
        }
        // Finer strips do not show it what is in its way: the next one is searched for.
        is_pulled &= corners != last;
        last = corners;
    }
    None
}

/// A path that a certificate is asked for.
#[derive(Debug, Clone)]
pub struct Proposed {
    /// The path itself.
    pub path: Path,
    /// The values of joint 1 at all slices, near each other where the path leads past something.
    pub slices: Vec<f64>,
    /// Whether no other one among these slices is shorter; if not, none that passes the same portals is.
    pub is_shortest: bool,
}

/// Why a proposed path is not taken.
#[derive(Debug, Clone)]
pub enum Refused {
    /// It has no certificate.
    By(Rejection),
    /// There may be a shorter one; not of a path that is the shortest.
    TooLong,
}

/// A motion that is about the shortest.
#[derive(Debug, Clone)]
pub struct ShortMotion {
    /// The path of the motion, certified.
    pub path: CertifiedPath,
    /// The free stretch of each slice that it passes, in order: at the least and at the greatest value of joint 2.
    pub free: Vec<[Configuration; 2]>,
}

/// The search for the shortest way past what is closed, finer and finer.
struct Ways<'a> {
    motions: Motions<'a>,
    vicinity: Vicinity<'a>,
    strips: Strips<'a>,
    measure: Measure,
    start: Point,
    /// Copies of the goals.
    goals: Vec<Segment>,
    limit: f64,
    /// Goals and portals on far turns cost time, so ways are looked for nearby first: below this length.
    near: f64,
    /// Greatest coordinate of start and goals.
    largest: f64,
    /// One and the same is allowed whenever strips are refined.
    fine: Fine,
}

impl<'a> Ways<'a> {
    fn new(motions: Motions<'a>, limit: f64, slices: &[f64]) -> Self {
        let Motions { scene, start, goals, clearance, metric } = motions;
        let mut strips = Strips::new(scene, clearance, slices);
        // Nearest to zero doubles are densest, and all turns are alike.
        let start = Point::from(strips.topology().wrap(start));
        let goals: Vec<Segment> = goals.wrapped(strips.topology()).collect();
        let largest = goals.iter().flat_map(Segment::ends).map(|q| q.amax()).fold(start.coords.amax(), f64::max);
        let measure = Measure::from(metric);
        let goals: Vec<Segment> = goals.iter().flat_map(|piece| strips.open_goals(piece)).collect();
        let mut goals = copies(strips.topology(), metric, start, &goals, limit);
        let straight = |goals: &Segment| goals.distance(measure, start.coords);
        goals.retain(|copy| straight(copy) < limit);
        let nearest = goals.iter().map(straight).fold(limit, f64::min);
        // Who knows where slices are needed knows about how long the shortest is.
        let near = if slices.is_empty() { f64::max(1.5 * nearest, limit * LEAST_SHARE).min(limit) } else { limit };
        let vicinity = Vicinity::of(scene, strips.pairs().into());
        Self { motions, vicinity, strips, measure, start, goals, limit, near, largest, fine: Fine::default() }
    }

    /// The length of the shortest way past what is known to be closed, and its corners; without corners if none is as short as
    /// the limit.
    fn shortest(&mut self) -> (f64, Vec<Point>) {
        let straight = |goals: &Segment| goals.distance(self.measure, self.start.coords);
        if self.strips.count() == 0 {
            // Joint 1 cannot move: what closes the way of joint 2 is not looked at.
            return (self.goals.iter().map(straight).fold(self.limit, f64::min), Vec::new());
        }
        loop {
            let near: Vec<Segment> = self.goals.iter().copied().filter(|goal| straight(goal) < self.near).collect();
            match Search::new(&mut self.strips, self.measure, &near, self.near).run(self.start) {
                Way::Shortest(length, corners) => return (length, corners),
                Way::NoneBelow(length) if length < self.near || self.near >= self.limit => return (length, Vec::new()),
                Way::NoneBelow(_) => self.near = (2.0 * self.near).min(self.limit),
            }
        }
    }

    /// The shortest way through the portals that another one passes, and its length; none if it is as long as the limit, or not known.
    fn taut(&mut self, corners: &[Point]) -> Option<(f64, Vec<Point>)> {
        let (&start, &goal) = (corners.first()?, corners.last()?);
        // Of other goals the nearest may be another one.
        let sleeve = self.goals.iter().all(Segment::is_point).then(|| self.strips.sleeve(corners)).flatten()?;
        let corners = funnel_path(start, goal, &sleeve);
        let length = corners.windows(2).map(|ends| self.measure.norm(ends[1] - ends[0])).sum();
        (length < self.limit).then_some((length, corners))
    }

    /// Halves strips in which a way passes what is closed by more than allowed; whether there were any that can be.
    fn refine(&mut self, corners: &[Point], allowed: Allowed) -> bool {
        if self.strips.count() == 0 || self.strips.are_too_many() {
            return false;
        }
        let passed = passed(&self.motions, &self.vicinity, &mut self.strips, corners, allowed, &mut self.fine);
        !passed.is_empty() && self.strips.cut(&passed)
    }

    /// Where not all pairs are looked at: looks at those that are near at a configuration, too. Whether there are any more.
    fn look_about(&mut self, q: Configuration) -> bool {
        let scene = self.motions.scene;
        if scene.pairs().len() <= MOST_PAIRS {
            return false;
        }
        let mut near: Vec<(Ordered, Pair)> = scene
            .separations(q)
            .filter(|contact| contact.pair.link > 0)
            .map(|contact| (Ordered(contact.separation.distance), contact.pair))
            .collect();
        near.sort_unstable();
        let is_new = self.strips.add(near.into_iter().take(NEAREST).map(|(_, pair)| pair).collect());
        if is_new {
            self.vicinity = Vicinity::of(scene, self.strips.pairs().into());
            self.fine.clear();
        }
        is_new
    }

    /// Halves the strips that hold a value of joint 1.
    fn halve_at(&mut self, q1: f64) -> bool {
        let value = self.strips.topology().ranges[0].wrap(q1);
        let mut which: Vec<usize> =
            self.strips.around(value).into_iter().map(|strip| self.strips.index(strip)).collect();
        which.sort_unstable();
        which.dedup();
        !self.strips.are_too_many() && self.strips.halve(&which)
    }

    /// A length, less what rounding may have added.
    fn rounded(&self, length: f64) -> f64 {
        (length - f64::max(length * ROUNDING, self.largest * COORDINATES)).max(0.0)
    }

    /// The way with these corners, on the start's own turns.
    fn path(&self, start: Configuration, corners: &[Point]) -> Path {
        let lift = start - self.start.coords;
        Path::new(std::iter::once(start).chain(corners[1..].iter().map(|corner| corner.coords + lift)).collect())
    }

    /// The portals through which a way passes, on the start's own turns.
    fn passed(&mut self, start: Configuration, corners: &[Point]) -> Vec<[Configuration; 2]> {
        let lift = start - self.start.coords;
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
                    self.strips.free_about(slice, q2).map(|free| free.map(|q2| Configuration::new(q1, q2) + lift)),
                );
            }
        }
        passed
    }
}

/// All copies of the goals that may be nearer than the limit.
fn copies(topology: &Topology, metric: Metric, start: Point, goals: &[Segment], limit: f64) -> Vec<Segment> {
    let turns = |k: usize, goals: &Segment| {
        let mut unit = Configuration::zeros();
        unit[k] = 1.0;
        let far = limit / metric.norm(unit);
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
