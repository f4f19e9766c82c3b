//! Walls and their ends in the plane of a metric.

use crate::certificate::Metric;
use crate::decimal::Decimal;
use crate::domain::Rectangle;
use crate::interval::{BITS, Interval, Point};
use num_bigint::{BigInt, Sign};
use std::collections::BTreeMap;

/// A place in the plane of the metric. Its coordinates are scaled so that Euclidean distances, or greatest differences
/// of coordinates, are lengths in the metric.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) at: Point,
    /// Lower and upper bound on each coordinate, in coarse units, rounded outward.
    pub(super) coarse: [[i64; 2]; 2],
    /// Value of joint 1 as written in the certificate, and the number of whole turns added to it. `None` if the place
    /// has several values of joint 1.
    pub(super) line: Option<Line>,
}

/// A line of configurations with the same value of joint 1: the value as written, and the whole turns added to it.
pub(super) type Line = (Decimal, i64);

/// Limit on the distance of places from the origin, in coarse units. It keeps products of differences exact in 128
/// bits.
pub(super) const MAX_COORDINATE: i64 = 1 << 58;

/// Binary logarithm of the ratio of coarse units, `2^-40`, to the units of [`Interval`].
pub(super) const COARSE_SHIFT: u32 = BITS - 40;

/// A copy of a wall, shifted by whole turns of each joint.
pub(super) struct WallCopy {
    pub(super) wall: usize,
    pub(super) turns: [i64; 2],
    pub(super) ends: [Place; 2],
}

/// Overlapping walls on one line, merged into one. `ends` are its ends along joint 2. `beside` has the places where
/// ends of other walls touch it: from smaller values of joint 1, and from greater ones.
pub(super) struct WallRun {
    pub(super) ends: [Interval; 2],
    pub(super) beside: [Vec<Interval>; 2],
}

/// Merges walls with a constant value of joint 1 into runs. Collects the ends of other walls that lie on each run.
pub(super) fn runs(copies: &[WallCopy]) -> BTreeMap<Line, Vec<WallRun>> {
    let mut runs: BTreeMap<Line, Vec<WallRun>> = BTreeMap::new();
    for WallCopy { ends: [a, b], .. } in copies {
        if let (Some(line), true) = (&a.line, a.line == b.line) {
            let mut ends = [a.at[1].clone(), b.at[1].clone()];
            if ends[1].lower < ends[0].lower {
                ends.reverse();
            }
            runs.entry(line.clone()).or_default().push(WallRun { ends, beside: [vec![], vec![]] });
        }
    }
    for list in runs.values_mut() {
        list.sort_by(|a, b| a.ends[0].lower.cmp(&b.ends[0].lower));
        let mut merged: Vec<WallRun> = Vec::new();
        for run in list.drain(..) {
            match merged.last_mut() {
                Some(last) if is_less(&run.ends[0], &last.ends[1]) => {
                    if last.ends[1].lower < run.ends[1].lower {
                        last.ends[1] = run.ends[1].clone();
                    }
                }
                _ => merged.push(run),
            }
        }
        *list = merged;
    }
    for WallCopy { ends: [a, b], .. } in copies {
        for (end, other) in [(a, b), (b, a)] {
            let side = match (is_less(&other.at[0], &end.at[0]), is_less(&end.at[0], &other.at[0])) {
                (true, _) => 0,
                (_, true) => 1,
                _ => continue,
            };
            let list = end.line.as_ref().and_then(|line| runs.get_mut(line));
            let is_within = |run: &&mut WallRun| is_less(&run.ends[0], &end.at[1]) && is_less(&end.at[1], &run.ends[1]);
            if let Some(run) = list.and_then(|list| list.iter_mut().find(is_within)) {
                run.beside[side].push(end.at[1].clone());
            }
        }
    }
    runs
}

impl Place {
    /// Copies a rectangle, shifted by whole turns. Returns `None` if the copy is too far away, see [`MAX_COORDINATE`].
    pub(super) fn new(metric: &Metric, rectangle: &Rectangle, turns: [i64; 2]) -> Option<Self> {
        let at = [0, 1].map(|k| {
            let turns = Interval::exact(BigInt::from(2 * turns[k]) << BITS);
            metric.scaled(k, &(&Interval::enclosing(&rectangle[k]) + &(Interval::pi() * &turns)))
        });
        let coarse = |n: BigInt| i64::try_from(n).ok().filter(|n| n.abs() < MAX_COORDINATE);
        let both = at
            .each_ref()
            .map(|value| Some([coarse(&value.lower >> COARSE_SHIFT)?, coarse((&value.upper >> COARSE_SHIFT) + 1)?]));
        let [first, second] = both;
        let line = (rectangle[0][0] == rectangle[0][1]).then(|| (rectangle[0][0].clone(), turns[0]));
        Some(Self { at, coarse: [first?, second?], line })
    }

    /// Returns the side of the line from `a` to `b` on which this place certainly lies: 1 for left, -1 for right, 0 if
    /// uncertain.
    pub(super) fn side(&self, a: &Self, b: &Self) -> i8 {
        // Coarse middles are off by less than two units, and so their differences by less than four.
        let middle = |place: &Self| place.coarse.map(|[low, high]| (low + high) / 2);
        let wide = |place: &Self| place.coarse.iter().any(|[low, high]| high - low > 2);
        let ([ax, ay], [bx, by], [px, py]) = (middle(a), middle(b), middle(self));
        let (ux, uy, vx, vy) = (bx - ax, by - ay, px - ax, py - ay);
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        let area = product(ux, vy) - product(uy, vx);
        let error = product(8, ux.abs() + uy.abs() + vx.abs() + vy.abs() + 8);
        if area.abs() > error && ![a, b, self].into_iter().any(wide) {
            return if area > 0 { 1 } else { -1 };
        }
        if self.coarse == a.coarse && self.at == a.at || self.coarse == b.coarse && self.at == b.at {
            return 0;
        }
        let (a, b, p) = (&a.at, &b.at, &self.at);
        let area = &(&(&b[0] - &a[0]) * &(&p[1] - &a[1])) - &(&(&b[1] - &a[1]) * &(&p[0] - &a[0]));
        match (area.lower.sign(), area.upper.sign()) {
            (Sign::Plus, _) => 1,
            (_, Sign::Minus) => -1,
            _ => 0,
        }
    }

    /// Returns true if this place and `other` certainly lie on opposite sides of the line through `a` and `b`.
    pub(super) fn is_opposite(&self, other: &Self, a: &Self, b: &Self) -> bool {
        let side = self.side(a, b);
        side != 0 && other.side(a, b) == -side
    }
}

impl WallCopy {
    /// Returns the wall's least value of joint 1, in coarse units.
    pub(super) fn begins(&self) -> i64 {
        self.ends[0].coarse[0][0].min(self.ends[1].coarse[0][0])
    }

    /// Returns the wall's greatest value of joint 1, in coarse units.
    pub(super) fn stops(&self) -> i64 {
        self.ends[0].coarse[0][1].max(self.ends[1].coarse[0][1])
    }

    /// Returns true if every straight leg from `from` to any point of `to` crosses this wall between its ends.
    pub(super) fn crosses(&self, from: &Place, to: &Place) -> bool {
        let [a, b] = &self.ends;
        let are_apart = |k: usize| {
            let ends = |place: &Place| place.coarse[k];
            ends(a)[0].min(ends(b)[0]) > ends(from)[1].max(ends(to)[1])
                || ends(a)[1].max(ends(b)[1]) < ends(from)[0].min(ends(to)[0])
        };
        !are_apart(0) && !are_apart(1) && from.is_opposite(to, a, b) && a.is_opposite(b, from, to)
    }
}

/// Returns true if `a` is certainly less than `b`.
pub(super) fn is_less(a: &Interval, b: &Interval) -> bool {
    a.upper < b.lower
}
