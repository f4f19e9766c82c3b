//! How far something holds.

/// The greatest number up to `last` for which `holds`, by doubling steps from `first`, for which it is taken to hold, and halving
/// what is left: asked some `2 log2(n)` times where the answer is `first + n`, and of no number beyond `first + 2 n + 1`.
///
/// Where it holds for some that are greater than one for which it does not, the answer is one for which it holds while it does
/// not for the next.
pub fn farthest(first: usize, last: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut good, mut step) = (first, 1);
    while good + step <= last && holds(good + step) {
        good += step;
        step *= 2;
    }
    // There it does not hold, or there is nothing.
    let mut bad = (good + step).min(last + 1);
    while bad - good > 1 {
        let middle = good.midpoint(bad);
        *(if holds(middle) { &mut good } else { &mut bad }) = middle;
    }
    good
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::cell::Cell;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn finds_how_far_it_holds(first in 0..50_usize, beyond in 0..300_usize, on in 0..400_usize) {
            let (last, end) = (first + beyond, first + on);
            let (asked, greatest) = (Cell::new(0_u32), Cell::new(first));
            let holds = |n: usize| {
                assert!((first + 1..=last).contains(&n), "{n} is not between {first} and {last}");
                asked.set(asked.get() + 1);
                greatest.set(greatest.get().max(n));
                n <= end
            };
            let found = farthest(first, last, holds);
            prop_assert_eq!(found, end.min(last));
            prop_assert!(asked.get() <= 2 * (found - first + 1).ilog2() + 2, "{} questions", asked.get());
            prop_assert!(greatest.get() <= first + 2 * (found - first) + 1);
        }

        /// Of a condition that holds here and there: an end of a stretch where it holds.
        #[test]
        fn ends_where_it_does_not_hold(holding in proptest::collection::vec(any::<bool>(), 0..60)) {
            let last = holding.len();
            let found = farthest(0, last, |n| holding[n - 1]);
            prop_assert!(found == 0 || holding[found - 1]);
            prop_assert!(found == last || !holding[found]);
        }
    }
}
