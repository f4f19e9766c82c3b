//! Sets of goals.

use super::{Configuration, Measure, Metric, Segment, Topology};
use serde::{Deserialize, Serialize};

/// A set of alternative goals: single configurations, and straight segments of configurations.
///
/// A tip goal leaves a joint free if the tip is on that joint's axis, or if the target is on the axis of joint 1.
/// Then all values of the joint within its limits are goals, which is a segment. On a circle, copies by whole turns
/// belong to the set.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct GoalSet {
    pieces: Vec<Segment>,
}

impl GoalSet {
    /// Returns the segments of the set; a single configuration is a segment of length 0.
    pub fn pieces(&self) -> &[Segment] {
        &self.pieces
    }

    /// Iterates over the single configurations of the set.
    pub fn points(&self) -> impl Iterator<Item = Configuration> {
        self.pieces.iter().filter(|piece| piece.is_point()).map(|piece| piece.ends()[0])
    }

    /// Returns true if there are no goals.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Iterates over the copies of all segments that overlap the fundamental domain. A segment across a seam has
    /// several.
    pub fn wrapped(&self, topology: &Topology) -> impl Iterator<Item = Segment> {
        self.pieces.iter().flat_map(|piece| piece.wrapped(topology))
    }

    /// Returns the goal nearest to `q`, as its copy nearest to `q`; the first if several are equally near. `None` if
    /// the set is empty.
    pub fn nearest(&self, topology: &Topology, metric: Metric, q: Configuration) -> Option<Configuration> {
        let measure = Measure::from(metric);
        let copies = self.pieces.iter().flat_map(|piece| piece.copies_near(topology, q));
        let places = copies.map(|copy| copy.nearest(measure, q));
        places.reduce(|best, next| if metric.norm(next - q) < metric.norm(best - q) { next } else { best })
    }

    /// Returns the length of the shortest displacement from `q` to a goal; infinite without goals.
    pub fn distance(&self, topology: &Topology, metric: Metric, q: Configuration) -> f64 {
        self.nearest(topology, metric, q).map_or(f64::INFINITY, |goal| metric.norm(goal - q))
    }

    /// Returns true if `q` or a copy of it is within a Euclidean distance of `tolerance` of a goal.
    pub fn contains(&self, topology: &Topology, q: Configuration, tolerance: f64) -> bool {
        self.distance(topology, Metric::Euclidean, q) <= tolerance
    }
}

impl From<Configuration> for GoalSet {
    fn from(q: Configuration) -> Self {
        Self { pieces: vec![Segment::point(q)] }
    }
}

impl From<[f64; 2]> for GoalSet {
    fn from(values: [f64; 2]) -> Self {
        Configuration::from(values).into()
    }
}

impl From<Segment> for GoalSet {
    fn from(piece: Segment) -> Self {
        Self { pieces: vec![piece] }
    }
}

impl<P: Into<Segment>> FromIterator<P> for GoalSet {
    fn from_iter<I: IntoIterator<Item = P>>(pieces: I) -> Self {
        Self { pieces: pieces.into_iter().map(Into::into).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::JointRange;
    use std::f64::consts::{PI, TAU};

    fn at(q1: f64, q2: f64) -> Configuration {
        Configuration::new(q1, q2)
    }

    #[test]
    fn the_nearest_goal_may_be_on_another_turn() {
        let topology = Topology::new([JointRange::Circle, JointRange::Interval { lower: -2.0, upper: 2.0 }]);
        let goals: GoalSet =
            [Segment::new(at(3.0, -2.0), at(3.0, 2.0)), Segment::point(at(0.0, 0.0))].into_iter().collect();
        let nearest = goals.nearest(&topology, Metric::Euclidean, at(-3.0, 0.7)).expect("there are goals");
        assert!((nearest - at(3.0 - TAU, 0.7)).amax() < 1e-15, "{nearest}");
        assert_eq!(goals.nearest(&topology, Metric::Euclidean, at(-3.0 + TAU, 2.5)), Some(at(3.0, 2.0)));
        assert!(goals.contains(&topology, at(3.0 - 3.0 * TAU, -1.0), 1e-9));
        assert!(!goals.contains(&topology, at(2.9, -1.0), 1e-9));
        assert_eq!(GoalSet::default().distance(&topology, Metric::Euclidean, at(0.0, 0.0)), f64::INFINITY);
    }

    #[test]
    fn in_the_domain_a_piece_across_a_seam_is_two() {
        let topology = Topology::new([JointRange::Circle, JointRange::Circle]);
        let wrapped = |from, to| GoalSet::from(Segment::new(from, to)).wrapped(&topology).collect::<Vec<_>>();
        let inside = Segment::new(at(1.0, -PI), at(1.0, PI));
        assert_eq!(wrapped(at(1.0, -PI), at(1.0, PI)), [inside]);
        assert_eq!(wrapped(at(PI, 0.5), at(PI, 1.0)), [Segment::new(at(-PI, 0.5), at(-PI, 1.0))]);
        let across = wrapped(at(3.0, 0.5), at(4.0, 0.5));
        assert_eq!(across[1..], [Segment::new(at(3.0, 0.5), at(4.0, 0.5))]);
        // Whole turns are subtracted with more digits of 2 pi than a double has.
        let [from, to] = across[0].ends();
        assert!((from - at(3.0 - TAU, 0.5)).amax().max((to - at(4.0 - TAU, 0.5)).amax()) < 1e-15, "{across:?}");
    }

    #[test]
    fn a_whole_circle_has_no_ends() {
        let topology = Topology::new([JointRange::Circle; 2]);
        let circle = GoalSet::from(Segment::new(at(-PI, 1.0), at(PI, 1.0)));
        for k in -20..20 {
            let q = at(f64::from(k) * 0.7, 1.25);
            assert!((circle.distance(&topology, Metric::Euclidean, q) - 0.25).abs() < 1e-12, "{q}");
        }
    }
}
