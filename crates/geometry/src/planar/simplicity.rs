//! Whether any sides of a chain of corners meet that should not.

use super::{Boundary, Orientation, Point, Status};
use cplan_interrupt::checkpoint;
use std::cmp::Ordering;

/// Of the sides of a closed ring (side `i` runs from corner `i` to the next one) the first that meets an earlier one which is
/// not its neighbour; the greater number second. Exact, `O(n log n)`, with another factor of `log n` if there is one.
///
/// The corners are distinct and finite, and no side folds back onto the one before it.
pub fn first_meeting(ring: &[Point]) -> Option<(usize, usize)> {
    let n = ring.len();
    if !meets_itself(ring, n) {
        return None;
    }
    // Adding sides never mends what has met, so halving finds the first that spoils it.
    let (mut clear, mut spoilt) = (2, n);
    while spoilt - clear > 1 {
        let middle = clear.midpoint(spoilt);
        *(if meets_itself(ring, middle) { &mut spoilt } else { &mut clear }) = middle;
    }
    let last = spoilt - 1;
    let side = |i: usize| (ring[i], ring[(i + 1) % n]);
    let neighbours = |i: usize| last - i == 1 || last - i == n - 1;
    let (c, d) = side(last);
    let meets = |&i: &usize| {
        let (a, b) = side(i);
        !neighbours(i) && crate::segments_meet(a, b, c, d)
    };
    (0..last).find(meets).map(|first| (first, last))
}

/// Whether two of the first `count` sides of a ring meet anywhere but in a common corner: a line that sweeps over the plane
/// has them side by side before (Shamos, Hoey 1976).
fn meets_itself(ring: &[Point], count: usize) -> bool {
    let boundary = Boundary::of_chain(ring, count);
    let mut status = Status::new(boundary.sides.len());
    let place = |side: usize, v: usize| boundary.place(side, boundary.vertices[v]);
    // Sides in order left of the first right end of both meet unless that is on its own side of the other.
    let meet = |below: Option<usize>, above: Option<usize>| {
        let (Some(below), Some(above)) = (below, above) else { return false };
        let ends = [below, above].map(|side| boundary.sides[side].right_end());
        match ends[0].cmp(&ends[1]) {
            Ordering::Less => place(above, ends[0]) != Orientation::Clockwise,
            Ordering::Greater => place(below, ends[1]) != Orientation::CounterClockwise,
            Ordering::Equal => false,
        }
    };
    for v in 0..boundary.vertices.len() {
        checkpoint();
        if boundary.ending(v).next().is_none() && boundary.beginning(v).is_empty() {
            continue;
        }
        let mut below = match boundary.ending(v).next() {
            Some(lowest) => status.below(lowest),
            None => status.last_where(|side| place(side, v) == Orientation::CounterClockwise),
        };
        for side in boundary.ending(v) {
            status.remove(side);
        }
        let above = status.above(below);
        if above.is_some_and(|above| place(above, v) != Orientation::Clockwise) {
            return true;
        }
        for side in boundary.beginning(v) {
            status.insert_above(below, side);
            if meet(below, Some(side)) {
                return true;
            }
            below = Some(side);
        }
        if meet(below, above) {
            return true;
        }
    }
    false
}
