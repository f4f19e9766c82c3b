//! Proofs with fewer boxes.

use crate::check::{CheckedProof, Disconnection, StuckBox};

/// Proofs of no more boxes stay as they are.
const SMALL: usize = 256;

/// The share by which a proof may have more boxes than the fewest largest ones that hold.
const CLOSE: usize = 8;

impl Disconnection {
    /// The proof with about the fewest of its largest boxes, by their extent in `q2`, that still are one; `check` says whether some
    /// are, and if all are not there is none. What slabs tell apart in thousands of boxes, where an obstacle's edge is grazed, a wall
    /// through its middle tells as well in some dozens.
    ///
    /// More boxes separate no less, so doubling and halving find how many it takes. `O(log n)` questions.
    pub(crate) fn slimmed(self, check: impl Fn(Self) -> Option<CheckedProof>) -> Option<CheckedProof> {
        let count = self.stuck().len();
        let height = |b: &StuckBox| b.cell.upper[1] - b.cell.lower[1];
        let mut largest: Vec<usize> = (0..count).collect();
        largest.sort_by(|&a, &b| height(&self.stuck()[b]).total_cmp(&height(&self.stuck()[a])).then(a.cmp(&b)));
        let some = |n: usize| {
            let mut chosen = largest[..n].to_vec();
            chosen.sort_unstable();
            check(Self::new(chosen.into_iter().map(|k| self.stuck()[k].clone()).collect()))
        };
        let (mut too_few, mut enough) = (0, SMALL.min(count));
        let mut proof = loop {
            match some(enough) {
                Some(proof) => break proof,
                None if enough == count => return None,
                None => (too_few, enough) = (enough, (2 * enough).min(count)),
            }
        };
        while count > SMALL && enough - too_few > enough / CLOSE + 1 {
            let middle = too_few.midpoint(enough);
            match some(middle) {
                Some(smaller) => (proof, enough) = (smaller, middle),
                None => too_few = middle,
            }
        }
        Some(proof)
    }
}
