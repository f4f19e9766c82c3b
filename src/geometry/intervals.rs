//! Sets of closed intervals on the line, and of arcs on the circle.

use std::f64::consts::TAU;

/// A closed interval `[lower, upper]`, `lower <= upper`; a single point if they are equal.
pub type Interval = [f64; 2];

/// Makes `intervals` sorted and disjoint without changing the set that it covers.
///
/// The intervals are closed, so those that touch become one. In place, `O(n log n)`.
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

/// Appends to `out` the part of `domain` that sorted disjoint `intervals` leave free: its closure, in order.
///
/// The free set is open where an interval ends; the intervals appended include those ends. Free intervals have
/// positive length: the end of the domain that an interval touches is not one. `O(n)`.
pub fn complement_into(intervals: &[Interval], domain: Interval, out: &mut Vec<Interval>) {
    let mut free_from = domain[0];
    for &[lower, upper] in intervals {
        if lower >= domain[1] {
            break;
        }
        if lower > free_from {
            out.push([free_from, lower]);
        }
        free_from = free_from.max(upper);
    }
    if free_from < domain[1] {
        out.push([free_from, domain[1]]);
    }
}

/// Appends to `out` all copies, shifted by multiples of 2 pi, of the closed arc from `start` counter-clockwise over
/// `length`, cut to `domain`.
///
/// The domain may be `[-pi, pi]` for a full turn, less, or more than a turn. An arc that touches an end of the domain
/// gives that point. An arc of a full turn or more gives the domain. `start` need not be normalised; the copies are
/// rounded to a unit in the last place of `|start| + 2 pi`. `O(1 + width of the domain / 2 pi)`.
pub fn unroll_arc(start: f64, length: f64, domain: Interval, out: &mut Vec<Interval>) {
    debug_assert!(start.is_finite() && length >= 0.0, "not an arc: {length} from {start}");
    debug_assert!(domain[1] - domain[0] < f64::INFINITY, "the domain is not bounded");
    if length >= TAU {
        out.push(domain);
        return;
    }
    // The copies that could reach into the domain, and one more at either end in case of rounding. Their number is
    // fixed beforehand: were `start` so large that adding a turn changes nothing, a search would not end.
    let first = ((domain[0] - start - length) / TAU).ceil() - 1.0;
    let copies = ((domain[1] - domain[0] + length) / TAU).ceil() as usize + 3;
    for copy in 0..copies {
        let lower = start + (first + copy as f64) * TAU;
        let upper = lower + length;
        if lower <= domain[1] && domain[0] <= upper {
            out.push([lower.max(domain[0]), upper.min(domain[1])]);
        }
    }
}

/// A set of points of the line: sorted, pairwise disjoint closed intervals.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Intervals(Vec<Interval>);

impl Intervals {
    /// The union of intervals in any order.
    #[must_use]
    pub fn new(mut intervals: Vec<Interval>) -> Self {
        merge_in_place(&mut intervals);
        Self(intervals)
    }

    /// The union of closed arcs `[start, length]` on the circle, cut to a domain: see [`unroll_arc`].
    #[must_use]
    pub fn from_arcs(arcs: &[[f64; 2]], domain: Interval) -> Self {
        let mut intervals = Vec::with_capacity(arcs.len() + 1);
        for &[start, length] in arcs {
            unroll_arc(start, length, domain, &mut intervals);
        }
        Self::new(intervals)
    }

    /// The intervals, in order.
    #[must_use]
    pub fn as_slice(&self) -> &[Interval] {
        &self.0
    }

    /// Whether the set is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds an interval. `O(log n)` and the cost of moving what follows.
    pub fn insert(&mut self, [lower, upper]: Interval) {
        debug_assert!(lower <= upper, "an interval is not ordered");
        // Those that touch the new one are consecutive.
        let first = self.0.partition_point(|i| i[1] < lower);
        let end = self.0.partition_point(|i| i[0] <= upper);
        let merged = match self.0.get(first..end) {
            Some([only]) => [lower.min(only[0]), upper.max(only[1])],
            Some([left, .., right]) => [lower.min(left[0]), upper.max(right[1])],
            _ => [lower, upper],
        };
        self.0.splice(first..end, [merged]);
    }

    /// The union with another set. `O(n + m)` but for the sort, which finds two sorted runs.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self::new([self.as_slice(), other.as_slice()].concat())
    }

    /// The closure of what the set leaves free of `domain`: see [`complement_into`].
    #[must_use]
    pub fn complement(&self, domain: Interval) -> Self {
        let mut free = Vec::with_capacity(self.0.len() + 1);
        complement_into(&self.0, domain, &mut free);
        Self(free)
    }

    /// Whether the set contains `x`. `O(log n)`.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        let next = self.0.partition_point(|i| i[1] < x);
        self.0.get(next).is_some_and(|i| i[0] <= x)
    }

    /// Total length.
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.0.iter().map(|[lower, upper]| upper - lower).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Intervals with integer ends; half-integers then test membership of their ends and of what lies between.
    fn list() -> impl Strategy<Value = Vec<Interval>> {
        let interval = (-10..10i32, 0..4i32).prop_map(|(lower, length)| [lower.into(), (lower + length).into()]);
        prop::collection::vec(interval, 0..12)
    }

    fn covered(list: &[Interval], x: f64) -> bool {
        list.iter().any(|i| i[0] <= x && x <= i[1])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn sets_agree_with_membership(first in list(), second in list()) {
            let (a, b) = (Intervals::new(first.clone()), Intervals::new(second.clone()));
            let mut inserted = Intervals::default();
            first.iter().for_each(|&i| inserted.insert(i));
            prop_assert_eq!(&inserted, &a);
            prop_assert!(a.as_slice().windows(2).all(|w| w[0][1] < w[1][0]));
            let union = a.union(&b);
            let domain = [-7.0, 6.0];
            let free = a.complement(domain);
            prop_assert!(free.as_slice().iter().all(|i| i[0] < i[1]));
            for half in -24..=24 {
                let x = f64::from(half) / 2.0;
                prop_assert_eq!(a.contains(x), covered(&first, x));
                prop_assert_eq!(union.contains(x), covered(&first, x) || covered(&second, x));
                // Half-integers are not ends, so there the closure is the complement itself.
                if half % 2 != 0 {
                    prop_assert_eq!(free.contains(x), domain[0] <= x && x <= domain[1] && !covered(&first, x));
                }
            }
            // Ends are integers: the measure is a number of unit cells.
            let cells = (-24..24).filter(|&k| k % 2 != 0 && covered(&first, f64::from(k) / 2.0)).count();
            prop_assert_eq!(a.measure(), cells as f64);
        }

        #[test]
        fn arcs_agree_with_angles(
            arcs in prop::collection::vec((-20.0..20.0f64, 0.0..7.0f64), 0..4),
            lower in -10.0..0.0f64,
            width in 0.1..20.0f64,
            at in 0.0..1.0f64,
        ) {
            let arcs: Vec<[f64; 2]> = arcs.into_iter().map(|(start, length)| [start, length]).collect();
            let set = Intervals::from_arcs(&arcs, [lower, lower + width]);
            prop_assert!(set.as_slice().iter().all(|i| lower <= i[0] && i[1] <= lower + width));
            let x = lower + at * width;
            let inside = |&[start, length]: &[f64; 2]| (x - start).rem_euclid(TAU) <= length;
            prop_assert_eq!(set.contains(x), arcs.iter().any(inside));
        }
    }

    #[test]
    fn touching_intervals_become_one() {
        let set = Intervals::new(vec![[1.0, 2.0], [-1.0, 1.0], [2.0, 2.0], [3.0, 4.0]]);
        assert_eq!(set.as_slice(), [[-1.0, 2.0], [3.0, 4.0]]);
        assert_eq!(set.complement([-1.0, 4.0]).as_slice(), [[2.0, 3.0]]);
        assert!(set.contains(2.0) && !set.contains(2.5) && !Intervals::default().contains(0.0));
    }

    #[test]
    fn arcs_meet_across_the_cut_and_repeat_on_a_wide_axis() {
        let turn = [-PI, PI];
        assert_eq!(Intervals::from_arcs(&[[PI - 0.5, 1.0]], turn).as_slice().len(), 2);
        // An arc that ends at the cut touches it from the other side as well.
        assert_eq!(Intervals::from_arcs(&[[0.0, PI]], turn).as_slice(), [[-PI, -PI], [0.0, PI]]);
        assert_eq!(Intervals::from_arcs(&[[1.0, TAU]], turn).as_slice(), [turn]);
        assert_eq!(Intervals::from_arcs(&[[0.25, 0.5]], [-3.0 * PI, 3.0 * PI]).as_slice().len(), 3);
        assert!(Intervals::from_arcs(&[[2.0, 0.5]], [0.0, 1.0]).is_empty());
    }
}
