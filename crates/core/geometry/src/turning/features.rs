//! Corners and sides of convex shapes, prepared for the contact equations.
//!
//! Here, vectors of the plane are multiplied as complex numbers. A rotation is then a product, and a single arc tangent
//! gives the angle of a contact.

use super::bar::Bar;
use crate::{Convex, Point, Vector, cross, perpendicular};

/// Returns the product of two vectors as complex numbers: `b` turned by the angle of `a`, with lengths multiplied.
pub fn product(a: Vector, b: Vector) -> Vector {
    Vector::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// Returns `b` turned back by the angle of `a`, with lengths multiplied: the complex product with the conjugate of `a`.
pub(super) fn quotient(b: Vector, a: Vector) -> Vector {
    Vector::new(a.dot(&b), cross(a, b))
}

/// A corner of a core.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Corner {
    /// Position.
    pub at: Vector,
    /// Squared distance from the origin.
    pub distance2: f64,
    /// Distance from the origin.
    pub distance: f64,
    to_neighbors: [Vector; 2],
    polar: [Vector; 2],
    neighbors: usize,
}

impl Corner {
    /// Returns the vectors to the next and to the previous corner, if they exist.
    pub fn to_neighbors(&self) -> &[Vector] {
        &self.to_neighbors[..self.neighbors]
    }

    /// Returns the same vectors, turned and scaled so that the corner is at `(1, 0)`. Zero if the corner is at the origin.
    pub fn polar(&self) -> &[Vector] {
        &self.polar[..self.neighbors]
    }
}

/// A side of a core: the points `normal * offset + tangent * t`, with `t` from `from` to `to`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Side {
    /// Outward unit normal. The tangent is its counter-clockwise perpendicular and points along the outline.
    pub normal: Vector,
    /// Signed distance of the side's line from the origin.
    pub offset: f64,
    /// Position of the side's start along its tangent.
    pub from: f64,
    /// Position of the side's end along its tangent.
    pub to: f64,
}

/// A rounded convex polygon prepared for the contact equations. A core of one corner has no sides. A core of two
/// corners has two.
#[derive(Debug, Clone, PartialEq)]
pub struct Features {
    pub(super) shape: Convex,
    pub(super) corners: Vec<Corner>,
    pub(super) sides: Vec<Side>,
    /// Least and greatest distance of the core from the origin.
    pub(super) inner: f64,
    pub(super) outer: f64,
    /// Centre and radius of a disc around the core.
    pub(super) center: Vector,
    pub(super) extent: f64,
    /// The core as a bar about the origin. `None` if it is no bar.
    pub(super) bar: Option<Bar>,
}

impl Features {
    /// Prepares a shape. `O(n)`.
    pub fn new(shape: &Convex) -> Self {
        let core = shape.core();
        let n = core.len();
        let corners = (0..n)
            .map(|i| {
                let at = core[i];
                let to_neighbors = [core[(i + 1) % n] - at, core[(i + n - 1) % n] - at];
                let distance2 = at.norm_squared();
                let polar =
                    to_neighbors.map(|v| if distance2 > 0.0 { quotient(v, at) / distance2 } else { Vector::zeros() });
                Corner { at, distance2, distance: distance2.sqrt(), to_neighbors, polar, neighbors: (n - 1).min(2) }
            })
            .collect::<Vec<_>>();
        let sides: Vec<Side> = (0..if n > 1 { n } else { 0 })
            .filter_map(|i| {
                let (a, b) = (core[i], core[(i + 1) % n]);
                let normal = (-perpendicular(b - a)).try_normalize(0.0)?;
                let tangent = perpendicular(normal);
                Some(Side { normal, offset: normal.dot(&a), from: tangent.dot(&a), to: tangent.dot(&b) })
            })
            .collect();
        let center = core.iter().sum::<Vector>() / n as f64;
        Self {
            inner: inner_distance(&corners, &sides),
            outer: corners.iter().map(|c| c.distance).fold(0.0, f64::max),
            extent: core.iter().map(|p| (p - center).norm()).fold(0.0, f64::max),
            bar: Bar::of(shape),
            shape: shape.clone(),
            corners,
            sides,
            center,
        }
    }

    /// Returns the shape.
    pub fn shape(&self) -> &Convex {
        &self.shape
    }

    /// Returns a lower bound on the least distance of the core from `pivot`, and an upper bound on the greatest one.
    pub(super) fn distances(&self, pivot: Point) -> (f64, f64) {
        let center = (self.center - pivot).norm();
        (center - self.extent, center + self.extent)
    }
}

/// Returns the distance of the origin from a core; 0 inside.
fn inner_distance(corners: &[Corner], sides: &[Side]) -> f64 {
    if corners.len() > 2 && sides.iter().all(|s| s.offset >= 0.0) {
        return 0.0;
    }
    let nearest_corner = corners.iter().map(|c| c.distance).fold(f64::INFINITY, f64::min);
    let feet = sides.iter().filter(|s| s.from <= 0.0 && 0.0 <= s.to).map(|s| s.offset.abs());
    feet.fold(nearest_corner, f64::min)
}
