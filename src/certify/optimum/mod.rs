//! How short a motion may be at best: a proven lower bound.

mod closed;
mod refine;
mod search;
mod strips;

use crate::certify::vicinity::Vicinity;
use crate::geometry::Point;
use crate::model::Scene;
use crate::space::{Configuration, GoalSet, Measure, Metric, Segment, Topology};
use refine::passed;
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

/// Rounds in a row that hardly make the bound better, after which it is as good as it gets.
const PATIENCE: usize = 3;

/// Share of the gap asked for that a single strip may leave open without being halved.
const WORTH: f64 = 1e-3;

/// Share of the limit below which ways are looked for at first, at least.
const LEAST_SHARE: f64 = 1.0 / 64.0;

/// A lower bound on the length of every motion from `start` to one of the `goals`, on whichever turns, that keeps more
/// than zero and at least `clearance` from every obstacle; at most `limit`, finite, which some motion's length should be. It is
/// made better until it is within the share `gap` of the limit, or cannot be.
///
/// Joint 1's domain is cut into strips by *rows*, at which contact angles say exactly which values of joint 2 are closed:
/// *walls*. Where a pair makes walls at both rows of a strip, a straight *barrier* between them is proven to be closed all
/// along. What is free lies beyond neither, so no motion is shorter than the shortest way around walls and barriers. Ways
/// may bulge into what is closed between two rows, by an amount of second order in the strip's width as far as the boundary
/// bends. Strips are halved where the way does, so it costs some dozens of rows, most of them where the way touches.
///
/// The search for the way is complete up to the rounding of coordinates, for which a share of 1e-9 is taken off: every
/// passage is some nanometres wider than it is in truth, because walls are made of shapes eroded by that. Two shapes
/// without area make no walls, which makes the bound lower.
#[must_use]
pub fn least_length(
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
    metric: Metric,
    limit: f64,
    gap: f64,
) -> f64 {
    let mut strips = Strips::new(scene, clearance);
    // Nearest to zero doubles are densest, and all turns are alike.
    let start = Point::from(strips.topology().wrap(start));
    let goals: Vec<Segment> = goals.wrapped(strips.topology()).collect();
    let largest = goals.iter().flat_map(Segment::ends).map(|q| q.amax()).fold(start.coords.amax(), f64::max);
    let rounded = |length: f64| (length - f64::max(length * ROUNDING, largest * COORDINATES)).max(0.0);
    let measure = Measure::from(metric);
    let goals: Vec<Segment> = goals.iter().flat_map(|piece| strips.open_goals(piece)).collect();
    let straight = |goals: &Segment| goals.distance(measure, start.coords);
    let mut copies = copies(strips.topology(), metric, start, &goals, limit);
    copies.retain(|copy| straight(copy) < limit);
    if strips.count() == 0 {
        // Joint 1 cannot move: what closes the way of joint 2 is not looked at.
        let nearest = copies.iter().map(straight).fold(limit, f64::min);
        return rounded(nearest);
    }
    let vicinity = Vicinity::of(scene, strips.pairs().into());
    let enough = limit / (1.0 + gap);
    let (mut best, mut idle) = (0.0, 0);
    let nearest = copies.iter().map(straight).fold(limit, f64::min);
    let mut near = f64::max(1.5 * nearest, limit * LEAST_SHARE).min(limit);
    for _ in 0..ROUNDS {
        // Goals and doors on far turns cost time, so ways are looked for nearby first.
        let (length, corners) = loop {
            let goals: Vec<Segment> = copies.iter().copied().filter(|goal| straight(goal) < near).collect();
            match Search::new(&mut strips, measure, &goals, near).run(start) {
                Way::Shortest(length, corners) => break (length, corners),
                Way::NoneBelow(length) if length < near || near >= limit => break (length, Vec::new()),
                Way::NoneBelow(_) => near = (2.0 * near).min(limit),
            }
        };
        idle = if length - best > gap / 8.0 * limit { 0 } else { idle + 1 };
        best = f64::max(best, length);
        if best >= enough || idle >= PATIENCE || strips.are_too_many() {
            break;
        }
        let passed = passed(scene, &vicinity, clearance, &mut strips, &corners, measure, gap * limit * WORTH);
        if passed.is_empty() || !strips.halve(&passed) {
            break;
        }
    }
    rounded(best.min(limit))
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
        let copies = topology.axes[k].copies_within(least, window);
        copies.map(|copy| ((copy - least) / TAU).round()).collect::<Vec<_>>()
    };
    let mut copies = Vec::new();
    for goals in goals {
        let (first, second) = (turns(0, goals), turns(1, goals));
        copies.extend(first.iter().flat_map(|&first| second.iter().map(move |&second| goals.turned([first, second]))));
    }
    copies
}
