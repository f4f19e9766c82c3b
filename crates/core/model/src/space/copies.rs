//! Copies of segments by whole turns.

use super::{Configuration, JointRange, Segment, Topology};
use std::f64::consts::TAU;

impl Segment {
    /// Returns the segment moved by whole turns: `turns` has the number of turns of each joint.
    #[must_use]
    pub fn turned(&self, turns: [f64; 2]) -> Self {
        let [from, to] = self.ends().map(|q| Configuration::from_fn(|k, _| JointRange::Circle.turned(q[k], turns[k])));
        Self::new(from, to)
    }

    /// Returns the copies of the segment that overlap the fundamental domain. They are not cut at the domain's ends. A
    /// segment across a seam has several copies.
    pub fn wrapped(&self, topology: &Topology) -> impl Iterator<Item = Self> + use<> {
        let [from, to] = self.ends();
        let [first, second] = [0, 1].map(|k| into_domain(topology.ranges[k], [from[k], to[k]]));
        first.into_iter().flat_map(move |a| {
            let ends = move |b: [f64; 2]| [0, 1].map(|end| Configuration::new(a[end], b[end]));
            second.clone().into_iter().map(ends).map(|[from, to]| Self::new(from, to))
        })
    }

    /// Returns the segment as parts within the fundamental domain: at a seam it is cut, and the parts are copies.
    /// Exact except for the ends at a cut. A segment within the domain is returned unchanged.
    pub fn within_domain(&self, topology: &Topology) -> impl Iterator<Item = Self> + use<> {
        // An interval needs no copies, and goals beyond its limits must not be cut off.
        let bounds = topology
            .ranges
            .map(|axis| if axis.is_circle() { axis.domain() } else { (f64::NEG_INFINITY, f64::INFINITY) });
        let [lower, upper] = [bounds.map(|b| b.0), bounds.map(|b| b.1)];
        self.wrapped(topology).filter_map(move |copy| copy.within(lower, upper))
    }

    /// Returns the copies of the segment that may be nearest to `q`. On a circle these are the copy whose middle is
    /// nearest to `q`, and the copies one turn below and above it.
    pub fn copies_near(&self, topology: &Topology, q: Configuration) -> impl Iterator<Item = Self> + use<> {
        let middle = self.at(0.5);
        let turns = [0, 1].map(|k| {
            let turns = if topology.ranges[k].is_circle() { ((q[k] - middle[k]) / TAU).round() } else { 0.0 };
            let around = if topology.ranges[k].is_circle() { -1..=1 } else { 0..=0 };
            around.map(move |more| turns + f64::from(more))
        });
        let [first, second] = turns;
        let piece = *self;
        first.flat_map(move |first| second.clone().map(move |second| piece.turned([first, second])))
    }
}

/// Returns the copies of a range of values that overlap the domain of an axis.
fn into_domain(axis: JointRange, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let (lower, upper) = axis.domain();
    match axis {
        JointRange::Interval { .. } => vec![[from, to]],
        JointRange::Circle if from == to => vec![[axis.wrap(from); 2]],
        JointRange::Circle => {
            // The first copy is the lowest whose greatest value is above `lower`; the last is the highest whose
            // least value is below `upper`.
            let first = ((lower - from.max(to)) / TAU).floor() as i64 + 1;
            let last = ((upper - from.min(to)) / TAU).ceil() as i64 - 1;
            (first..=last).map(|turns| [from, to].map(|value| axis.turned(value, turns as f64))).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const TORUS: Topology = Topology::new([JointRange::Circle; 2]);

    fn at(q1: f64, q2: f64) -> Configuration {
        Configuration::new(q1, q2)
    }

    #[test]
    fn within_the_domain_a_segment_across_a_seam_is_cut() {
        let cut = |from, to| Segment::new(from, to).within_domain(&TORUS).collect::<Vec<_>>();
        for inside in [Segment::new(at(1.0, -PI), at(1.0, PI)), Segment::new(at(-PI, 0.2), at(PI, -0.3))] {
            let [from, to] = inside.ends();
            assert_eq!(cut(from, to), [inside]);
        }
        let parts = cut(at(4.0, 0.5), at(3.0, 0.5));
        let expected = [Segment::new(at(4.0 - TAU, 0.5), at(-PI, 0.5)), Segment::new(at(PI, 0.5), at(3.0, 0.5))];
        assert_eq!(parts.len(), 2, "{parts:?}");
        for (part, expected) in parts.iter().zip(expected) {
            let apart = [0, 1].map(|k| (part.ends()[k] - expected.ends()[k]).amax());
            assert!(apart.iter().all(|apart| *apart < 1e-15), "{part:?} {expected:?}");
        }
        // Across both seams, one after the other: three parts.
        let parts = cut(at(3.0, 3.1), at(3.5, 3.6));
        let length: f64 = parts.iter().map(Segment::length).sum();
        assert_eq!(parts.len(), 3, "{parts:?}");
        assert!((length - 0.5_f64.hypot(0.5)).abs() < 1e-12, "{length}");
        // A segment of a whole circle or more keeps its length.
        let parts = cut(at(-4.0, 1.0), at(4.0, 1.0));
        assert!((parts.iter().map(Segment::length).sum::<f64>() - 8.0).abs() < 1e-12, "{parts:?}");
        // On an interval nothing is cut off.
        let strip = Topology::new([JointRange::Interval { lower: -1.0, upper: 1.0 }, JointRange::Circle]);
        let far = Segment::new(at(-9.0, 1.0), at(9.0, 1.0));
        assert_eq!(far.within_domain(&strip).collect::<Vec<_>>(), [far]);
    }
}
