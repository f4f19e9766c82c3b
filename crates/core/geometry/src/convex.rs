//! The basic shape of links and obstacles: a convex polygon grown by a radius.

use super::predicates::{Orientation, orientation};
use super::{Bounds, Point, Pose, Vector, hull};
use serde::{Deserialize, Serialize};

/// The reason why corners and a radius do not form a convex shape. Messages count corners from 1, fields from 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ConvexError {
    /// There is no corner.
    #[error("it has no corner")]
    NoCorner,
    /// The radius is negative or not finite.
    #[error("its radius is {radius}")]
    Radius {
        /// The given radius.
        radius: f64,
    },
    /// A bar's length is zero, negative or not finite.
    #[error("the length is {length}, but must be finite and greater than 0")]
    Length {
        /// The given length.
        length: f64,
    },
    /// A coordinate is infinite or not a number.
    #[error("corner {} is not finite", corner + 1)]
    NotFinite {
        /// Index of the corner in the list.
        corner: usize,
    },
    /// A corner and the next one coincide.
    #[error("corner {} and the next one coincide", corner + 1)]
    Repeated {
        /// Index of the corner in the list.
        corner: usize,
    },
    /// The boundary is not a single counter-clockwise turn that bends left at every corner.
    #[error("the boundary does not turn left at corner {}, or goes round more than once; list the corners of a convex polygon counter-clockwise", corner + 1)]
    NotConvex {
        /// Index of the corner in the list.
        corner: usize,
    },
}

/// A *rounded convex polygon*: all points within `radius` of the convex hull of `core`.
///
/// One corner gives a disc (or, with radius 0, a point), two give a capsule (or a thin wall), and three or more give a
/// convex polygon with rounded corners. Links and obstacles are unions of such shapes. So polygons, discs and thin
/// walls need no separate cases. Growing by a clearance only adds to the radius, exactly.
///
/// The core is counter-clockwise and has no repeated corners. In a scene, a shape that may be approached closer than
/// the clearance has a negative radius; see `receding`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Corners")]
pub struct Convex {
    core: Vec<Point>,
    radius: f64,
}

/// The form in which a shape is read from a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Corners {
    core: Vec<Point>,
    radius: f64,
}

impl TryFrom<Corners> for Convex {
    type Error = ConvexError;

    /// Like [`Convex::new`], except that corners may be slightly bent by the rounding of a transformation, as in shapes
    /// from [`Convex::at`].
    fn try_from(Corners { core, radius }: Corners) -> Result<Self, ConvexError> {
        match Self::new(core.clone(), radius) {
            Err(ConvexError::NotConvex { .. }) if is_hull_up_to_rounding(&core) => Ok(Self { core, radius }),
            made => made,
        }
    }
}

/// Largest bend of a corner that is attributed to rounding, as a fraction of the greatest coordinate.
const BEND_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Returns true if the corners go once around their convex hull. Other corners than those of the hull must lie on its
/// sides, up to rounding.
fn is_hull_up_to_rounding(core: &[Point]) -> bool {
    let hull = hull(core);
    let bent = BEND_ROUNDING * core.iter().fold(0.0_f64, |most, p| most.max(p.amax()));
    let n = core.len();
    let Some(first) = core.iter().position(|p| hull.len() > 2 && *p == hull[0]) else { return false };
    // The side of the hull on which the previous corner lies, and that corner's position along the side.
    let (mut side, mut last) = (0, 0.0);
    let follows = (1..n).all(|k| {
        let p = core[(first + k) % n];
        if hull.get(side + 1) == Some(&p) {
            (side, last) = (side + 1, 0.0);
            return true;
        }
        let [a, b] = [hull[side], hull[(side + 1) % hull.len()]];
        let (along, to) = (b - a, p - a);
        let before = std::mem::replace(&mut last, along.dot(&to));
        super::cross(along, to) <= bent * along.norm() && before < last && last < along.norm_squared()
    });
    follows && side + 1 == hull.len()
}

impl Convex {
    /// Creates a shape from a convex, counter-clockwise core without repeated corners. Straight corners are allowed.
    /// The test is exact and takes `O(n)`.
    ///
    /// # Errors
    /// If the core is empty, not convex, clockwise, repeats a corner or is not finite, or if the radius is negative or
    /// not finite. For corners in any order, call [`super::hull`] first.
    pub fn new(core: Vec<Point>, radius: f64) -> Result<Self, ConvexError> {
        if core.is_empty() {
            return Err(ConvexError::NoCorner);
        }
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(ConvexError::Radius { radius });
        }
        if let Some(corner) = core.iter().position(|p| !(p.x.is_finite() && p.y.is_finite())) {
            return Err(ConvexError::NotFinite { corner });
        }
        let n = core.len();
        if let Some(corner) = (0..n).find(|&i| n > 1 && core[i] == core[(i + 1) % n]) {
            return Err(ConvexError::Repeated { corner });
        }
        let turn = |i: usize| orientation(core[i], core[(i + 1) % n], core[(i + 2) % n]);
        let rises = |i: usize| {
            let (from, to) = (core[i % n], core[(i + 1) % n]);
            from.y < to.y || from.y == to.y && from.x < to.x
        };
        // A boundary of left turns can still wind around several times. If it winds once, there is exactly one corner
        // where the sides stop rising.
        let rounds = (0..n).filter(|&i| rises(i) && !rises(i + 1)).count();
        let is_flat = (0..n).all(|i| turn(i) == Orientation::Collinear);
        match (0..n).find(|&i| n > 2 && turn(i) == Orientation::Clockwise) {
            Some(corner) => Err(ConvexError::NotConvex { corner: (corner + 1) % n }),
            None if n > 2 && (is_flat || rounds != 1) => Err(ConvexError::NotConvex { corner: 0 }),
            None => Ok(Self { core, radius }),
        }
    }

    /// Creates a disc, or a point if the radius is 0.
    ///
    /// # Errors
    /// If a number is not finite, or the radius is negative.
    pub fn disc(center: Point, radius: f64) -> Result<Self, ConvexError> {
        Self::new(vec![center], radius)
    }

    /// Creates a thin wall from `a` to `b`. It has no area but is solid. If `a` and `b` coincide, it is a point.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn segment(a: Point, b: Point) -> Result<Self, ConvexError> {
        Self::new(if a == b { vec![a] } else { vec![a, b] }, 0.0)
    }

    /// Creates a shape from computed corners without checking them. Rounding may have bent them slightly, which
    /// [`Convex::new`] would refuse.
    #[doc(hidden)]
    pub fn trusted(core: Vec<Point>, radius: f64) -> Self {
        debug_assert!(!core.is_empty() && radius >= 0.0 && radius.is_finite());
        debug_assert!(core.iter().all(|p| p.x.is_finite() && p.y.is_finite()), "{core:?}");
        Self { core, radius }
    }

    /// Returns the shape with mapped corners and another radius, for pictures. Unlike in [`Convex::new`], the radius
    /// may be negative, as for pieces in a scene.
    #[must_use]
    pub fn mapped(&self, corner: impl Fn(Point) -> Point, radius: f64) -> Self {
        Self { core: self.core.iter().copied().map(corner).collect(), radius }
    }

    /// Like [`Convex::segment`], for points that are known to be finite. So it cannot fail.
    pub fn between(a: Point, b: Point) -> Self {
        Self::trusted(if a == b { vec![a] } else { vec![a, b] }, 0.0)
    }

    /// Creates a point, which must be finite.
    pub fn point(p: Point) -> Self {
        Self::trusted(vec![p], 0.0)
    }

    /// Returns the corners of the core, counter-clockwise.
    pub fn core(&self) -> &[Point] {
        &self.core
    }

    /// Returns the distance by which the core is grown, metres.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the shape grown by `distance` on every side: the exact Minkowski sum with a disc.
    ///
    /// # Panics
    /// If the new radius is negative or not finite.
    #[must_use]
    #[track_caller]
    pub fn grown(&self, distance: f64) -> Self {
        let radius = self.radius + distance;
        assert!(radius >= 0.0 && radius.is_finite(), "no convex shape: a radius of {radius}");
        Self { core: self.core.clone(), radius }
    }

    /// Returns a shape with every signed distance from it increased by `distance`, exactly. To do so, it lowers the
    /// radius, which may become negative.
    ///
    /// Another core meets a shape with a negative radius only if it penetrates the shape's core by more than the
    /// magnitude of the radius. A smaller polygon could not express this, because its corners would differ.
    #[must_use]
    pub fn with_distances_increased(&self, distance: f64) -> Self {
        debug_assert!(distance >= 0.0 && distance.is_finite());
        Self { core: self.core.clone(), radius: self.radius - distance }
    }

    /// Returns the Minkowski difference `{ q - p : q in self, p in other }`: the translations that make `other` meet
    /// this shape, which is its *C-obstacle*.
    ///
    /// The radii add up exactly. The core is counter-clockwise from its lowest corner (the leftmost of these). Each
    /// coordinate is one difference of input coordinates, rounded once. One sweep over the directions of the sides
    /// computes it (T. Lozano-Perez, *Spatial Planning: A Configuration Space Approach*, 1983), in `O(n + m)`, with at
    /// most `n + m` corners.
    #[must_use]
    pub fn minkowski_difference(&self, other: &Self) -> Self {
        Self { core: super::minkowski_difference(&self.core, &other.core), radius: self.radius + other.radius }
    }

    /// Returns the shape moved by `pose`, up to rounding.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        Self { core: self.core.iter().map(|&p| pose.point(p)).collect(), radius: self.radius }
    }

    /// Returns the greatest distance of a point of the shape from `pivot`, metres. With a negative radius it measures
    /// the core.
    pub fn reach_from(&self, pivot: Point) -> f64 {
        reach(&self.core, pivot) + self.radius.max(0.0)
    }

    /// Returns the smallest box around the shape with sides along the axes. With a negative radius it bounds the core.
    pub fn bounds(&self) -> Bounds {
        let radius = Vector::repeat(self.radius.max(0.0));
        let first = [self.core[0]; 2];
        let [lower, upper] = self.core.iter().fold(first, |[lower, upper], p| [lower.inf(p), upper.sup(p)]);
        [lower - radius, upper + radius]
    }

    /// Returns the area, square metres, by Steiner's formula: core + perimeter * r + pi r^2.
    pub fn area(&self) -> f64 {
        let n = self.core.len();
        let (mut twice, mut perimeter) = (0.0, 0.0);
        for (i, a) in self.core.iter().enumerate() {
            let b = &self.core[(i + 1) % n];
            twice += super::cross(*a, *b);
            perimeter += (b - a).norm();
        }
        twice / 2.0 + perimeter * self.radius + std::f64::consts::PI * self.radius * self.radius
    }

    /// Returns true if the shape is a polygon whose corners lie on one line up to rounding.
    pub fn is_sliver(&self) -> bool {
        let [first, others @ ..] = &self.core[..] else { return false };
        let twice: f64 = others.windows(2).map(|pair| super::cross(pair[0] - first, pair[1] - first).abs()).sum();
        let largest = self.core.iter().map(|p| p.amax()).fold(0.0, f64::max);
        let long = others.iter().map(|p| (p - first).norm()).fold(0.0, f64::max);
        self.radius == 0.0 && others.len() > 1 && twice <= 64.0 * f64::EPSILON * largest * long
    }
}

/// Returns the greatest distance of the points from `pivot`.
pub fn reach(points: &[Point], pivot: Point) -> f64 {
    points.iter().map(|p| (p - pivot).norm_squared()).fold(0.0, f64::max).sqrt()
}
