//! All verdicts of the library on two convex shapes, compared with exact numbers.

use super::exact::{self, Number, Pair};
use cplan_geometry::{Convex, Location, Point, hull, point_penetration, polygon_test, shapes_meet};
use cplan_testkit::shapes::convex;
use std::cmp::Ordering;
use std::fmt::Debug;

/// A polygon of the library, and the same corners in exact numbers.
#[derive(Debug, Clone)]
pub struct Shape<T> {
    pub points: Vec<Point>,
    pub exact: Vec<Pair<T>>,
}

impl<T: Number + Debug> Shape<T> {
    /// Computes the convex hull by both methods, which must agree.
    pub fn hull(points: &[Point], exact: &[Pair<T>]) -> Self {
        let corners = exact::hull(exact);
        let expected: Vec<Point> = corners.iter().map(|&i| points[i]).collect();
        let mut found = hull(points);
        // The library begins at the leftmost corner, the oracle at the lowest.
        let first = found.iter().position(|p| *p == expected[0]).expect("the lowest corner");
        found.rotate_left(first);
        assert_eq!(found, expected, "hull of {points:?}");
        Self { points: expected, exact: corners.iter().map(|&i| exact[i].clone()).collect() }
    }

    /// Returns the library's shape.
    pub fn convex(&self) -> Convex {
        convex(self.points.clone(), 0.0)
    }

    /// Compares the library's results for points with the exact ones: the side of every line on which the point lies,
    /// and its location in the polygon.
    pub fn check_point(&self, p: Point, exact: &Pair<T>) {
        let n = self.points.len();
        let found = point_penetration(p, &self.convex());
        assert_eq!(found.location, exact::location(exact, &self.exact), "{p:?} in {:?}", self.points);
        for (i, distance) in found.distances.iter().enumerate() {
            let (a, b) = (&self.exact[i], &self.exact[(i + 1) % n]);
            assert_eq!(distance.partial_cmp(&0.0), Some(exact::side(a, b, exact)), "{p:?} from {:?}", self.points);
        }
        match found.location {
            Location::Inside => assert!(found.depth > 0.0),
            Location::Boundary => assert!(found.depth == 0.0),
            Location::Outside => assert!(found.depth <= 0.0),
        }
    }

    /// Compares all results of the library for this polygon and another with the exact ones. Returns true if the
    /// polygons meet.
    pub fn check(&self, other: &Self) -> bool {
        let (a, b) = (self, other);
        let meet = exact::meet(&a.exact, &b.exact);
        let what = || format!("{:?} and {:?}", a.points, b.points);
        let (one, other) = (a.convex(), b.convex());
        assert_eq!(shapes_meet(&one, &other), meet, "{}", what());
        assert_eq!(shapes_meet(&other, &one), meet, "{}", what());
        let found = polygon_test(&one, &other);
        assert_eq!(found.meet, meet, "{}", what());
        for (one, two, inside) in [(a, b, &found.a_inside), (b, a, &found.b_inside)] {
            let listed: Vec<usize> = inside.iter().map(|c| c.corner).collect();
            let inside = |&i: &usize| exact::location(&one.exact[i], &two.exact) != Location::Outside;
            let expected: Vec<usize> = (0..one.exact.len()).filter(inside).collect();
            assert_eq!(listed, expected, "{}", what());
            one.exact.iter().zip(&one.points).for_each(|(e, &p)| two.check_point(p, e));
        }
        assert_eq!(found.crossings, crossings(&a.exact, &b.exact), "{}", what());
        a.check_minkowski(b);
        meet
    }

    /// Checks that the Minkowski difference is the hull of all differences, each rounded once.
    fn check_minkowski(&self, other: &Self) {
        let mut rounded = Vec::new();
        let mut exact = Vec::new();
        for (q, y) in other.points.iter().zip(&other.exact) {
            for (p, x) in self.points.iter().zip(&self.exact) {
                // One subtraction, rounded to the nearest double.
                rounded.push(q - p);
                exact.push(exact::minus(y, x));
            }
        }
        let mut expected: Vec<Point> = exact::hull(&exact).into_iter().map(|i| rounded[i]).collect();
        expected.dedup();
        while expected.len() > 1 && expected.first() == expected.last() {
            expected.pop();
        }
        let found = other.convex().minkowski_difference(&self.convex());
        assert_eq!(found.core(), expected, "{:?} less {:?}", other.points, self.points);
    }
}

/// Returns pairs of sides that cross properly.
fn crossings<T: Number>(a: &[Pair<T>], b: &[Pair<T>]) -> Vec<(usize, usize)> {
    let sides = |n: usize| if n == 2 { 1 } else { n };
    let mut found = Vec::new();
    for i in 0..sides(a.len()) {
        for k in 0..sides(b.len()) {
            let (p, q) = (&a[i], &a[(i + 1) % a.len()]);
            let (r, s) = (&b[k], &b[(k + 1) % b.len()]);
            if exact::segments([p, q], [r, s]).1 {
                found.push((i, k));
            }
        }
    }
    found
}

/// Returns true if the corners turn left or are straight everywhere, and turn left somewhere.
pub fn has_area<T: Number>(exact: &[Pair<T>]) -> bool {
    let n = exact.len();
    (0..n).any(|i| exact::side(&exact[i], &exact[(i + 1) % n], &exact[(i + 2) % n]) == Ordering::Greater)
}
