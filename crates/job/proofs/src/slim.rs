//! Reduces proofs to fewer boxes.

use cplan_judge::{CheckedProof, CollisionBox, Disconnection};

/// Largest number of boxes of proofs that are not reduced.
const MAX_UNREDUCED_BOXES: usize = 256;

/// A reduced proof may exceed the smallest sufficient number of boxes by one part in this many.
const EXCESS_DIVISOR: usize = 8;

/// Reduces a proof of more than 256 boxes to about the fewest of its tallest boxes (by extent in `q2`) that still separate start
/// and goal. `check` checks a selection of boxes. Returns `None` if it refuses all boxes together. Where shapes graze an
/// obstacle's edge, slabs give thousands of boxes, but some dozens through the obstacle's middle suffice.
///
/// More boxes never separate less, so doubling and bisection find the number, with `O(log n)` calls of `check`.
pub fn slimmed(proof: &Disconnection, check: impl Fn(Disconnection) -> Option<CheckedProof>) -> Option<CheckedProof> {
    let count = proof.collision_boxes().len();
    let height = |b: &CollisionBox| b.cell.upper[1] - b.cell.lower[1];
    let mut largest: Vec<usize> = (0..count).collect();
    largest.sort_by(|&a, &b| {
        height(&proof.collision_boxes()[b]).total_cmp(&height(&proof.collision_boxes()[a])).then(a.cmp(&b))
    });
    let some = |n: usize| {
        let mut chosen = largest[..n].to_vec();
        chosen.sort_unstable();
        check(Disconnection::new(chosen.into_iter().map(|k| proof.collision_boxes()[k].clone()).collect()))
    };
    let (mut too_few, mut enough) = (0, MAX_UNREDUCED_BOXES.min(count));
    let mut slim = loop {
        match some(enough) {
            Some(found) => break found,
            None if enough == count => return None,
            None => (too_few, enough) = (enough, (2 * enough).min(count)),
        }
    };
    while count > MAX_UNREDUCED_BOXES && enough - too_few > enough / EXCESS_DIVISOR + 1 {
        let middle = too_few.midpoint(enough);
        match some(middle) {
            Some(smaller) => (slim, enough) = (smaller, middle),
            None => too_few = middle,
        }
    }
    Some(slim)
}
