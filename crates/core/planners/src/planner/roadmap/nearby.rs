//! An index that finds the points nearest to a place.

use cplan_geometry::planar::starts;
use cplan_geometry::{OrderedF64, Point};

/// Points sorted into square buckets.
#[derive(Debug, Clone)]
pub struct Nearby {
    points: Vec<Point>,
    lower: Point,
    /// Side of a bucket.
    side: f64,
    /// Number of buckets along each axis.
    shape: [usize; 2],
    /// The points of bucket `k` are `order[first[k]..first[k + 1]]`.
    first: Vec<u32>,
    order: Vec<usize>,
}

/// Average number of points per bucket. With this value, queries compute few distances and visit few empty buckets.
const POINTS_PER_BUCKET: f64 = 2.0;

impl Nearby {
    /// Sorts points into buckets. `O(n)` for `n` points.
    pub fn new(points: Vec<Point>) -> Self {
        let infinite = Point::new(f64::INFINITY, f64::INFINITY);
        let lower = points.iter().fold(infinite, |least, p| least.inf(p));
        let upper = points.iter().fold(-infinite, |most, p| most.sup(p));
        let extent = if points.is_empty() { [0.0; 2] } else { [upper.x - lower.x, upper.y - lower.y] };
        // The side is chosen so that there are at most as many buckets as points, also for points in a slender box.
        let share = POINTS_PER_BUCKET / points.len().max(1) as f64;
        let side = (extent[0] * extent[1] * share).sqrt().max(extent[0].max(extent[1]) * share);
        let side = if side > 0.0 { side } else { 1.0 };
        let shape = extent.map(|extent| (extent / side) as usize + 1);
        let mut nearby = Self { points, lower, side, shape, first: Vec::new(), order: Vec::new() };
        let bucket = |p: &Point| {
            let [i, j] = nearby.place(*p);
            i * nearby.shape[1] + j
        };
        let buckets: Vec<usize> = nearby.points.iter().map(bucket).collect();
        nearby.first = starts(shape[0] * shape[1], buckets.iter().copied());
        nearby.order = (0..buckets.len()).collect();
        nearby.order.sort_by_key(|&point| buckets[point]);
        nearby
    }

    /// Returns the points in their original order.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Returns the row and column of the bucket that contains a point, or of the nearest bucket.
    fn place(&self, p: Point) -> [usize; 2] {
        // Casts from floats saturate: the result is 0 to the left of all buckets.
        [0, 1].map(|k| (((p[k] - self.lower[k]) / self.side) as usize).min(self.shape[k] - 1))
    }

    /// Returns the `count` points nearest to `p`, nearest first. Equally near points have their original order. About
    /// `O(count)` if points are spread evenly.
    pub fn nearest(&self, p: Point, count: usize) -> Vec<usize> {
        let mut found: Vec<(OrderedF64, usize)> = Vec::new();
        let home = self.place(p);
        // Points outside the first `n` rings of buckets around the home bucket are at least `n` sides away, or more if
        // `p` is outside all buckets.
        for ring in 0..self.shape[0].max(self.shape[1]) {
            for i in home[0].saturating_sub(ring)..=(home[0] + ring).min(self.shape[0] - 1) {
                for j in home[1].saturating_sub(ring)..=(home[1] + ring).min(self.shape[1] - 1) {
                    if i.abs_diff(home[0]).max(j.abs_diff(home[1])) == ring {
                        let bucket = i * self.shape[1] + j;
                        let points = &self.order[self.first[bucket] as usize..self.first[bucket + 1] as usize];
                        found.extend(points.iter().map(|&k| (OrderedF64((self.points[k] - p).norm()), k)));
                    }
                }
            }
            found.sort_unstable();
            found.truncate(count);
            if found.len() == count && found.last().is_none_or(|last| last.0.0 < self.side * ring as f64) {
                break;
            }
        }
        found.into_iter().map(|(_, point)| point).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the result with a sort of all distances. Points are on a small lattice, where many distances are
        /// equal, or in a slender box.
        #[test]
        fn nearby_nodes_are_the_nearest_of_all(
            places in proptest::collection::vec([0i8..9, 0i8..9], 0..60), from in [-4i8..13, -4i8..13], count in 0usize..12,
            slender in prop_oneof![Just(1.0), Just(1e-3), Just(0.0)],
        ) {
            let point = |[x, y]: [i8; 2]| Point::new(f64::from(x), slender * f64::from(y));
            let (points, from): (Vec<Point>, _) = (places.into_iter().map(point).collect(), point(from));
            let mut all: Vec<usize> = (0..points.len()).collect();
            all.sort_by(|&a, &b| (points[a] - from).norm().total_cmp(&(points[b] - from).norm()).then(a.cmp(&b)));
            all.truncate(count);
            prop_assert_eq!(Nearby::new(points).nearest(from, count), all);
        }
    }
}
