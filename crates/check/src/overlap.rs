//! Overlap depth of two convex shapes: the distance that one must move until they no longer overlap.

use crate::interval::{Interval, Point};
use num_bigint::BigInt;
use std::ops::{Add, Mul, Sub};

/// All points within `radius` of the convex hull of some points.
#[derive(Debug, Clone)]
pub struct Shape {
    /// Points whose convex hull is the core of the shape.
    pub points: Vec<Point>,
    /// Greatest distance of the shape's points from the core, metres.
    pub radius: Interval,
}

impl Shape {
    /// Returns the shape with a radius that is larger by a distance.
    pub fn grown(self, by: &Interval) -> Self {
        Self { radius: &self.radius + by, ..self }
    }
}

/// A point whose coordinates are numbers of units; see [`Interval`].
pub type Exact = [BigInt; 2];

/// Integers with exact differences, sums, products and comparisons. Machine integers are exact as long as they do not
/// overflow.
pub trait Integer: Clone + Ord + Default {
    /// Returns the difference.
    fn minus(&self, other: &Self) -> Self;
    /// Returns the sum.
    fn plus(&self, other: &Self) -> Self;
    /// Returns the product.
    fn times(&self, other: &Self) -> Self;
}

impl<T: Clone + Ord + Default> Integer for T
where
    for<'a> &'a T: Sub<Output = T> + Add<Output = T> + Mul<Output = T>,
{
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

fn cross<T: Integer>(u: &[T; 2], v: &[T; 2]) -> T {
    u[0].times(&v[1]).minus(&u[1].times(&v[0]))
}

fn dot<T: Integer>(u: &[T; 2], v: &[T; 2]) -> T {
    u[0].times(&v[0]).plus(&u[1].times(&v[1]))
}

fn minus<T: Integer>(u: &[T; 2], v: &[T; 2]) -> [T; 2] {
    [u[0].minus(&v[0]), u[1].minus(&v[1])]
}

/// Returns the corners of the convex hull, turning left, with no three on a line (Andrew 1979).
pub fn hull<T: Integer>(mut points: Vec<[T; 2]>) -> Vec<[T; 2]> {
    points.sort();
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut ring: Vec<[T; 2]> = Vec::new();
    for back in [false, true] {
        let first = ring.len();
        for p in if back { points.iter().rev().collect::<Vec<_>>() } else { points.iter().collect() } {
            while let [.., a, b] = &ring[first..]
                && cross(&minus(b, a), &minus(p, a)) <= T::default()
            {
                ring.pop();
            }
            ring.push(p.clone());
        }
        // The last point of one half is the first point of the other.
        ring.pop();
    }
    ring
}

/// Returns true if the origin is nearer than `distance` to the segment from `p` to `q`.
fn is_near<T: Integer>(p: &[T; 2], q: &[T; 2], distance: &T) -> bool {
    let (along, square) = (minus(q, p), distance.times(distance));
    let at = T::default().minus(&dot(p, &along));
    let whole = dot(&along, &along);
    if at <= T::default() {
        dot(p, p) < square
    } else if at >= whole {
        dot(q, q) < square
    } else {
        let area = cross(p, q);
        area.times(&area) < square.times(&whole)
    }
}

/// Returns true if a convex hull extends beyond the origin by more than `needed` in every direction. `ring` has its
/// corners in order, turning left. `needed` may be negative.
fn reaches<T: Integer>(ring: &[[T; 2]], needed: &T) -> bool {
    let zero = T::default();
    let edges = || ring.iter().zip(ring.iter().cycle().skip(1));
    if *needed < zero && edges().any(|(p, q)| is_near(p, q, &zero.minus(needed))) {
        return true;
    }
    // The origin must be inside, and farther than `needed` from each side.
    let is_deep = |(p, q): (&[T; 2], &[T; 2])| {
        let (area, along) = (cross(p, q), minus(q, p));
        let is_beyond = || area.times(&area) > needed.times(needed).times(&dot(&along, &along));
        area > zero && (*needed < zero || is_beyond())
    };
    ring.len() > 2 && edges().all(is_deep)
}

/// Returns the middles of the enclosures of the shape's points, and the maximum distance of a point from its middle.
fn middles(shape: &Shape) -> (Vec<Exact>, BigInt) {
    let mut error = BigInt::ZERO;
    let middle = |p: &Point| {
        let [(x, dx), (y, dy)] = p.each_ref().map(Interval::middle);
        error = (dx + dy).max(std::mem::take(&mut error));
        [x, y]
    };
    (shape.points.iter().map(middle).collect(), error)
}

/// Returns true if the shape `a` overlaps `b` by more than `depth`: no translation of `a` by `depth` or less separates
/// it from `b`.
///
/// Let `M` be the convex hull of all differences of a point of `b` and a point of `a`, and let `r` be the sum of the
/// radii. Then `a` overlaps `b` by more than `depth` if `M` reaches beyond the origin by more than `depth - r` in every
/// direction. The test uses the middles of the points' enclosures, without rounding. To be safe, it adds `error`, the
/// maximum distance of a difference from its middle, to the required depth. In most cases, the leading digits decide.
pub fn overlap_by_more_than(a: &Shape, b: &Shape, depth: &BigInt) -> bool {
    let [(a_middles, a_error), (b_middles, b_error)] = [a, b].map(middles);
    let error = a_error + b_error;
    let needed = depth - &a.radius.lower - &b.radius.lower + error;
    let all = || a_middles.iter().chain(&b_middles).flatten();
    let shift = all().chain([&needed]).map(BigInt::bits).max().unwrap_or(0).saturating_sub(LEADING_BITS);
    let first = |n: &BigInt| i128::try_from(n >> shift).expect("of few bits");
    let [a_first, b_first] =
        [&a_middles, &b_middles].map(|points| points.iter().map(|p| p.each_ref().map(first)).collect::<Vec<_>>());
    let (ring, about) = (hull(differences(&b_first, &a_first)), first(&needed));
    // Differences of leading digits are off by less than one in each coordinate.
    if reaches(&ring, &(about + 3)) {
        return true;
    }
    reaches(&ring, &(about - 2)) && reaches(&hull(differences(&b_middles, &a_middles)), &needed)
}

/// Returns true if the convex hulls of some points seem to overlap by more than a depth. The test uses only leading
/// digits, and returns true if these do not decide.
pub fn seem_to_overlap(a: &[[f64; 2]], b: &[[f64; 2]], depth: f64) -> bool {
    let all = || a.iter().chain(b).flatten().chain([&depth]);
    let most = all().fold(0.0_f64, |most, c| most.max(c.abs()));
    let first = |c: f64| (c / most * 2f64.powi(LEADING_BITS as i32)) as i128;
    let [a, b] = [a, b].map(|points| points.iter().map(|p| p.map(first)).collect::<Vec<_>>());
    all().any(|c| !c.is_finite()) || reaches(&hull(differences(&b, &a)), &(first(depth) - 3))
}

/// Number of leading binary digits for which squares of products fit in 128 bits.
const LEADING_BITS: u64 = 28;

/// Returns all differences of a point of `to` and a point of `from`.
fn differences<T: Integer>(from: &[[T; 2]], to: &[[T; 2]]) -> Vec<[T; 2]> {
    from.iter().flat_map(|p| to.iter().map(move |q| minus(p, q))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decimal::Decimal;

    fn of(text: &str) -> Interval {
        Interval::from(&text.parse::<Decimal>().unwrap())
    }

    fn shape(points: &str, radius: &str) -> Shape {
        let numbers: Vec<Interval> = points.split_whitespace().map(of).collect();
        Shape { points: numbers.chunks(2).map(|p| [p[0].clone(), p[1].clone()]).collect(), radius: of(radius) }
    }

    /// Asserts the overlap depth: the test succeeds for slightly less than `depth`, and fails for slightly more.
    fn has_depth(a: &Shape, b: &Shape, depth: &str) {
        let little = of("1e-50").upper;
        for (a, b) in [(a, b), (b, a)] {
            assert!(overlap_by_more_than(a, b, &(of(depth).lower - &little)), "{depth}");
            assert!(!overlap_by_more_than(a, b, &(of(depth).upper + &little)), "{depth}");
        }
    }

    #[test]
    fn depths_agree_with_closed_forms() {
        let square = shape("0 0  2 0  2 2  0 2", "0");
        has_depth(&square, &shape("1 1  5 1  5 5  1 5", "0"), "1");
        has_depth(&square, &shape("0.5 -9  0.5 9", "0"), "0.5");
        has_depth(&square, &shape("1 1", "0.25"), "1.25");
        has_depth(&square, &shape("5 6", "5.5"), "0.5");
        has_depth(&square, &shape("2.1 1", "0.3"), "0.2");
        has_depth(&shape("0 0", "1"), &shape("0.3 0.4", "2"), "2.5");
        has_depth(&shape("0 0", "1"), &shape("3 4", "4.5"), "0.5");
        has_depth(&shape("-1 0  1 0", "0.1"), &shape("0 -1  0 1", "0.1"), "1.2");
        has_depth(&shape("-1 0  1 0", "0.1"), &shape("0 0.15", "0.1"), "0.05");
        let root = "0.7071067811865475244008443621048490392848359376884740365883398689";
        has_depth(&shape("1 0  0 1  -1 0  0 -1", "0"), &shape("0 0", "0"), root);
        has_depth(&shape("-1 0  1 0", "1"), &shape("2 0  4 0", "1"), "1");
        // Repeated points, and points within the hull, change nothing.
        has_depth(&shape("0 0  2 0  2 2  0 2  1 1  1 0  0 0", "0"), &shape("1 1  5 1  5 5  1 5", "0"), "1");
    }

    #[test]
    fn touching_or_separate_shapes_have_no_depth() {
        let square = shape("0 0  2 0  2 2  0 2", "0");
        for other in [shape("2 0  3 0  3 1", "0"), shape("3 1", "1"), shape("3 3", "1"), shape("0 2  2 2", "0")] {
            assert!(!overlap_by_more_than(&square, &other, &BigInt::ZERO));
            assert!(!overlap_by_more_than(&other, &square, &BigInt::ZERO));
        }
        let point = shape("1 1", "0");
        assert!(!overlap_by_more_than(&point, &point, &BigInt::ZERO));
    }
}
