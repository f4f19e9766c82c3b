//! Tests whether sides of a ring meet where they must not.

use super::{Boundary, Orientation, Point, Status};
use cplan_interrupt::checkpoint;
use std::cmp::Ordering;

/// Finds the first side of a closed ring that meets an earlier side which is not its neighbour. Returns the earlier
/// side and this one. Side `i` runs from corner `i` to the next one. Exact. Takes `O(n log n)`, and another factor of
/// `log n` if there is such a side.
///
/// The corners must be distinct and finite, and no side may fold back onto the previous one.
pub fn first_meeting(ring: &[Point]) -> Option<(usize, usize)> {
    let n = ring.len();
    if !meets_itself(ring, n) {
        return None;
    }
    // More sides never remove an intersection, so bisection finds the first side that causes one.
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

/// Returns true if two of the first `count` sides of a ring meet other than in a common corner. Such sides become
/// neighbours on a sweep line (Shamos, Hoey 1976).
fn meets_itself(ring: &[Point], count: usize) -> bool {
    let boundary = Boundary::of_chain(ring, count);
    let mut status = Status::new(boundary.sides.len());
    let place = |side: usize, v: usize| boundary.place(side, boundary.vertices[v]);
    // Two sides that are in order to the left of the first right end meet, unless that end lies on its own side of the
    // other side.
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
