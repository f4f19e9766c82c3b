//! Convex bodies and their distances, for the oracles: separating axes if they overlap, otherwise corners and sides.

use cplan::geometry::Convex;

/// A point or a vector.
pub type V = [f64; 2];

/// Largest number of corners of a body.
const MOST: usize = 8;

/// Distances nearer to zero than this are computed from corners and sides, because no normal shows the distance of bodies on one
/// line.
const TOUCHING: f64 = 1e-12;

/// Returns `a - b`.
pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1]]
}

/// Returns `a + b`.
pub fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1]]
}

/// Returns the scalar product.
pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the Euclidean length.
pub fn norm(a: V) -> f64 {
    dot(a, a).sqrt()
}

/// Returns `a` turned by the angle with the cosine and sine `by`.
pub fn rotate(a: V, by: V) -> V {
    [by[0] * a[0] - by[1] * a[1], by[1] * a[0] + by[0] * a[1]]
}

/// All points within a radius of a convex polygon, a segment or a point.
#[derive(Debug, Clone, Copy)]
pub struct Solid {
    count: usize,
    corners: [V; MOST],
    /// Outward unit normals of the sides. Each belongs to the side after the corner with the same index; two for a segment, none
    /// for a point.
    normals: [V; MOST],
    middle: V,
    /// Greatest distance of a corner from the middle.
    size: f64,
    /// Radius by which the body extends beyond its core.
    pub radius: f64,
    /// Greatest distance of a corner from the origin of its frame.
    pub reach: f64,
}

impl Solid {
    /// Returns the body of a shape. Panics if it has too many corners.
    pub fn new(shape: &Convex) -> Self {
        let count = shape.core().len();
        assert!(count <= MOST);
        let (mut corners, mut normals) = ([[0.0; 2]; MOST], [[0.0; 2]; MOST]);
        shape.core().iter().zip(&mut corners).for_each(|(p, c)| *c = [p.x, p.y]);
        let used = &corners[..count];
        for i in 0..if count > 1 { count } else { 0 } {
            let d = sub(used[(i + 1) % count], used[i]);
            normals[i] = [d[1] / norm(d), -d[0] / norm(d)];
        }
        let sum = used.iter().fold([0.0; 2], |s, &p| add(s, p));
        let middle = [sum[0] / count as f64, sum[1] / count as f64];
        let size = used.iter().map(|&p| norm(sub(p, middle))).fold(0.0, f64::max);
        let reach = used.iter().map(|&p| norm(p)).fold(0.0, f64::max);
        Self { count, corners, normals, middle, size, radius: shape.radius(), reach }
    }

    /// Returns the body, first turned about the origin, then moved.
    pub fn placed(&self, turn: V, place: V) -> Self {
        let mut at = *self;
        for i in 0..self.count {
            at.corners[i] = add(rotate(self.corners[i], turn), place);
            at.normals[i] = rotate(self.normals[i], turn);
        }
        at.middle = add(rotate(self.middle, turn), place);
        at
    }

    /// Returns the corners of the core.
    pub fn corners(&self) -> &[V] {
        &self.corners[..self.count]
    }

    /// Returns a cheap lower bound on the signed distance.
    pub fn roughly(&self, other: &Self) -> f64 {
        norm(sub(self.middle, other.middle)) - self.size - other.size - self.radius - other.radius
    }

    /// Returns the signed distance. A negative value is the depth of penetration.
    pub fn distance(&self, other: &Self) -> f64 {
        let gap = self.widest_gap(other).max(other.widest_gap(self));
        let cores = if gap < -TOUCHING && gap.is_finite() {
            gap
        } else {
            self.corners_to_sides(other).min(other.corners_to_sides(self)).sqrt()
        };
        cores - self.radius - other.radius
    }

    /// Returns the greatest distance of the other body from the line of a side of this one. Minus infinity if this body has no
    /// sides.
    fn widest_gap(&self, other: &Self) -> f64 {
        let mut widest = f64::NEG_INFINITY;
        let sides = if self.count > 1 { self.count } else { 0 };
        for (n, &p) in self.normals[..sides].iter().zip(self.corners()) {
            let mut least = f64::INFINITY;
            for &q in other.corners() {
                least = least.min(dot(*n, sub(q, p)));
            }
            widest = widest.max(least);
        }
        widest
    }

    /// Returns the square of the least distance between a corner of this body and a side of the other.
    fn corners_to_sides(&self, other: &Self) -> f64 {
        let mut least = f64::INFINITY;
        for i in 0..other.count {
            let (a, b) = (other.corners[i], other.corners[(i + 1) % other.count]);
            let d = sub(b, a);
            let square = dot(d, d);
            for &p in self.corners() {
                let t = if square > 0.0 { (dot(sub(p, a), d) / square).clamp(0.0, 1.0) } else { 0.0 };
                let off = sub(p, [a[0] + t * d[0], a[1] + t * d[1]]);
                least = least.min(dot(off, off));
            }
        }
        least
    }
}
