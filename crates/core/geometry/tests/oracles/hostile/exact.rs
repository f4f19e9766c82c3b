//! Geometry in exact numbers by other methods than the library's: Cramer's rule, separating axes, gift wrapping. It is
//! generic, so that the same oracle runs in 128-bit integers, if they suffice, and in rational numbers.

use cplan_geometry::Location;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

/// A number whose arithmetic is exact.
pub trait Number: Clone + Ord + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<T: Clone + Ord + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Number for T {}

/// A point or a vector.
pub type Pair<T> = (T, T);

pub fn minus<T: Number>(a: &Pair<T>, b: &Pair<T>) -> Pair<T> {
    (a.0.clone() - b.0.clone(), a.1.clone() - b.1.clone())
}

fn cross<T: Number>(a: &Pair<T>, b: &Pair<T>) -> T {
    a.0.clone() * b.1.clone() - a.1.clone() * b.0.clone()
}

fn dot<T: Number>(a: &Pair<T>, b: &Pair<T>) -> T {
    a.0.clone() * b.0.clone() + a.1.clone() * b.1.clone()
}

fn zero<T: Number>(like: &T) -> T {
    like.clone() - like.clone()
}

fn sign<T: Number>(x: &T) -> Ordering {
    x.cmp(&zero(x))
}

/// Returns the side of `c` as seen from `a` to `b`: greater on the left.
pub fn side<T: Number>(a: &Pair<T>, b: &Pair<T>, c: &Pair<T>) -> Ordering {
    sign(&cross(&minus(b, a), &minus(c, a)))
}

/// Returns two flags: whether two closed segments meet, and whether they cross in a point interior to both. Uses
/// Cramer's rule for the parameters of the common point, and projection for parallel segments.
pub fn segments<T: Number>([a, b]: [&Pair<T>; 2], [c, d]: [&Pair<T>; 2]) -> (bool, bool) {
    let (u, v, w) = (minus(b, a), minus(d, c), minus(c, a));
    let determinant = cross(&u, &v);
    let none = zero(&determinant);
    if determinant != none {
        let within = |numerator: T| {
            let (n, d) = if determinant < none {
                (zero(&numerator) - numerator, none.clone() - determinant.clone())
            } else {
                (numerator, determinant.clone())
            };
            (none <= n && n <= d, none < n && n < d)
        };
        let (first, second) = (within(cross(&w, &v)), within(cross(&w, &u)));
        return (first.0 && second.0, first.1 && second.1);
    }
    let still = |v: &Pair<T>| v.0 == none_of(v) && v.1 == none_of(v);
    let along = if still(&u) { &v } else { &u };
    if still(along) {
        return (a == c, false);
    }
    if cross(along, &w) != none {
        return (false, false);
    }
    let t = |p: &Pair<T>| dot(along, p);
    let meet = t(a).min(t(b)) <= t(c).max(t(d)) && t(c).min(t(d)) <= t(a).max(t(b));
    (meet, false)
}

fn none_of<T: Number>(v: &Pair<T>) -> T {
    zero(&v.0)
}

/// Returns true if two convex sets of corners meet, by separating axes: the normals of all sides and, for sets without
/// area, the sides themselves.
pub fn meet<T: Number>(a: &[Pair<T>], b: &[Pair<T>]) -> bool {
    let mut axes = vec![minus(&b[0], &a[0])];
    for core in [a, b] {
        for (i, p) in core.iter().enumerate() {
            let along = minus(&core[(i + 1) % core.len()], p);
            axes.push((none_of(&along) - along.1.clone(), along.0.clone()));
            axes.push(along);
        }
    }
    axes.iter().all(|axis| {
        let least = |core: &[Pair<T>]| core.iter().map(|p| dot(axis, p)).min();
        let most = |core: &[Pair<T>]| core.iter().map(|p| dot(axis, p)).max();
        least(a) <= most(b) && least(b) <= most(a)
    })
}

/// Locates `p` in the convex counter-clockwise polygon.
pub fn location<T: Number>(p: &Pair<T>, polygon: &[Pair<T>]) -> Location {
    let n = polygon.len();
    if !meet(std::slice::from_ref(p), polygon) {
        Location::Outside
    } else if polygon.iter().any(|c| c != &polygon[0])
        && (0..n).all(|i| polygon[i] == polygon[(i + 1) % n] || is_left_of_side(polygon, i, p))
    {
        Location::Inside
    } else {
        Location::Boundary
    }
}

fn is_left_of_side<T: Number>(polygon: &[Pair<T>], i: usize, p: &Pair<T>) -> bool {
    side(&polygon[i], &polygon[(i + 1) % polygon.len()], p) == Ordering::Greater
}

/// Returns indices of the corners of the convex hull, by gift wrapping. The order is counter-clockwise from the lowest
/// (of these the leftmost) point; of coincident points, it has the first.
pub fn hull<T: Number>(points: &[Pair<T>]) -> Vec<usize> {
    let start = (0..points.len()).min_by_key(|&i| (points[i].1.clone(), points[i].0.clone()));
    let Some(start) = start else { return Vec::new() };
    let mut corners = vec![start];
    loop {
        let at = &points[corners[corners.len() - 1]];
        let mut next: Option<usize> = None;
        for (i, p) in points.iter().enumerate().filter(|(_, p)| *p != at) {
            let better = |j: usize| match side(at, &points[j], p) {
                Ordering::Less => true,
                Ordering::Greater => false,
                // The farthest point in one direction.
                Ordering::Equal => {
                    let (d, e) = (minus(p, at), minus(&points[j], at));
                    dot(&d, &d) > dot(&e, &e)
                }
            };
            if next.is_none_or(better) {
                next = Some(i);
            }
        }
        match next {
            Some(i) if points[i] != points[start] => corners.push(i),
            _ => return corners,
        }
    }
}
