//! The final judgement: two motions on two clocks keep their distance for every skew of the clocks within a bound.

use crate::between::{Between, Placed};
use crate::curve::Curve;
use crate::stage::StagePairs;
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
    /// The stages of both arms.
    pub(crate) stages: [usize; 2],
    /// The bodies, one of each arm, by their numbers in these stages.
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

/// Judges two motions on two clocks, if either clock may be ahead of the other by `skew` seconds. The curves contain the
/// rests before and after the motions.
///
/// The pairs of times that differ by at most the skew form a strip. It is covered by rectangles: the motions of all links in
/// a rectangle are bounded, and if the bound does not decide, the rectangle is halved.
pub(crate) fn judge(pairs: &StagePairs, curves: &[Curve; 2], skew: f64) -> Judgement {
    let nearest = nearest_of(sampled(pairs, curves, SAMPLES, skew));
    let legs = (0..curves[0].legs()).flat_map(|one| (0..curves[1].legs()).map(move |two| [one, two]));
    judge_legs(pairs, curves, skew, legs, nearest)
}

/// Judges two motions at the pairs of times that belong to the given pairs of legs and differ by at most `skew` seconds.
/// `nearest` is the nearest place that is known.
pub(crate) fn judge_legs(
    pairs: &StagePairs,
    curves: &[Curve; 2],
    skew: f64,
    legs: impl IntoIterator<Item = [usize; 2]>,
    mut nearest: Option<NearestPlace>,
) -> Judgement {
    let required = pairs.clearance();
    let is_collision = |place: &NearestPlace| place.distance <= 0.0 || place.distance < required;
    if let Some(place) = nearest.filter(is_collision) {
        return Judgement::TooClose(place);
    }
    let side = |between: &Between, arm: usize, span: Span| {
        let (middle, deviation) = curves[arm].deviation(span);
        (span, Rc::new(between.placed(arm, middle, deviation)))
    };
    let is_beside = |spans: [Span; 2]| {
        let [a, b] = [0, 1].map(|arm| curves[arm].times(spans[arm]));
        a[0] - b[1] > skew || b[0] - a[1] > skew
    };
    let legs = legs.into_iter().filter(|legs| !is_beside([0, 1].map(|arm| curves[arm].leg(legs[arm]))));
    let mut open: Vec<_> = legs
        .map(|legs| {
            let stages = [0, 1].map(|arm| curves[arm].stage(legs[arm]));
            (stages, [0, 1].map(|arm| side(pairs.between(stages), arm, curves[arm].leg(legs[arm]))))
        })
        .collect();
    let (mut clearance, mut evaluations) = (f64::INFINITY, 0);
    while let Some((stages, sides)) = open.pop() {
        checkpoint();
        let between = pairs.between(stages);
        let spans = sides.each_ref().map(|(span, _)| *span);
        if is_beside(spans) {
            continue;
        }
        let [a, b] = [0, 1].map(|arm| curves[arm].times(spans[arm]));
        evaluations += 1;
        let placed = sides.each_ref().map(|(_, placed)| &**placed);
        let target = nearest.map_or(0.0, |place| TIGHTNESS * place.distance).max(required);
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
            let place = NearestPlace { times, distance: here, stages, pair };
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
                sides[arm] = side(between, arm, span);
                (stages, sides)
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
    pairs: &StagePairs,
    curves: &[Curve; 2],
    skew: f64,
    known: NearestPlace,
) -> (NearestPlace, NearestPlace) {
    let is_near = |place: &NearestPlace| place.distance <= 0.0 || place.distance < pairs.clearance();
    let seen = sampled(pairs, curves, FINE_SAMPLES, skew).filter(is_near).chain([known]);
    let earlier = |a: NearestPlace, b: NearestPlace| {
        let last = |place: &NearestPlace| place.times[0].max(place.times[1]);
        if last(&b) < last(&a) { b } else { a }
    };
    let seen: Vec<NearestPlace> = seen.collect();
    let first = seen.iter().copied().reduce(earlier).unwrap_or(known);
    (first, nearest_of(seen.into_iter()).unwrap_or(known))
}

/// Returns samples of two motions, each with the distance of the arms: both clocks are equal, or differ by the skew.
fn sampled(pairs: &StagePairs, curves: &[Curve; 2], samples: usize, skew: f64) -> impl Iterator<Item = NearestPlace> {
    let [one, two] = curves.each_ref().map(Curve::ends);
    let [begin, end] = [one[0].min(two[0]), one[1].max(two[1])];
    let times = (0..=samples).map(move |k| begin + (end - begin) * (k as f64 / samples as f64));
    let shifted = move |time: f64| [-skew, 0.0, skew].map(|shift| [time, time + shift]);
    times.flat_map(shifted).filter_map(move |times| {
        let stages = [0, 1].map(|arm| curves[arm].stage(curves[arm].leg_at(times[arm])));
        let between = pairs.between(stages);
        let placed = [0, 1].map(|arm| between.at_rest(arm, curves[arm].at(times[arm])));
        let (distance, pair) = between.distance(placed.each_ref(), f64::INFINITY).here?;
        Some(NearestPlace { times, distance, stages, pair })
    })
}

fn nearest_of(places: impl Iterator<Item = NearestPlace>) -> Option<NearestPlace> {
    places.reduce(|nearest, place| if place.distance < nearest.distance { place } else { nearest })
}
