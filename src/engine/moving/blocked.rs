//! When the arm may not be somewhere: the times at which what moves is in the way, exact in time as slices are in joint space.

use crate::check::{Deviation, Posture};
use crate::geometry::{Convex, Interval, Point, Vector, cross, merge_in_place, separation, sliding};
use crate::interrupt::checkpoint;
use crate::model::{Leg, Pair, Scene};

/// What is looked at is larger than it is by this share of the lengths involved: far more than rounding, far less than anybody sees.
const ROOM: f64 = 1e-9;

/// Turning obstacles are followed in steps of this, seconds: contact may seem to begin so much earlier and to end so much later.
const STEP: f64 = 1e-3;

/// The times at which a pair is, or may be, nearer than the clearance while the configuration is no farther from the posture's than `deviation`:
/// a superset, in no order. Whether there are any.
///
/// A shape that slides past another one, grown by how far the arm's part moves, meets it for one interval of time, in closed form
/// ([`sliding`]); where it turns, time is halved down to a millisecond.
pub fn near_times(
    scene: &Scene,
    posture: &Posture,
    deviation: Deviation,
    pair: Pair,
    clearance: f64,
    out: &mut Vec<Interval>,
) -> bool {
    let Some(mover) = scene.mover(pair) else { return false };
    let part = scene.part(pair).at(&posture.pose(pair.link));
    let piece = scene.piece(pair);
    let scale = part.reach_from(Point::origin()) + piece.reach_from(Point::origin());
    let grow = posture.farthest_motion(pair, deviation) + clearance + ROOM * scale;
    let before = out.len();
    for leg in mover.course.legs() {
        let at = piece.at(&leg.pose(leg.from));
        if leg.is_still() {
            if separation(&part, &at).distance <= grow {
                out.push([leg.from, leg.to]);
            }
        } else if leg.turn == 0.0 {
            let speed = leg.velocity.norm();
            let direction = leg.velocity / speed;
            if passes_by(&part, &at, direction, grow) {
                continue;
            }
            // Seen from the obstacle the part slides backwards.
            if let Some([first, last]) = sliding(&part, -direction, &at, grow) {
                let met = [leg.from + first / speed - ROOM, leg.from + last / speed + ROOM];
                let [first, last] = [met[0].max(leg.from), met[1].min(leg.to)];
                if first <= last {
                    out.push([first, last]);
                }
            }
        } else {
            turning(&part, piece, leg, grow, out);
        }
    }
    out.len() > before
}

/// Whether a shape that slides along a direction stays clear of another one: discs around both do.
fn passes_by(part: &Convex, piece: &Convex, direction: Vector, grow: f64) -> bool {
    let disc = |shape: &Convex| {
        let [low, high] = shape.bounds();
        let middle = nalgebra::center(&low, &high);
        (middle, (high - low).norm() / 2.0)
    };
    let ((a, around_a), (b, around_b)) = (disc(part), disc(piece));
    cross(direction, b - a).abs() > around_a + around_b + grow
}

fn turning(part: &Convex, piece: &Convex, leg: &Leg, grow: f64, out: &mut Vec<Interval>) {
    let speed = leg.speed(piece.reach_from(Point::origin()));
    let mut open = vec![[leg.from, leg.to]];
    while let Some([from, to]) = open.pop() {
        checkpoint();
        let (middle, half) = (f64::midpoint(from, to), (to - from) / 2.0);
        let distance = separation(part, &piece.at(&leg.pose(middle))).distance - grow;
        let drifts = speed * half;
        if distance > drifts {
            continue;
        }
        // Near all the time, or too short a time to tell.
        if distance + drifts <= 0.0 || to - from <= STEP {
            out.push([from, to]);
        } else {
            open.extend([[middle, to], [from, middle]]);
        }
    }
}

/// The times at which nothing that moves is nearer to the arm at a posture than the clearance; in order, open at no end but the last.
pub fn safe_intervals(scene: &Scene, posture: &Posture, clearance: f64) -> Vec<Interval> {
    let mut near = Vec::new();
    for &pair in scene.moving_pairs() {
        near_times(scene, posture, Deviation::Box([0.0; 2]), pair, clearance, &mut near);
    }
    merge_in_place(&mut near);
    complement(&near)
}

/// What is left of the times from 0 on; ends of the intervals given count as theirs.
pub fn complement(intervals: &[Interval]) -> Vec<Interval> {
    let (mut left, mut from) = (Vec::new(), 0.0);
    for &[lower, upper] in intervals {
        if from < lower {
            left.push([from, lower]);
        }
        from = f64::max(from, upper);
    }
    if from < f64::INFINITY {
        left.push([from, f64::INFINITY]);
    }
    left
}
