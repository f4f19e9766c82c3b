//! When a motion may depart: at which times it would meet nothing that moves.

use super::blocked::{Around, Movers, STILL};
use cplan_core::check::Posture;
use cplan_geometry::{Interval, merge_in_place};
use cplan_handling::Piece;
use cplan_interrupt::checkpoint;
use cplan_motion::{Place, Span};

/// Stretches of a motion are halved until no point of the arm moves farther in half of one than this share of the arm's reach, ...
const MOTION: f64 = 4e-3;

/// ... or until they are as short as this, seconds.
const TIME: f64 = 2e-3;

/// The times within a window at which a motion must not begin: if it did, something that moves would, or might, be nearer to the arm than the
/// clearance at some time of it. In order and disjoint; a superset.
///
/// In a stretch of the motion, which takes from `a` to `b` seconds after it began, the arm is in the way of what moves at times `[c, d]`
/// ([`Movers::near`]); so it must not begin in `[c - b, d - a]`. Of long stretches that is far too much, at a single moment it is exact: stretches
/// are halved, the longest first, until what is blocked by what happens at the moments in their middles covers them. So it is only near the ends of
/// what is blocked that it is looked closely.
pub fn blocked_departures(movers: &Movers, pieces: &[Piece], window: Interval) -> Vec<Interval> {
    let scene = movers.scene();
    let finest = MOTION * scene.arm().reach();
    let (mut blocked, mut times) = (Vec::new(), Vec::new());
    let mut open = vec![(Span::all(pieces.len()), movers.meetings().to_vec())];
    while !open.is_empty() {
        let (mut halves, mut found) = (Vec::new(), Vec::new());
        for (span, meetings) in open {
            checkpoint();
            let (middle, deviation) = span.deviation(pieces);
            let posture = Posture::new(scene, middle);
            let [begins, ends] = span.ends().map(|place| since(pieces, place));
            let (mut moves, mut known) = (0.0_f64, None);
            // What is not known to be blocked, and the meetings that it is because of.
            let (mut departures, mut open) = (Vec::new(), Vec::new());
            for meeting in meetings {
                let around = Around::of(&mut known, movers, &posture, deviation, meeting);
                moves = moves.max(around.moves());
                times.clear();
                movers.near(around, meeting, &mut times);
                merge_in_place(&mut times);
                for &[from, to] in &times {
                    let departing = [(from - ends).max(window[0]), (to - begins).min(window[1])];
                    if let Some([first, last]) = uncovered(&blocked, departing) {
                        departures.push([first, last]);
                        let [from, to] = [from.max(first + begins), to.min(last + ends)];
                        open.push(meeting.in_time([from, to.max(from)]));
                    }
                }
            }
            match span.halves().filter(|_| moves > finest && ends - begins > TIME) {
                _ if open.is_empty() => (),
                Some([before, after]) => {
                    let place = span.middle();
                    let posture = Posture::new(scene, pieces[place.0].at(place.1));
                    let (time, mut known) = (since(pieces, place), None);
                    times.clear();
                    for &meeting in &open {
                        let around = Around::of(&mut known, movers, &posture, STILL, meeting);
                        movers.met(around, meeting, (ends - begins) / 2.0, &mut times);
                    }
                    found.extend(times.iter().map(|[from, to]| [from - time, to - time]));
                    halves.extend([(before, open.clone()), (after, open)]);
                }
                None => found.append(&mut departures),
            }
        }
        blocked.append(&mut found);
        merge_in_place(&mut blocked);
        open = halves;
    }
    blocked
}

/// Seconds after a motion began.
fn since(pieces: &[Piece], (piece, share): Place) -> f64 {
    pieces[piece].time(share) - pieces[0].from
}

/// What is left of an interval if others, in order and disjoint, take away from its ends; none if one of them holds it.
fn uncovered(others: &[Interval], [from, to]: Interval) -> Option<Interval> {
    let holding = |time: f64| {
        let next = others.partition_point(|[begins, _]| *begins <= time);
        others[..next].last().filter(|[_, ends]| time <= *ends)
    };
    let left = [holding(from).map_or(from, |other| other[1]), holding(to).map_or(to, |other| other[0])];
    (from <= to && left[0] <= left[1]).then_some(left)
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
