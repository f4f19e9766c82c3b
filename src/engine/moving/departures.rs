//! When a motion may depart: at which times it would meet nothing that moves.

use super::blocked::{Around, Movers};
use crate::check::{Posture, Span};
use crate::geometry::{Interval, merge_in_place};
use crate::interrupt::checkpoint;
use crate::space::Piece;

/// How finely a motion is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fineness {
    /// Its stretches are halved until no point of the arm moves farther in half of one than this share of the arm's reach, ...
    pub motion: f64,
    /// ... or until they are as short as this, seconds.
    pub time: f64,
}

/// The times at which a motion must not begin: if it did, something that moves would, or might, be nearer to the arm than the clearance at some
/// time of it. In order and disjoint; a superset.
///
/// In a stretch of the motion, which takes from `a` to `b` seconds after it began, the arm is in the way of what moves at times `[c, d]`
/// ([`Movers::near_times`]); so it must not begin in `[c - b, d - a]`. Only stretches in which anything is near are halved, and only what is near is
/// looked at again.
pub fn blocked_departures(movers: &Movers, pieces: &[Piece], fineness: Fineness) -> Vec<Interval> {
    let scene = movers.scene();
    let finest = fineness.motion * scene.arm().reach();
    let (mut blocked, mut near) = (Vec::new(), Vec::new());
    let mut open = vec![(Span::all(pieces.len()), scene.moving_pairs().to_vec())];
    while let Some((span, mut pairs)) = open.pop() {
        checkpoint();
        let (middle, deviation) = span.deviation(pieces);
        let posture = Posture::new(scene, middle);
        let [begins, ends] = span.ends().map(|(piece, share)| pieces[piece].time(share) - pieces[0].from);
        near.clear();
        let (mut moves, mut known) = (0.0_f64, None);
        pairs.retain(|&pair| {
            let around = Around::of(&mut known, &posture, deviation, pair);
            moves = moves.max(around.moves());
            movers.near_times(&posture, around, pair, &mut near)
        });
        if pairs.is_empty() {
            continue;
        }
        match span.halves().filter(|_| moves > finest && ends - begins > fineness.time) {
            Some([first, second]) => open.extend([(second, pairs.clone()), (first, pairs)]),
            None => blocked.extend(near.iter().map(|[from, to]| [from - ends, to - begins])),
        }
    }
    merge_in_place(&mut blocked);
    blocked
}

/// The first time from one to another, ends included, at which a motion may begin; none if there is none.
pub fn first_departure(blocked: &[Interval], from: f64, to: f64) -> Option<f64> {
    let mut time = from;
    for &[lower, upper] in blocked {
        if time < lower {
            break;
        }
        if time <= upper {
            time = after(upper);
        }
    }
    // Nobody departs after all time.
    (time <= to && time < f64::INFINITY).then_some(time)
}

/// A nanosecond after: times of trajectories are whole ones.
fn after(time: f64) -> f64 {
    time + 2e-9
}
