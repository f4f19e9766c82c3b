//! Proofs with fewer boxes.

use crate::check::{Disconnection, StuckBox};

/// Proofs of no more boxes stay as they are.
const SMALL: usize = 256;

/// The share by which a proof may have more boxes than the fewest largest ones that hold.
const CLOSE: usize = 8;

impl Disconnection {
    /// About the fewest of the largest boxes, by their extent in `q2`, that still are a proof: `holds` says whether some are.
    /// The proof itself must. What slabs tell apart in thousands of boxes, where an obstacle's edge is grazed, a wall
    /// through its middle tells as well in some dozens.
    ///
    /// More boxes separate no less, so doubling and halving find how many it takes. `O(log n)` questions.
    #[must_use]
    pub fn slimmed(self, holds: impl Fn(&Self) -> bool) -> Self {
        self.slimmed_to(usize::MAX, holds).unwrap_or_else(|whole| whole)
    }

    /// The same with no more boxes than `most`, none of it taken on trust if it has more itself.
    ///
    /// # Errors
    /// The proof itself if so many of the largest do not hold.
    pub(crate) fn slimmed_to(self, most: usize, holds: impl Fn(&Self) -> bool) -> Result<Self, Self> {
        let count = self.stuck().len();
        if count <= SMALL.min(most) {
            return Ok(self);
        }
        let height = |b: &StuckBox| b.cell.upper[1] - b.cell.lower[1];
        let mut largest: Vec<usize> = (0..count).collect();
        largest.sort_by(|&a, &b| height(&self.stuck()[b]).total_cmp(&height(&self.stuck()[a])).then(a.cmp(&b)));
        let some = |n: usize| {
            let mut chosen = largest[..n].to_vec();
            chosen.sort_unstable();
            Self::new(chosen.into_iter().map(|k| self.stuck()[k].clone()).collect())
        };
        let (mut too_few, mut enough) = (0, SMALL.min(most));
        while enough < count && !holds(&some(enough)) {
            if enough == most {
                return Err(self);
            }
            (too_few, enough) = (enough, (2 * enough).min(most));
        }
        enough = enough.min(count);
        while enough - too_few > enough / CLOSE + 1 {
            let middle = too_few.midpoint(enough);
            *(if holds(&some(middle)) { &mut enough } else { &mut too_few }) = middle;
        }
        Ok(some(enough))
    }
}
