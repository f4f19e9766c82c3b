//! Checks whether collision boxes separate a start from a goal.

use crate::decimal::Decimal;
use crate::domain::{Domain, Range, Rectangle};
use std::collections::BTreeSet;

/// Maximum number of gaps between boxes. They need several hundred megabytes of memory.
const MAX_GAPS: usize = 1 << 22;

/// Maximum number of strips within the enclosure of a seam. Each one is compared with each strip at the other end.
const MAX_SEAM_STRIPS: usize = 100;

/// The part of the domain outside the boxes. The domain is cut into strips at each value of joint 1 where a box begins
/// or ends. In each strip, the *gaps* are the intervals of joint 2 that no box covers.
struct Gaps {
    /// The strips between consecutive values of joint 1, ascending.
    strips: Vec<Strip>,
    /// For each gap, a gap that represents its group of connected gaps, or a gap on the path to the representative (union-find).
    group: Vec<usize>,
    /// For each joint, the values at which boxes or the domain begin or end, ascending.
    values: [Vec<Decimal>; 2],
}

/// The gaps within one strip. Each gap is given by the indices of its ends in the values of joint 2. `first` is the
/// index of the first gap.
struct Strip {
    first: usize,
    gaps: Vec<[usize; 2]>,
}

impl Gaps {
    fn new(domain: &Domain, boxes: &[Rectangle]) -> Option<Self> {
        let clipped: Vec<Rectangle> = boxes.iter().filter_map(|b| clipped(b, &domain.ranges)).collect();
        let values = [0, 1].map(|k| {
            let ends = clipped.iter().map(|b| &b[k]).chain([&domain.ranges[k]]).flatten();
            let mut values: Vec<Decimal> = ends.cloned().collect();
            values.sort();
            values.dedup();
            values
        });
        let rank = |k: usize, value: &Decimal| values[k].partition_point(|v| v < value);
        let mut ranked: Vec<[[usize; 2]; 2]> =
            clipped.iter().map(|b| [0, 1].map(|k| [rank(k, &b[k][0]), rank(k, &b[k][1])])).collect();
        ranked.sort_unstable();
        let mut waiting = ranked.into_iter().peekable();
        let mut active: Vec<[[usize; 2]; 2]> = Vec::new();
        let (mut strips, mut count) = (Vec::new(), 0);
        for left in 0..values[0].len() - 1 {
            active.retain(|[[_, right], _]| *right > left);
            while let Some(next) = waiting.next_if(|[[from, _], _]| *from <= left) {
                active.extend((next[0][1] > left).then_some(next));
            }
            active.sort_unstable_by_key(|[_, side]| *side);
            let (mut gaps, mut from) = (Vec::new(), 0);
            for [_, [low, high]] in &active {
                gaps.extend((*low > from).then_some([from, *low]));
                from = from.max(*high);
            }
            let top = values[1].len() - 1;
            gaps.extend((from < top).then_some([from, top]));
            strips.push(Strip { first: count, gaps });
            count += strips[left].gaps.len();
            if count > MAX_GAPS {
                return None;
            }
        }
        let mut gaps = Self { strips, group: (0..count).collect(), values };
        if domain.seams[0].iter().flatten().any(|seam| gaps.strips_that_meet(seam).len() > MAX_SEAM_STRIPS) {
            return None;
        }
        gaps.join(domain);
        Some(gaps)
    }

    /// Joins gaps that a free motion may connect: overlapping gaps of neighbouring strips, and gaps on both sides of a
    /// seam that reach the seam's enclosures.
    fn join(&mut self, domain: &Domain) {
        for right in 1..self.strips.len() {
            self.join_strips(right - 1, right);
        }
        if let Some([low, high]) = &domain.seams[0] {
            for a in self.strips_that_meet(low) {
                for b in self.strips_that_meet(high) {
                    self.join_strips(a, b);
                }
            }
        }
        if let Some([[_, low], [high, _]]) = &domain.seams[1] {
            let values = &self.values[1];
            let (below, above) = (values.partition_point(|v| v <= low), values.partition_point(|v| v < high));
            for strip in 0..self.strips.len() {
                let Strip { first, gaps } = &self.strips[strip];
                let bottom = gaps.iter().filter(|[from, _]| *from < below).count();
                let top = gaps.iter().filter(|[_, to]| *to >= above).count();
                // Join each of the lowest gaps with each of the highest.
                if bottom > 0 && top > 0 {
                    let all = (*first..first + bottom).chain(first + gaps.len() - top..first + gaps.len());
                    all.collect::<Vec<_>>().windows(2).for_each(|pair| self.unite(pair[0], pair[1]));
                }
            }
        }
        for gap in 0..self.group.len() {
            self.group[gap] = self.representative(gap);
        }
    }

    fn join_strips(&mut self, a: usize, b: usize) {
        let (mut i, mut j) = (0, 0);
        while let (Some(&[low_a, high_a]), Some(&[low_b, high_b])) =
            (self.strips[a].gaps.get(i), self.strips[b].gaps.get(j))
        {
            if low_a.max(low_b) < high_a.min(high_b) {
                self.unite(self.strips[a].first + i, self.strips[b].first + j);
            }
            if high_a < high_b { i += 1 } else { j += 1 }
        }
    }

    /// Returns the indices of the strips that meet a range of joint 1, borders included.
    fn strips_that_meet(&self, [low, high]: &Range) -> std::ops::Range<usize> {
        let values = &self.values[0];
        let from = values.partition_point(|v| v < low).saturating_sub(1);
        from..values.partition_point(|v| v <= high).min(self.strips.len())
    }

    fn representative(&mut self, mut gap: usize) -> usize {
        while self.group[gap] != gap {
            self.group[gap] = self.group[self.group[gap]];
            gap = self.group[gap];
        }
        gap
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.representative(a), self.representative(b));
        self.group[a.max(b)] = a.min(b);
    }

    /// Returns the groups with a gap that meets a rectangle, borders included.
    fn groups_that_meet(&self, [first, [low, high]]: &Rectangle) -> impl Iterator<Item = usize> {
        let values = &self.values[1];
        let (low, high) = (values.partition_point(|v| v < low), values.partition_point(|v| v <= high));
        self.strips_that_meet(first).flat_map(move |s| {
            let Strip { first, gaps } = &self.strips[s];
            let below = gaps.partition_point(|[_, to]| *to < low);
            let meet = gaps[below..].iter().take_while(move |[from, _]| *from < high).count();
            (first + below..first + below + meet).map(|gap| self.group[gap])
        })
    }
}

/// Returns the part of a box within the domain. Returns `None` if that part has no interior.
fn clipped(stuck: &Rectangle, domain: &[Range; 2]) -> Option<Rectangle> {
    let part = [0, 1].map(|k| [(&stuck[k][0]).max(&domain[k][0]).clone(), (&stuck[k][1]).min(&domain[k][1]).clone()]);
    part.iter().all(|[low, high]| low < high).then_some(part)
}

/// All gaps that a free motion from the start may reach.
pub struct Reached {
    gaps: Gaps,
    groups: BTreeSet<usize>,
}

impl Reached {
    /// Computes the gaps that free motions from `start` may reach. `None` if there are more gaps than the checker can handle.
    pub fn new(domain: &Domain, boxes: &[Rectangle], start: &Rectangle) -> Option<Self> {
        let gaps = Gaps::new(domain, boxes)?;
        let groups = gaps.groups_that_meet(start).collect();
        Some(Self { gaps, groups })
    }

    /// Returns true if a reachable gap meets a rectangle of the domain, borders included.
    pub fn meets(&self, rectangle: &Rectangle) -> bool {
        self.gaps.groups_that_meet(rectangle).any(|group| self.groups.contains(&group))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Axis;

    fn number(text: &str) -> Decimal {
        text.parse().unwrap()
    }

    fn range(low: &str, high: &str) -> Range {
        [number(low), number(high)]
    }

    fn point(x: &str, y: &str) -> Rectangle {
        [range(x, x), range(y, y)]
    }

    fn boxes(list: &[[&str; 4]]) -> Vec<Rectangle> {
        list.iter().map(|[l, r, b, t]| [range(l, r), range(b, t)]).collect()
    }

    fn separates(axes: [Axis; 2], list: &[[&str; 4]]) -> bool {
        let (start, goal) = (point("-1", "0.5"), point("1", "0.5"));
        !Reached::new(&Domain::new(axes.each_ref()), &boxes(list), &start).unwrap().meets(&goal)
    }

    fn line() -> Axis {
        Axis::Line(range("-2", "2.1"))
    }

    #[test]
    fn a_wall_separates_and_a_slit_does_not() {
        assert!(!separates([line(), line()], &[]));
        assert!(separates([line(), line()], &[["0", "0.1", "-2", "2.1"]]));
        assert!(separates([line(), line()], &[["0", "0.1", "-5", "0.3"], ["0.05", "0.2", "0.3", "9"]]));
        for slit in ["0.3000000000000000000000000000000001", "0.31"] {
            assert!(!separates([line(), line()], &[["0", "0.1", "-5", "0.3"], ["0.05", "0.2", slit, "9"]]), "{slit}");
        }
        // Adjacent boxes close the gap, even if their common end is written differently.
        assert!(separates([line(), line()], &[["0", "0.10", "-5", "0.3"], ["1e-1", "0.2", "0.3", "9"]]));
        assert!(!separates([line(), line()], &[["0", "0.1", "-5", "0.3"], ["0.1000000001", "0.2", "0.3", "9"]]));
        // A wall does not separate if it ends just before the limit, has no thickness, or has swapped ends.
        assert!(!separates([line(), line()], &[["0", "0.1", "-2", "2.0999999999999999999"]]));
        assert!(!separates([line(), line()], &[["0", "0", "-2", "2.1"]]));
        assert!(!separates([line(), line()], &[["0.1", "0", "-2", "2.1"]]));
        // Boxes around the goal.
        let ring =
            [["0", "0.2", "-1", "1"], ["1.5", "1.6", "-1", "1"], ["0", "1.6", "-1", "0"], ["0", "1.6", "0.9", "1"]];
        assert!(separates([line(), line()], &ring));
        assert!((0..4).all(|gone| {
            let rest: Vec<_> = (0..4).filter(|k| *k != gone).map(|k| ring[k]).collect();
            !separates([line(), line()], &rest)
        }));
    }

    #[test]
    fn a_circle_goes_on_across_its_seam() {
        let wall = ["0", "0.1", "-4", "4"];
        let other = ["3", "3.1", "-4", "4"];
        for second in [line(), Axis::Circle] {
            assert!(!separates([Axis::Circle, second.clone()], &[wall]));
            assert!(separates([Axis::Circle, second], &[wall, other]));
        }
        // Joint 2 is continuous, so a free motion can avoid a lid by crossing the seam.
        let roofed = [["-9", "9", "0.7", "0.8"], ["0", "0.1", "-4", "0.75"]];
        assert!(separates([line(), line()], &roofed));
        let short = [["-9", "9", "0.7", "0.8"], ["0", "0.1", "-3.1", "0.75"]];
        assert!(!separates([line(), Axis::Circle], &short));
        // A wall that ends at the double nearest to pi leaves a slit. One that ends beyond pi leaves none.
        let up_to = |pi| separates([line(), Axis::Circle], &[["0", "0.1", "-3.2", pi]]);
        assert!(!up_to("3.141592653589793") && up_to("3.1415926535897936"));
    }
}
