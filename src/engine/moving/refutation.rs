//! Proofs that no timing helps: that whoever goes along a path, in whatever way, meets what moves.

use super::blocked::{Around, Movers, complement};
use crate::check::{Deviation, Posture};
use crate::geometry::{Convex, Interval, Ordered, Point, merge_in_place, separation};
use crate::interrupt::checkpoint;
use crate::model::{Leg, Pair};
use crate::space::{Configuration, Path};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Stretches that a path is cut into, at least.
const STRETCHES: usize = 64;

/// Overlaps count if they are deeper than this share of the lengths involved: far more than rounding.
const DEEPER: f64 = 1e-9;

/// Times of overlap are found to this, seconds.
const STEP: f64 = 1e-3;

/// A stretch of a path.
struct Stretch {
    /// The times that are left: at all others each of its postures meets something that moves.
    left: Vec<Interval>,
    /// What it takes at least to go from one end to the other, seconds.
    takes: f64,
}

/// Whether it is proven that no motion along a path, forwards and backwards as it pleases and at whatever speeds the joints allow, gets from its start to its end without
/// coming nearer to what moves than the clearance, or meeting it.
///
/// Place on the path and time are a plane. For each of some stretches of the path the times are found at which all of its postures overlap
/// something that moves, deeper than the arm moves in the stretch; of what is left only that counts which is reached: from the
/// start at time 0, on to neighbouring stretches at times that are left in both, not faster than the joints' top speeds.
pub fn no_timing(movers: &Movers, path: &Path) -> bool {
    let stretches = stretches(movers, path);
    let Some(first) = stretches.first() else { return false };
    if first.left.first().is_none_or(|left| left[0] > 0.0) {
        return true;
    }
    // When a stretch's first (0) or second (1) end can be reached at the soonest, within one of the times that are left.
    let mut known: BTreeMap<(usize, usize, usize), f64> = BTreeMap::new();
    let mut open = BinaryHeap::from([Reverse((Ordered(0.0), 0, 0, 0))]);
    known.insert((0, 0, 0), 0.0);
    while let Some(Reverse((Ordered(time), stretch, gap, end))) = open.pop() {
        checkpoint();
        if known[&(stretch, gap, end)] < time {
            continue;
        }
        if stretch + 1 == stretches.len() && end == 1 {
            return false;
        }
        let Stretch { left, takes } = &stretches[stretch];
        let until = left[gap][1];
        let mut reach = |stretch: usize, gap: usize, end: usize, time: f64| {
            if known.get(&(stretch, gap, end)).is_none_or(|known| time < *known) {
                known.insert((stretch, gap, end), time);
                open.push(Reverse((Ordered(time), stretch, gap, end)));
            }
        };
        if time + takes <= until {
            reach(stretch, gap, 1 - end, time + takes);
        }
        let beyond = if end == 1 { stretch + 1 } else { stretch.wrapping_sub(1) };
        for (other, &[begins, ends]) in stretches.get(beyond).iter().flat_map(|next| next.left.iter().enumerate()) {
            let at = time.max(begins);
            if at <= until.min(ends) {
                reach(beyond, other, 1 - end, at);
            }
        }
    }
    true
}

fn stretches(movers: &Movers, path: &Path) -> Vec<Stretch> {
    let scene = movers.scene();
    let length = path.length();
    let speeds = scene.arm().joints.each_ref().map(|joint| joint.velocity);
    let mut stretches = Vec::new();
    for (a, b) in path.segments() {
        let parts = ((b - a).norm() / length * STRETCHES as f64).ceil().max(1.0) as usize;
        for part in 0..parts {
            let at = |k: usize| a + (b - a) * (k as f64 / parts as f64);
            let half: Configuration = (at(part + 1) - at(part)) / 2.0;
            let posture = Posture::new(scene, at(part) + half);
            let deviation = Deviation::Along(half);
            let mut met = Vec::new();
            for &pair in scene.moving_pairs() {
                met_times(movers, &posture, deviation, pair, &mut met);
            }
            merge_in_place(&mut met);
            let takes = (0..2).map(|k| 2.0 * half[k].abs() / speeds[k]).fold(0.0, f64::max);
            stretches.push(Stretch { left: complement(&met), takes: takes * (1.0 - DEEPER) });
        }
    }
    stretches
}

/// Times at which a pair overlaps, grown by the clearance, all over the deviation: a subset of them, in no order.
fn met_times(movers: &Movers, posture: &Posture, deviation: Deviation, pair: Pair, out: &mut Vec<Interval>) {
    let scene = movers.scene();
    let Some(mover) = scene.mover(pair) else { return };
    // Only when they are near at all.
    let mut near = Vec::new();
    let mut known = None;
    let still = Around::of(&mut known, posture, Deviation::Box([0.0; 2]), pair);
    if !movers.near_times(posture, still, pair, &mut near) {
        return;
    }
    merge_in_place(&mut near);
    let (part, piece) = (scene.part(pair).at(&posture.pose(pair.link)), scene.piece(pair));
    let scale = part.reach_from(Point::origin()) + piece.reach_from(Point::origin());
    let deeper = posture.farthest_motion(pair, deviation) - scene.workspace().clearance + DEEPER * scale;
    for leg in mover.course.legs() {
        for &[from, to] in &near {
            let (from, to) = (from.max(leg.from), to.min(leg.to));
            if from <= to {
                met_in(&part, piece, leg, [from, to], deeper, out);
            }
        }
    }
}

fn met_in(part: &Convex, piece: &Convex, leg: &Leg, within: Interval, deeper: f64, out: &mut Vec<Interval>) {
    let depth = |time: f64| -separation(part, &piece.at(&leg.pose(time))).distance;
    if leg.is_still() {
        if depth(leg.from) > deeper {
            out.push(within);
        }
        return;
    }
    let speed = leg.speed(piece.reach_from(Point::origin()));
    let mut open = vec![within];
    while let Some([from, to]) = open.pop() {
        checkpoint();
        let (middle, half) = (f64::midpoint(from, to), (to - from) / 2.0);
        let (here, drifts) = (depth(middle), speed * half);
        if here - drifts > deeper {
            out.push([from, to]);
        } else if here + drifts > deeper && to - from > STEP {
            open.extend([[middle, to], [from, middle]]);
        }
    }
}
