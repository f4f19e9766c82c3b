//! Times at which a motion may depart without meeting a moving obstacle.

use super::blocked::{MovingObstacles, NO_DEVIATION, PartDeviation};
use cplan_geometry::{Interval, merge_in_place};
use cplan_handling::Piece;
use cplan_interrupt::checkpoint;
use cplan_judge::Posture;
use cplan_motion::{Place, Span};

/// A stretch is halved if a point of the arm moves farther than this in half of it. A fraction of the arm's reach.
const MAX_STRETCH_MOTION: f64 = 4e-3;

/// Shortest duration of a stretch that may be halved, in seconds.
const MIN_STRETCH_TIME: f64 = 2e-3;

/// Returns the departure times in a window at which the motion would, or might, come nearer to a moving obstacle than
/// the clearance. The result includes all such times and possibly others. Its intervals are in order and disjoint.
///
/// Consider a stretch of the motion from `a` to `b` seconds after departure. If obstacles block it at times `[c, d]`
/// ([`MovingObstacles::near`]), the motion must not begin in `[c - b, d - a]`. For a long stretch this interval is much
/// too long; for a single moment it is exact. So stretches are halved, the longest first. A stretch is not halved if
/// the middles of other stretches already block all the departures that it may block. So short stretches are needed
/// only near the ends of the blocked intervals.
pub fn blocked_departures(movers: &MovingObstacles, pieces: &[Piece], window: Interval) -> Vec<Interval> {
    let scene = movers.scene();
    let finest = MAX_STRETCH_MOTION * scene.arm().reach();
    let (mut blocked, mut times) = (Vec::new(), Vec::new());
    let mut open = vec![(Span::all(pieces.len()), movers.meetings.clone())];
    while !open.is_empty() {
        let (mut halves, mut found) = (Vec::new(), Vec::new());
        for (span, meetings) in open {
            checkpoint();
            let (middle, deviation) = span.deviation(pieces);
            let posture = Posture::new(scene, middle);
            let [begins, ends] = span.ends().map(|place| time_at(pieces, place));
            let (mut moves, mut known) = (0.0_f64, None);
            // Departures that may be blocked but are not known to be, and the meetings that may block them.
            let (mut departures, mut open) = (Vec::new(), Vec::new());
            for meeting in meetings {
                let around = PartDeviation::of(&mut known, movers, &posture, deviation, meeting);
                moves = moves.max(around.moves);
                times.clear();
                movers.near(around, meeting, &mut times);
                merge_in_place(&mut times);
                for &[from, to] in &times {
                    let departing = [(from - ends).max(window[0]), (to - begins).min(window[1])];
                    if let Some([first, last]) = remaining_part(&blocked, departing) {
                        departures.push([first, last]);
                        let [from, to] = [from.max(first + begins), to.min(last + ends)];
                        open.push(meeting.during([from, to.max(from)]));
                    }
                }
            }
            match span.halves().filter(|_| moves > finest && ends - begins > MIN_STRETCH_TIME) {
                _ if open.is_empty() => (),
                Some([before, after]) => {
                    let place = span.middle();
                    let posture = Posture::new(scene, pieces[place.0].at(place.1));
                    let (time, mut known) = (time_at(pieces, place), None);
                    times.clear();
                    for &meeting in &open {
                        let around = PartDeviation::of(&mut known, movers, &posture, NO_DEVIATION, meeting);
                        movers.collision_times(around, meeting, (ends - begins) / 2.0, &mut times);
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

/// Returns the time of a place, in seconds since the motion began.
fn time_at(pieces: &[Piece], (piece, share): Place) -> f64 {
    pieces[piece].time(share) - pieces[0].from
}

/// Shortens an interval at both ends by those `others` that contain its ends. The others are in order and disjoint.
/// Returns `None` if nothing remains.
fn remaining_part(others: &[Interval], [from, to]: Interval) -> Option<Interval> {
    let holding = |time: f64| {
        let next = others.partition_point(|[begins, _]| *begins <= time);
        others[..next].last().filter(|[_, ends]| time <= *ends)
    };
    let left = [holding(from).map_or(from, |other| other[1]), holding(to).map_or(to, |other| other[0])];
    (from <= to && left[0] <= left[1]).then_some(left)
}

/// Returns the first time in the closed interval from `from` to `to` at which a motion may begin. `None` if there is none.
pub fn first_departure(blocked: &[Interval], from: f64, to: f64) -> Option<f64> {
    let mut time = from;
    for &[lower, upper] in blocked {
        if time < lower {
            break;
        }
        if time <= upper {
            time = next_time(upper);
        }
    }
    // An infinite time is not a departure.
    (time <= to && time < f64::INFINITY).then_some(time)
}

/// Returns a time that is later even after rounding: times of trajectories are whole nanoseconds.
fn next_time(time: f64) -> f64 {
    time + 2e-9
}
