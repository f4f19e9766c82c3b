//! Norms for shortest-path searches, which break ties of travel time.

use super::{Metric, Segment};
use cplan_geometry::{Point, Vector, cross};

/// Weight of the Euclidean length in a sum with travel time. Among paths of equal time, the sum prefers the shortest.
/// The path of least sum may take longer than the fastest one. The extra time is at most this fraction of the path's
/// Euclidean length divided by the higher top speed. The weight is far above the rounding of sums of lengths.
const TIE_BREAK_WEIGHT: f64 = 1e-10;

/// A norm whose unit ball has no flat sides, so that pulling a path taut always shortens it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// Euclidean length of the displacement with its coordinates multiplied by these weights.
    Ellipse([f64; 2]),
    /// The greater of the coordinates' magnitudes multiplied by these weights, plus a small multiple of the
    /// Euclidean length.
    Rectangle([f64; 2]),
}

impl From<Metric> for Measure {
    fn from(metric: Metric) -> Self {
        match metric {
            Metric::Euclidean => Self::Ellipse([1.0; 2]),
            Metric::Weighted { weights } => Self::Ellipse(weights),
            Metric::Time { speeds } => Self::Rectangle(speeds.map(|speed| 1.0 / speed)),
        }
    }
}

impl Measure {
    /// Returns the norm of a displacement.
    pub fn norm(self, d: Vector) -> f64 {
        match self {
            Self::Ellipse([u, v]) => ((u * d.x) * (u * d.x) + (v * d.y) * (v * d.y)).sqrt(),
            Self::Rectangle([u, v]) => {
                (u * d.x.abs()).max(v * d.y.abs()) + TIE_BREAK_WEIGHT * u.min(v) * (d.x * d.x + d.y * d.y).sqrt()
            }
        }
    }

    /// Returns the weight of each coordinate.
    pub fn weights(self) -> [f64; 2] {
        let (Self::Ellipse(weights) | Self::Rectangle(weights)) = self;
        weights
    }

    /// Returns true for [`Measure::Ellipse`], whose balls are ellipses.
    pub fn is_ellipse(self) -> bool {
        matches!(self, Self::Ellipse(_))
    }

    /// Returns a lower bound on the length of paths from `root` to the nearest of the `goals` that cross a segment.
    /// `ends` are the right and left end of that segment as seen from the root.
    ///
    /// The bound is the length of the shortest such path, with one exception: [`Measure::Rectangle`] with goals on the
    /// root's side. The segment may be a point. Therefore `line` has two points farther apart on the segment's line, in
    /// the same direction.
    pub fn bound_through(self, root: Point, ends: [Point; 2], line: [Point; 2], goals: &Segment) -> f64 {
        let along = line[1] - line[0];
        let [from, to] = goals.ends().map(|goal| cross(along, goal - line[0]));
        if from <= 0.0 && to <= 0.0 {
            return self.bound_across(root, ends, goals);
        }
        let beyond =
            goals.where_positive(-from, -to).map_or(f64::INFINITY, |beyond| self.bound_across(root, ends, &beyond));
        let Some(before) = goals.where_positive(from, to) else { return beyond };
        let Self::Ellipse([u, v]) = self else { return beyond.min(before.distance(self, root)) };
        // A path to the line and back is as long as the path to the goal's mirror image.
        let product = |a: Vector, b: Vector| u * u * a.x * b.x + v * v * a.y * b.y;
        let mirrored = |goal: Point| {
            let foot = line[0] + along * (product(goal - line[0], along) / product(along, along));
            foot + (foot - goal)
        };
        let [a, b] = before.ends().map(mirrored);
        beyond.min(self.bound_across(root, ends, &Segment::new(a, b)))
    }

    /// Does the same as [`Measure::bound_through`] if all goals lie beyond the segment.
    ///
    /// The length of a path over a point of the segment's line is a convex function of that point. It is least where
    /// the straight line to the nearest goal crosses the segment's line. If that point is outside of the segment,
    /// the nearest end is optimal.
    fn bound_across(self, root: Point, [right, left]: [Point; 2], goals: &Segment) -> f64 {
        let goal = goals.nearest(self, root) - root;
        let via = |end: Point| self.norm(end - root) + goals.distance(self, end);
        if cross(right - root, goal) < 0.0 {
            via(right)
        } else if cross(left - root, goal) > 0.0 {
            via(left)
        } else {
            self.norm(goal)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the bound with the shortest crossing. A ternary search over the points of the segment finds it,
        /// because the length is a convex function.
        #[test]
        fn bounds_are_the_shortest_crossing(
            root in (-3.0..3.0, 0.1..2.0f64), goal in (-3.0..3.0, -2.0..2.0f64), ends in (-2.0..1.9f64, 0.05..2.0f64),
        ) {
            // The root lies above the axis and looks down through a piece of it.
            let (root, goal) = (Point::new(root.0, root.1), Point::new(goal.0, goal.1));
            let (right, left) = (Point::new(ends.0, 0.0), Point::new(ends.0 + ends.1, 0.0));
            let metrics = [
                Metric::Euclidean,
                Metric::Weighted { weights: [2.0, 0.5] },
                Metric::Time { speeds: [0.7, 2.0] },
            ];
            for metric in metrics {
                let by_way_of = |share: f64| {
                    let p = right + (left - right) * share;
                    metric.norm(p - root) + metric.norm(goal - p)
                };
                let (mut from, mut to) = (0.0, 1.0);
                for _ in 0..100 {
                    let third = (to - from) / 3.0;
                    let shares = [from + third, to - third];
                    if by_way_of(shares[0]) <= by_way_of(shares[1]) { to = shares[1] } else { from = shares[0] }
                }
                let least = by_way_of(from).min(by_way_of(to));
                let bound = Measure::from(metric).bound_through(root, [right, left], [right, left], &Segment::point(goal));
                prop_assert!(bound <= least + 1e-8, "{metric:?}: {bound} > {least}");
                let is_exact = !matches!(metric, Metric::Time { .. }) || goal.y <= 0.0;
                prop_assert!(!is_exact || bound >= least - 1e-5, "{metric:?}: {bound} < {least}");
            }
        }

        /// Compares the bound for a segment of goals with the least bound over many goals on it.
        #[test]
        fn bounds_are_the_shortest_path_to_any_goal(
            root in (-3.0..3.0, 0.1..2.0f64),
            ends in (-2.0..1.9f64, 0.05..2.0f64),
            from in (-3.0..3.0, -2.0..2.0f64),
            to in (-3.0..3.0, -2.0..2.0f64),
            axis in 0..3usize,
        ) {
            let root = Point::new(root.0, root.1);
            let (right, left) = (Point::new(ends.0, 0.0), Point::new(ends.0 + ends.1, 0.0));
            let to = [(to.0, to.1), (from.0, to.1), (to.0, from.1)][axis];
            let goals = Segment::new(Vector::new(from.0, from.1), Vector::new(to.0, to.1));
            for metric in [Metric::Euclidean, Metric::Weighted { weights: [2.0, 0.5] }, Metric::Time { speeds: [0.7, 2.0] }] {
                let measure = Measure::from(metric);
                let each = (0..=400).map(|k| Segment::point(goals.at(f64::from(k) / 400.0)));
                let least = each
                    .map(|goal| measure.bound_through(root, [right, left], [right, left], &goal))
                    .fold(f64::INFINITY, f64::min);
                let bound = measure.bound_through(root, [right, left], [right, left], &goals);
                prop_assert!(bound <= least + 1e-9, "{metric:?}: {bound} > {least}");
                let is_exact = !matches!(metric, Metric::Time { .. });
                prop_assert!(!is_exact || bound >= least - 2e-2, "{metric:?}: {bound} < {least}");
            }
        }
    }
}
