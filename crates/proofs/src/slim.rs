//! Proofs with fewer boxes.

use cplan_core::check::{CheckedProof, Disconnection, StuckBox};

/// Proofs of no more boxes stay as they are.
const SMALL: usize = 256;

/// The share by which a proof may have more boxes than the fewest largest ones that hold.
const CLOSE: usize = 8;

/// Reduces a proof to about the fewest of its largest boxes, by their extent in `q2`, that still separate start and goal.
/// `check` judges a choice of boxes; none if it refuses all of them together. Slabs need thousands of boxes where an obstacle's edge
/// is grazed; a wall through the obstacle's middle needs some dozens.
///
/// More boxes separate no less, so doubling and halving find the number. `O(log n)` calls of `check`.
pub fn slimmed(proof: &Disconnection, check: impl Fn(Disconnection) -> Option<CheckedProof>) -> Option<CheckedProof> {
    let count = proof.stuck().len();
    let height = |b: &StuckBox| b.cell.upper[1] - b.cell.lower[1];
    let mut largest: Vec<usize> = (0..count).collect();
    largest.sort_by(|&a, &b| height(&proof.stuck()[b]).total_cmp(&height(&proof.stuck()[a])).then(a.cmp(&b)));
    let some = |n: usize| {
        let mut chosen = largest[..n].to_vec();
        chosen.sort_unstable();
        check(Disconnection::new(chosen.into_iter().map(|k| proof.stuck()[k].clone()).collect()))
    };
    let (mut too_few, mut enough) = (0, SMALL.min(count));
    let mut slim = loop {
        match some(enough) {
            Some(found) => break found,
            None if enough == count => return None,
            None => (too_few, enough) = (enough, (2 * enough).min(count)),
        }
    };
    while count > SMALL && enough - too_few > enough / CLOSE + 1 {
        let middle = too_few.midpoint(enough);
        match some(middle) {
            Some(smaller) => (slim, enough) = (smaller, middle),
            None => too_few = middle,
        }
    }
    Some(slim)
}
