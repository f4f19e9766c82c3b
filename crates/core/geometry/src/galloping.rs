//! Galloping search for the last number that satisfies a condition.

/// Returns the greatest number from `first` to `last` for which `holds` is true. Assumes this for `first` without a call.
///
/// Doubles the step, then bisects. If the answer is `first + n`, this calls `holds` about `2 log2(n)` times, and for no
/// number beyond `first + 2 n + 1`. If `holds` is not monotone, returns some number for which it is true and for whose
/// successor it is false.
pub fn farthest(first: usize, last: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut good, mut step) = (first, 1);
    while good + step <= last && holds(good + step) {
        good += step;
        step *= 2;
    }
    // The condition fails for this number, or the range ends before it.
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
        fn the_search_finds_the_last_number_for_which_the_condition_holds(first in 0..50_usize, beyond in 0..300_usize, on in 0..400_usize) {
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

        /// Tests a condition that is true on several stretches. The search then returns the end of one of them.
        #[test]
        fn the_search_ends_where_the_condition_does_not_hold(holding in proptest::collection::vec(any::<bool>(), 0..60)) {
            let last = holding.len();
            let found = farthest(0, last, |n| holding[n - 1]);
            prop_assert!(found == 0 || holding[found - 1]);
            prop_assert!(found == last || !holding[found]);
        }
    }
}
