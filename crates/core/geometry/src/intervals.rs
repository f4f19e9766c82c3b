//! Sets of closed intervals on the line.

/// A closed interval `[lower, upper]`, `lower <= upper`; a single point if they are equal.
pub type Interval = [f64; 2];

/// Sorts `intervals` and merges those that touch or overlap, without changing the covered set. In place, `O(n log n)`.
pub fn merge_in_place(intervals: &mut Vec<Interval>) {
    debug_assert!(intervals.iter().all(|[lower, upper]| lower <= upper), "an interval is not ordered");
    intervals.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    intervals.dedup_by(|next, kept| {
        let touch = next[0] <= kept[1];
        if touch {
            kept[1] = kept[1].max(next[1]);
        }
        touch
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_covered(list: &[Interval], x: f64) -> bool {
        list.iter().any(|i| i[0] <= x && x <= i[1])
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(500))]

        /// Tests intervals whose ends are integers. Half-integers then test both the ends and the points between them.
        #[test]
        fn merging_keeps_the_set(list in prop::collection::vec((-10..10i32, 0..4i32), 0..12)) {
            let list: Vec<Interval> = list.into_iter().map(|(lower, n)| [lower.into(), (lower + n).into()]).collect();
            let mut merged = list.clone();
            merge_in_place(&mut merged);
            prop_assert!(merged.windows(2).all(|w| w[0][1] < w[1][0]));
            for half in -24..=30 {
                let x = f64::from(half) / 2.0;
                prop_assert_eq!(is_covered(&merged, x), is_covered(&list, x));
            }
        }
    }

    #[test]
    fn touching_intervals_become_one() {
        let mut set = vec![[1.0, 2.0], [-1.0, 1.0], [2.0, 2.0], [3.0, 4.0]];
        merge_in_place(&mut set);
        assert_eq!(set, [[-1.0, 2.0], [3.0, 4.0]]);
    }
}
