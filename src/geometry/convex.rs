//! The one shape that everything is made of: a convex polygon grown by a radius.

use super::{Bounds, Point, Pose, Vector};

/// A *rounded convex polygon*: all points within `radius` of the convex hull of `core`.
///
/// One corner is a disc (or, with radius 0, a point), two are a capsule (or a thin wall), three and more a convex
/// polygon with rounded corners. Links and obstacles are unions of these, so polygons, discs, thin walls and a
/// clearance to keep are one case: growing by a distance only adds to the radius, exactly.
///
/// The core is counter-clockwise and has no repeated corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Convex {
    core: Vec<Point>,
    radius: f64,
}

impl Convex {
    /// A shape from a core that is already convex and counter-clockwise, with at least one corner.
    ///
    /// Untrusted corners go through [`super::hull`] or the input's validation first; this only checks in debug builds.
    #[must_use]
    pub fn new(core: Vec<Point>, radius: f64) -> Self {
        debug_assert!(!core.is_empty() && radius >= 0.0 && radius.is_finite());
        Self { core, radius }
    }

    /// A disc; with radius 0 a point.
    #[must_use]
    pub fn disc(center: Point, radius: f64) -> Self {
        Self::new(vec![center], radius)
    }

    /// A thin wall from `a` to `b`: no area, still solid. A point if `a` and `b` coincide.
    #[must_use]
    pub fn segment(a: Point, b: Point) -> Self {
        Self::new(if a == b { vec![a] } else { vec![a, b] }, 0.0)
    }

    /// Corners of the core, counter-clockwise.
    #[must_use]
    pub fn core(&self) -> &[Point] {
        &self.core
    }

    /// Distance by which the core is grown, metres.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The same shape grown by `distance` on every side (a Minkowski sum with a disc; exact).
    #[must_use]
    pub fn grown(&self, distance: f64) -> Self {
        Self::new(self.core.clone(), self.radius + distance)
    }

    /// The differences `q - p` of the points `q` of this shape and `p` of `other`: the translations that make `other`
    /// meet this shape, its *C-obstacle*. See [`super::minkowski_difference`]; the radii add up, exactly.
    #[must_use]
    pub fn minkowski_difference(&self, other: &Self) -> Self {
        Self::new(super::minkowski_difference(&self.core, &other.core), self.radius + other.radius)
    }

    /// The shape moved by `pose`.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        Self { core: self.core.iter().map(|p| pose * p).collect(), radius: self.radius }
    }

    /// Greatest distance of a point of the shape from `pivot`, metres.
    #[must_use]
    pub fn reach_from(&self, pivot: Point) -> f64 {
        self.core.iter().map(|p| (p - pivot).norm()).fold(0.0, f64::max) + self.radius
    }

    /// The smallest box with sides along the axes that holds the shape.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let radius = Vector::repeat(self.radius);
        let first = [self.core[0]; 2];
        let [lower, upper] = self.core.iter().fold(first, |[lower, upper], p| [lower.inf(p), upper.sup(p)]);
        [lower - radius, upper + radius]
    }

    /// Area, square metres (Steiner's formula: core + perimeter * r + pi r^2).
    #[must_use]
    pub fn area(&self) -> f64 {
        let n = self.core.len();
        let (mut twice, mut perimeter) = (0.0, 0.0);
        for (i, a) in self.core.iter().enumerate() {
            let b = &self.core[(i + 1) % n];
            twice += super::cross(a.coords, b.coords);
            perimeter += (b - a).norm();
        }
        twice / 2.0 + perimeter * self.radius + std::f64::consts::PI * self.radius * self.radius
    }
}
