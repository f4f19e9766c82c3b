//! The final judgement: two motions on two clocks keep their distance for every skew of the clocks within a bound.

use crate::between::{Between, Placed};
use crate::curve::Curve;
use cplan_interrupt::checkpoint;
use cplan_motion::Span;
use std::rc::Rc;

/// A lower bound on the distance is accepted if it is at least this share of the least distance seen.
const TIGHTNESS: f64 = 0.9;

/// Greatest number of pairs of spans that are examined. They take some seconds.
const MAX_EVALUATIONS: usize = 2_000_000;

/// Number of times that are sampled before the search. They show how near the arms come, and thus how finely they must be
/// examined.
const SAMPLES: usize = 128;

/// The nearest place of two motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPlace {
    /// The time on the clock of each arm, seconds.
    pub times: [f64; 2],
    /// The distance there, metres. It is an upper bound on the least distance.
    pub distance: f64,
    /// The bodies, one of each arm.
    pub(crate) pair: [usize; 2],
}

/// The judgement about two motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Judgement {
    /// Proven: for all skews, the arms keep the clearance, and this distance. It is infinite if no links can meet.
    Apart { clearance: f64, nearest: Option<NearestPlace> },
    /// The arms are too near to each other at this place.
    TooClose(NearestPlace),
    /// The search gave up.
    Undecided,
}

/// Judges two motions on two clocks, if either clock may be ahead of the other by `skew` seconds. Each arm rests at its start
/// before its motion, and at its goal after it.
///
/// The pairs of times that differ by at most the skew form a strip. It is covered by rectangles: the motions of all links in
/// a rectangle are bounded, and if the bound does not decide, the rectangle is halved.
pub(crate) fn judge(between: &Between, curves: [Curve; 2], skew: f64) -> Judgement {
    let [begin, end] = span(&curves, skew);
    let nearest = nearest_of(sampled(between, &curves, SAMPLES, skew));
    let curves = curves.map(|curve| curve.resting(begin, end));
    judge_pairs(between, &curves, skew, vec![[0, 0]], nearest)
}

/// Judges two motions at the pairs of times that belong to the pairs of legs `open` and differ by at most `skew` seconds.
/// `nearest` is the nearest place that is known.
pub(crate) fn judge_pairs(
    between: &Between,
    curves: &[Curve; 2],
    skew: f64,
    open: Vec<[usize; 2]>,
    mut nearest: Option<NearestPlace>,
) -> Judgement {
    let is_collision = |place: &NearestPlace| place.distance <= 0.0 || place.distance < between.clearance;
    if let Some(place) = nearest.filter(is_collision) {
        return Judgement::TooClose(place);
    }
    let side = |arm: usize, span: Span| {
        let (middle, deviation) = curves[arm].deviation(span);
        (span, Rc::new(between.placed(arm, middle, deviation)))
    };
    let pair = |legs: [usize; 2]| [0, 1].map(|arm| side(arm, curves[arm].leg(legs[arm])));
    let mut open: Vec<_> = open.into_iter().map(pair).collect();
    let (mut clearance, mut evaluations) = (f64::INFINITY, 0);
    while let Some(sides) = open.pop() {
        checkpoint();
        let [a, b] = [0, 1].map(|arm| curves[arm].times(sides[arm].0));
        if a[0] - b[1] > skew || b[0] - a[1] > skew {
            continue;
        }
        evaluations += 1;
        let placed = sides.each_ref().map(|(_, placed)| &**placed);
        let target = nearest.map_or(0.0, |place| TIGHTNESS * place.distance).max(between.clearance);
        let distance = between.distance(placed, target);
        if distance.least > 0.0 && distance.least >= target {
            clearance = clearance.min(distance.least);
            continue;
        }
        // A place of the strip within the rectangle shows whether the bound is too low or the arms are near.
        let first = f64::midpoint(a[0].max(b[0] - skew), a[1].min(b[1] + skew));
        let times = [first, first.clamp(b[0], b[1])];
        let seen = [0, 1].map(|arm| between.at_rest(arm, curves[arm].at(times[arm])));
        if let Some((here, pair)) = between.distance(seen.each_ref(), f64::INFINITY).here
            && nearest.is_none_or(|known| here < known.distance)
        {
            let place = NearestPlace { times, distance: here, pair };
            if is_collision(&place) {
                return Judgement::TooClose(place);
            }
            nearest = Some(place);
        }
        let moves = placed.map(Placed::farthest_motion);
        let order = if moves[0] >= moves[1] { [0, 1] } else { [1, 0] };
        let halves = order.into_iter().find_map(|arm| Some((arm, sides[arm].0.halves()?)));
        match halves.filter(|_| evaluations < MAX_EVALUATIONS) {
            Some((arm, halves)) => open.extend(halves.map(|span| {
                let mut sides = sides.clone();
                sides[arm] = side(arm, span);
                sides
            })),
            None => return Judgement::Undecided,
        }
    }
    Judgement::Apart { clearance, nearest }
}

/// Number of times that are sampled in the description of two motions that are too near to each other.
const FINE_SAMPLES: usize = 4096;

/// Returns the first and the nearest sampled place of two motions that are too near to each other. `known` is such a place.
pub(crate) fn sampled_too_near(
    between: &Between,
    curves: &[Curve; 2],
    skew: f64,
    known: NearestPlace,
) -> (NearestPlace, NearestPlace) {
    let is_near = |place: &NearestPlace| place.distance <= 0.0 || place.distance < between.clearance;
    let seen = sampled(between, curves, FINE_SAMPLES, skew).filter(is_near).chain([known]);
    let earlier = |a: NearestPlace, b: NearestPlace| {
        let last = |place: &NearestPlace| place.times[0].max(place.times[1]);
        if last(&b) < last(&a) { b } else { a }
    };
    let seen: Vec<NearestPlace> = seen.collect();
    let first = seen.iter().copied().reduce(earlier).unwrap_or(known);
    (first, nearest_of(seen.into_iter()).unwrap_or(known))
}

/// Returns the times between which two motions are judged, seconds.
fn span(curves: &[Curve; 2], skew: f64) -> [f64; 2] {
    let [one, two] = curves.each_ref().map(Curve::ends);
    [one[0].min(two[0]) - skew, one[1].max(two[1]) + skew]
}

/// Returns samples of two motions, each with the distance of the arms: both clocks are equal, or differ by the skew.
fn sampled(between: &Between, curves: &[Curve; 2], samples: usize, skew: f64) -> impl Iterator<Item = NearestPlace> {
    let [begin, end] = span(curves, skew);
    let times = (0..=samples).map(move |k| begin + (end - begin) * (k as f64 / samples as f64));
    let shifted = move |time: f64| [-skew, 0.0, skew].map(|shift| [time, time + shift]);
    times.flat_map(shifted).filter_map(move |times| {
        let placed = [0, 1].map(|arm| between.at_rest(arm, curves[arm].at(times[arm])));
        let (distance, pair) = between.distance(placed.each_ref(), f64::INFINITY).here?;
        Some(NearestPlace { times, distance, pair })
    })
}

fn nearest_of(places: impl Iterator<Item = NearestPlace>) -> Option<NearestPlace> {
    places.reduce(|nearest, place| if place.distance < nearest.distance { place } else { nearest })
}
