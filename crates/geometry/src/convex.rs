//! The one shape that everything is made of: a convex polygon grown by a radius.

use super::predicates::{Orientation, orientation};
use super::{Bounds, Point, Pose, Vector, hull};
use serde::{Deserialize, Serialize};

/// Why corners and a radius are no convex shape. Corners are counted from 1 in messages, from 0 here.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ConvexError {
    /// There is no corner.
    #[error("it has no corner")]
    NoCorner,
    /// The radius is negative or not finite.
    #[error("its radius is {radius}")]
    Radius {
        /// The radius as it was given.
        radius: f64,
    },
    /// A bar has no length, or not a finite one.
    #[error("its length is {length}, which is to be greater than 0")]
    Length {
        /// The length as it was given.
        length: f64,
    },
    /// A coordinate is infinite or not a number.
    #[error("corner {} is not finite", corner + 1)]
    NotFinite {
        /// The place of the corner in the list, from 0.
        corner: usize,
    },
    /// A corner and the next one coincide.
    #[error("corner {} and the next one coincide", corner + 1)]
    Repeated {
        /// The place of the corner in the list, from 0.
        corner: usize,
    },
    /// The boundary does not go round once counter-clockwise, turning left all the way.
    #[error("the boundary does not turn left at corner {}, or goes round more than once: its corners are to be convex and counter-clockwise", corner + 1)]
    NotConvex {
        /// The place of the corner in the list, from 0.
        corner: usize,
    },
}

/// A *rounded convex polygon*: all points within `radius` of the convex hull of `core`.
///
/// One corner is a disc (or, with radius 0, a point), two are a capsule (or a thin wall), three and more a convex
/// polygon with rounded corners. Links and obstacles are unions of these, so polygons, discs, thin walls and a
/// clearance to keep are one case: growing by a distance only adds to the radius, exactly.
///
/// The core is counter-clockwise and has no repeated corners. Within a scene what may be come nearer to than the clearance has a
/// negative radius, see `receding`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Corners", into = "Corners")]
pub struct Convex {
    core: Vec<Point>,
    radius: f64,
}

/// What a shape is made of, as data.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Corners {
    core: Vec<Point>,
    radius: f64,
}

impl From<Convex> for Corners {
    fn from(Convex { core, radius }: Convex) -> Self {
        Self { core, radius }
    }
}

impl TryFrom<Corners> for Convex {
    type Error = ConvexError;

    /// As [`Convex::new`], but that corners may be bent by what moving a shape rounds: [`Convex::at`] makes such, too.
    fn try_from(Corners { core, radius }: Corners) -> Result<Self, ConvexError> {
        match Self::new(core.clone(), radius) {
            Err(ConvexError::NotConvex { .. }) if is_hull_up_to_rounding(&core) => Ok(Self { core, radius }),
            made => made,
        }
    }
}

/// By how much rounding may bend a corner, as a share of the greatest coordinate.
const BENT: f64 = 16.0 * f64::EPSILON;

/// Whether the corners go once round their convex hull, those that are none of its corners as near to its sides as rounding
/// puts them.
fn is_hull_up_to_rounding(core: &[Point]) -> bool {
    let hull = hull(core);
    let bent = BENT * core.iter().fold(0.0_f64, |most, p| most.max(p.coords.amax()));
    let n = core.len();
    let Some(first) = core.iter().position(|p| hull.len() > 2 && *p == hull[0]) else { return false };
    // The side that the corner before lies on, and how far along.
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
    /// A shape from a core that is convex, counter-clockwise and without repeated corners; straight corners are allowed.
    /// Decided exactly, in `O(n)`.
    ///
    /// # Errors
    /// When the corners are none of that, are none at all or not finite, or the radius is negative or not finite. Corners in
    /// any order go through [`super::hull`] first.
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
        // Left turns alone could go round more than once: once round, the sides stop rising once.
        let rounds = (0..n).filter(|&i| rises(i) && !rises(i + 1)).count();
        let is_flat = (0..n).all(|i| turn(i) == Orientation::Collinear);
        match (0..n).find(|&i| n > 2 && turn(i) == Orientation::Clockwise) {
            Some(corner) => Err(ConvexError::NotConvex { corner: (corner + 1) % n }),
            None if n > 2 && (is_flat || rounds != 1) => Err(ConvexError::NotConvex { corner: 0 }),
            None => Ok(Self { core, radius }),
        }
    }

    /// A disc; with radius 0 a point.
    ///
    /// # Errors
    /// When a number is not finite, or the radius negative.
    pub fn disc(center: Point, radius: f64) -> Result<Self, ConvexError> {
        Self::new(vec![center], radius)
    }

    /// A thin wall from `a` to `b`: no area, still solid. A point if `a` and `b` coincide.
    ///
    /// # Errors
    /// When a coordinate is not finite.
    pub fn segment(a: Point, b: Point) -> Result<Self, ConvexError> {
        Self::new(if a == b { vec![a] } else { vec![a, b] }, 0.0)
    }

    /// A shape from corners that are known to be right, or were computed: rounding may have bent them by a hair, which
    /// [`Convex::new`] would refuse.
    #[must_use]
    #[doc(hidden)]
    pub fn trusted(core: Vec<Point>, radius: f64) -> Self {
        debug_assert!(!core.is_empty() && radius >= 0.0 && radius.is_finite());
        debug_assert!(core.iter().all(|p| p.x.is_finite() && p.y.is_finite()), "{core:?}");
        Self { core, radius }
    }

    /// The shape with other corners and another radius, for pictures. Of a scene's own pieces the radius may be negative.
    #[must_use]
    pub fn mapped(&self, corner: impl Fn(Point) -> Point, radius: f64) -> Self {
        Self { core: self.core.iter().copied().map(corner).collect(), radius }
    }

    /// [`Convex::segment`] of points that are known to be finite.
    #[must_use]
    pub fn between(a: Point, b: Point) -> Self {
        Self::trusted(if a == b { vec![a] } else { vec![a, b] }, 0.0)
    }

    /// A point that is known to be finite.
    #[must_use]
    pub fn point(p: Point) -> Self {
        Self::trusted(vec![p], 0.0)
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
    ///
    /// # Panics
    /// When the radius becomes negative, or not finite.
    #[must_use]
    #[track_caller]
    pub fn grown(&self, distance: f64) -> Self {
        let radius = self.radius + distance;
        assert!(radius >= 0.0 && radius.is_finite(), "no convex shape: a radius of {radius}");
        Self { core: self.core.clone(), radius }
    }

    /// The same shape, met only by what comes nearer than it would have to by `distance`: every signed distance from it is
    /// greater by that, exactly. Where the radius becomes negative and cores overlap, that is by less than their
    /// *penetration depth*; no shape of points does this, as one that is smaller on every side has other corners.
    #[must_use]
    pub fn receding(&self, distance: f64) -> Self {
        debug_assert!(distance >= 0.0 && distance.is_finite());
        Self { core: self.core.clone(), radius: self.radius - distance }
    }

    /// The differences `q - p` of the points `q` of this shape and `p` of `other`: the translations that make `other`
    /// meet this shape, its *C-obstacle*. The radii add up, exactly, and the cores' difference is counter-clockwise from its
    /// lowest (of these the leftmost) corner, each coordinate one difference of the cores' coordinates, rounded once. By one
    /// sweep over the directions of the sides (T. Lozano-Perez, *Spatial Planning: A Configuration Space Approach*, 1983):
    /// `O(n + m)`, at most `n + m` corners.
    #[must_use]
    pub fn minkowski_difference(&self, other: &Self) -> Self {
        Self { core: super::minkowski_difference(&self.core, &other.core), radius: self.radius + other.radius }
    }

    /// The shape moved by `pose`, up to rounding.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        Self { core: self.core.iter().map(|p| pose * p).collect(), radius: self.radius }
    }

    /// Greatest distance of a point of the shape (with a negative radius, of its core) from `pivot`, metres.
    #[must_use]
    pub fn reach_from(&self, pivot: Point) -> f64 {
        reach(&self.core, pivot) + self.radius.max(0.0)
    }

    /// The smallest box with sides along the axes that holds the shape; with a negative radius, its core.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let radius = Vector::repeat(self.radius.max(0.0));
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

    /// Whether it is a polygon whose corners are all on one line, but for what rounding makes of their coordinates.
    pub fn is_sliver(&self) -> bool {
        let [first, others @ ..] = &self.core[..] else { return false };
        let twice: f64 = others.windows(2).map(|pair| super::cross(pair[0] - first, pair[1] - first).abs()).sum();
        let largest = self.core.iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
        let long = others.iter().map(|p| (p - first).norm()).fold(0.0, f64::max);
        self.radius == 0.0 && others.len() > 1 && twice <= 64.0 * f64::EPSILON * largest * long
    }
}

/// Greatest distance of any of these points from `pivot`.
pub fn reach(points: &[Point], pivot: Point) -> f64 {
    points.iter().map(|p| (p - pivot).norm_squared()).fold(0.0, f64::max).sqrt()
}
