//! Minkowski differences of convex polygons: the C-obstacles of a body that translates.

use std::cmp::Ordering;

use super::penetration::origin_depth;
use super::predicates::turn_of_directions;
use super::{Convex, Orientation, Point, Vector};

/// Computes the Minkowski difference `b - a = { q - p : q in b, p in a }` of two convex counter-clockwise polygons: the
/// translations that make `a` meet `b`.
///
/// The result is counter-clockwise from its lowest corner (the leftmost of these). Its sides are those of `b` and of
/// `-a`, ordered by direction. One sweep over the angles finds them (T. Lozano-Perez, *Spatial Planning: A
/// Configuration Space Approach*, 1983): `O(n + m)`, at most `n + m` corners. Sides of exactly equal direction are
/// joined. Each coordinate is one difference of input coordinates, rounded once. Segments are polygons of two corners,
/// and points are polygons of one. The result is empty if an input is.
pub fn minkowski_difference(b: &[Point], a: &[Point]) -> Vec<Point> {
    let (Some(mut plus), Some(mut minus)) = (Sweep::new(b, false), Sweep::new(a, true)) else { return Vec::new() };
    let mut corners = Vec::with_capacity(b.len() + a.len());
    loop {
        corners.push(plus.corner() - minus.corner());
        let order = match (plus.side(), minus.side()) {
            (None, None) => break,
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (Some(p), Some(m)) => p.order(&m),
        };
        if order.is_le() {
            plus.pass();
        }
        if order.is_ge() {
            minus.pass();
        }
    }
    // The last step returns to the first corner. Rounding can make neighbours coincide.
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

/// Returns the penetration depth of two shapes, metres: the length of the shortest translation that separates them.
/// Returns the negative distance if they are disjoint.
///
/// This is the depth of the origin in the Minkowski difference of the cores, plus both radii. `O(n + m)`.
/// [`super::separation`] computes the negative value by another method.
pub fn penetration_depth(a: &Convex, b: &Convex) -> f64 {
    origin_depth(&minkowski_difference(b.core(), a.core())) + a.radius() + b.radius()
}

/// A side of a polygon, from `start` to `end`.
#[derive(Clone, Copy)]
struct Side {
    start: Point,
    end: Point,
}

impl Side {
    fn direction(&self) -> Vector {
        // The comparison gives the exact signs of the difference, so the half plane below is exact.
        self.end - self.start
    }

    /// Returns true if the direction lies in `[pi, 2 pi)`.
    fn downward(&self) -> bool {
        let d = self.direction();
        d.y < 0.0 || (d.y == 0.0 && d.x < 0.0)
    }

    /// Compares directions by angle from 0 to 2 pi; exact.
    fn order(&self, other: &Side) -> Ordering {
        let turn = || turn_of_directions([self.start, self.end], [other.start, other.end]);
        self.downward().cmp(&other.downward()).then_with(|| match turn() {
            Orientation::CounterClockwise => Ordering::Less,
            Orientation::Collinear => Ordering::Equal,
            Orientation::Clockwise => Ordering::Greater,
        })
    }
}

/// A walk along the sides of a polygon, or of its reflection in the origin, by direction.
struct Sweep<'a> {
    polygon: &'a [Point],
    /// Index of the corner at which the walk started.
    first: usize,
    /// Number of sides passed.
    passed: usize,
    reflected: bool,
}

impl<'a> Sweep<'a> {
    /// Starts a walk at the lowest (leftmost) corner of the polygon or of its reflection. `None` if there is no corner.
    fn new(polygon: &'a [Point], reflected: bool) -> Option<Self> {
        let lower = |&i: &usize, &j: &usize| {
            let (p, q) = (polygon[i], polygon[j]);
            // Adding 0.0 turns -0.0 into 0.0, which `total_cmp` would distinguish.
            (p.y + 0.0).total_cmp(&(q.y + 0.0)).then((p.x + 0.0).total_cmp(&(q.x + 0.0)))
        };
        let first = if reflected { (0..polygon.len()).max_by(lower) } else { (0..polygon.len()).min_by(lower) }?;
        let mut sweep = Self { polygon, first, passed: 0, reflected };
        sweep.skip_empty();
        Some(sweep)
    }

    /// Returns the current corner of the polygon itself, even if the walk is reflected.
    fn corner(&self) -> Point {
        self.polygon[(self.first + self.passed) % self.polygon.len()]
    }

    /// Returns the next side, reflected if the walk is.
    fn side(&self) -> Option<Side> {
        let n = self.polygon.len();
        if self.passed == n {
            return None;
        }
        let (from, to) = (self.corner(), self.polygon[(self.first + self.passed + 1) % n]);
        Some(if self.reflected { Side { start: to, end: from } } else { Side { start: from, end: to } })
    }

    /// Passes one side, and the sides that follow it in the same direction.
    fn pass(&mut self) {
        let Some(side) = self.side() else { return };
        self.passed += 1;
        self.skip_empty();
        while self.side().is_some_and(|next| side.order(&next).is_ge()) {
            self.passed += 1;
            self.skip_empty();
        }
    }

    fn skip_empty(&mut self) {
        while self.side().is_some_and(|side| side.start == side.end) {
            self.passed += 1;
        }
    }
}
