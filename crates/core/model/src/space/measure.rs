//! Norms for shortest-path searches, which break ties of travel time.

use super::{Metric, Segment, SumSpeed};
use cplan_geometry::{Point, Vector, cross};

/// Weight of the Euclidean length in a sum with travel time. Among paths of equal time, the sum prefers the shortest.
/// The path of least sum may take longer than the fastest one. The extra time is at most this fraction of the path's
/// Euclidean length divided by the higher top speed. The weight is far above the rounding of sums of lengths.
const TIE_BREAK_WEIGHT: f64 = 1e-10;

/// A norm whose unit ball has no flat sides, so that pulling a path taut always shortens it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// Euclidean length of the displacement with its coordinates multiplied by these weights. Before that, the second
    /// coordinate is increased by a multiple of the first.
    Ellipse {
        /// Weight of each coordinate.
        weights: [f64; 2],
        /// Multiple of the first coordinate that is added to the second.
        shear: f64,
    },
    /// The greatest of up to three values, plus a small multiple of the Euclidean length. The values are the magnitudes
    /// of both coordinates times their weights, and the magnitude of a weighted sum of both.
    Polygon {
        /// Weight of each coordinate.
        weights: [f64; 2],
        /// Weights of both coordinates in the sum, if there is one.
        sum: Option<[f64; 2]>,
    },
}

impl From<Metric> for Measure {
    fn from(metric: Metric) -> Self {
        match metric {
            Metric::Euclidean => Self::Ellipse { weights: [1.0; 2], shear: 0.0 },
            Metric::Weighted { weights } => Self::Ellipse { weights, shear: 0.0 },
            Metric::Motor { ratio } => Self::Ellipse { weights: [1.0; 2], shear: ratio },
            Metric::Time { speeds, sum } => {
                Self::Polygon { weights: speeds.map(|speed| 1.0 / speed), sum: sum.map(SumSpeed::weights) }
            }
        }
    }
}

impl Measure {
    /// Returns the norm of a displacement.
    pub fn norm(self, d: Vector) -> f64 {
        match self {
            Self::Ellipse { weights: [u, v], shear } => {
                let y = shear * d.x + d.y;
                ((u * d.x) * (u * d.x) + (v * y) * (v * y)).sqrt()
            }
            Self::Polygon { weights: [u, v], sum } => {
                let of_sum = sum.map_or(0.0, |[a, b]| (a * d.x + b * d.y).abs());
                let greatest = (u * d.x.abs()).max(v * d.y.abs()).max(of_sum);
                greatest + TIE_BREAK_WEIGHT * u.min(v) * (d.x * d.x + d.y * d.y).sqrt()
            }
        }
    }

    /// Returns the inner product that belongs to the norm of an ellipse. For a polygon, returns that of its weights
    /// alone.
    pub(super) fn product(self, a: Vector, b: Vector) -> f64 {
        let ([u, v], shear) = match self {
            Self::Ellipse { weights, shear } => (weights, shear),
            Self::Polygon { weights, .. } => (weights, 0.0),
        };
        u * u * a.x * b.x + v * v * (shear * a.x + a.y) * (shear * b.x + b.y)
    }

    /// Returns a lower bound on the norm of all displacements that move the second coordinate by 1.
    pub fn least_of_second(self) -> f64 {
        match self {
            Self::Ellipse { weights: [_, v], shear: 0.0 } => v,
            Self::Ellipse { weights: [u, v], shear } => u * v / u.hypot(v * shear),
            Self::Polygon { weights: [_, v], .. } => v,
        }
    }

    /// Returns a lower bound on the length of paths from `root` to the nearest of the `goals` that cross a segment.
    /// `ends` are the right and left end of that segment as seen from the root.
    ///
    /// The bound is the length of the shortest such path, with one exception: [`Measure::Polygon`] with goals on the
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
        let Self::Ellipse { .. } = self else { return beyond.min(before.distance(self, root)) };
        // A path to the line and back is as long as the path to the goal's mirror image.
        let product = |a: Vector, b: Vector| self.product(a, b);
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

    /// Metrics of all kinds.
    const METRICS: [Metric; 5] = [
        Metric::Euclidean,
        Metric::Weighted { weights: [2.0, 0.5] },
        Metric::Motor { ratio: -1.5 },
        Metric::Time { speeds: [0.7, 2.0], sum: None },
        Metric::Time { speeds: [0.7, 2.0], sum: Some(SumSpeed { ratio: 0.8, speed: 0.9 }) },
    ];

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the nearest configuration of a segment with the best of many.
        #[test]
        fn nearest_configurations_are_the_best_of_many(
            p in (-3.0..3.0, -3.0..3.0f64), from in (-3.0..3.0, -3.0..3.0f64), to in (-3.0..3.0, -3.0..3.0f64),
        ) {
            let [p, from, to] = [p, from, to].map(|(x, y)| Point::new(x, y));
            let segment = Segment::new(from, to);
            for metric in METRICS {
                let best = (0..=2000).map(|k| metric.norm(segment.at(f64::from(k) / 2000.0) - p));
                let (best, found) = (best.fold(f64::INFINITY, f64::min), segment.distance(Measure::from(metric), p));
                prop_assert!(found <= best + 1e-8 && best <= found + 2e-2, "{metric:?}: {found} {best}");
            }
        }

        /// Compares the bound with the shortest crossing. A ternary search over the points of the segment finds it,
        /// because the length is a convex function.
        #[test]
        fn bounds_are_the_shortest_crossing(
            root in (-3.0..3.0, 0.1..2.0f64), goal in (-3.0..3.0, -2.0..2.0f64), ends in (-2.0..1.9f64, 0.05..2.0f64),
        ) {
            // The root lies above the axis and looks down through a piece of it.
            let (root, goal) = (Point::new(root.0, root.1), Point::new(goal.0, goal.1));
            let (right, left) = (Point::new(ends.0, 0.0), Point::new(ends.0 + ends.1, 0.0));
            for metric in METRICS {
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
            for metric in METRICS {
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
