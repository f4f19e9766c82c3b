//! Obstacles in the plane.

use super::Preference;
use super::scene_error::are_small;
use cplan_geometry::{Convex, ConvexError, Point, PolygonError, Pose, SimplePolygon};
use serde::{Deserialize, Serialize};

/// Extent along the plane's normal, metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Heights {
    /// The lower end, metres; may be infinite.
    #[serde(with = "cplan_text::number")]
    pub lower: f64,
    /// The upper end, metres; may be infinite.
    #[serde(with = "cplan_text::number")]
    pub upper: f64,
}

/// Gap, metres, up to which two heights count as touching. It is above the rounding error of heights, which are sums of
/// products of numbers that the input files state.
const ROUNDING: f64 = 1e-9;

/// Depth, metres, by which the bottom of an object may be below the top of its support without counting as a contact.
/// It is above the rounding of heights that drawings state and stacks add up. It is far below the compliance of any
/// gripper.
pub const RESTING_TOLERANCE: f64 = 1e-6;

impl Heights {
    /// All heights.
    pub const ALL: Heights = Heights { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// Returns the smallest extent that contains both.
    pub fn and(self, other: Heights) -> Heights {
        Heights { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// Returns true if the two extents may overlap. Touching counts, and so does a gap within rounding.
    pub fn meet(self, other: Heights) -> bool {
        self.meet_within(other, ROUNDING)
    }

    /// Returns true if the two extents overlap or touch even if rounding has brought them up to half a nanometre closer
    /// together.
    pub fn definitely_meet(self, other: Heights) -> bool {
        self.meet_within(other, ROUNDING / 2.0)
    }

    /// Returns true if the two extents overlap by more than rounding. Touching does not count: links of a robot rest on
    /// each other.
    pub fn overlap(self, other: Heights) -> bool {
        self.meet_within(other, -ROUNDING)
    }

    /// Returns true if an object at these heights may be in contact with something at the `other` heights. Same as
    /// [`Heights::meet`], except that an object may rest on a surface: its bottom may be up to [`RESTING_TOLERANCE`]
    /// below the surface.
    pub fn object_may_meet(self, other: Heights) -> bool {
        self.meet(other) && !self.is_above(other, RESTING_TOLERANCE - ROUNDING)
    }

    /// Returns true if an object at these heights certainly overlaps with something at the `other` heights, or touches it,
    /// and does not rest on it.
    pub fn object_definitely_meets(self, other: Heights) -> bool {
        self.definitely_meet(other) && !self.is_above(other, RESTING_TOLERANCE + ROUNDING)
    }

    /// Returns the heights that an object at these heights passes through when it is lifted by `least` to `most`
    /// metres.
    #[must_use]
    pub fn lifted(self, [least, most]: [f64; 2]) -> Self {
        Self { lower: self.lower + least, upper: self.upper + most }
    }

    fn is_above(self, other: Heights, into: f64) -> bool {
        other.upper - self.lower <= into
    }

    fn meet_within(self, other: Heights, apart: f64) -> bool {
        self.lower <= other.upper + apart && other.lower <= self.upper + apart
    }
}

/// An obstacle's shape for pictures and messages.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Corners of a simple polygon, counter-clockwise.
    Polygon(Vec<Point>),
    /// A disc, by its centre and radius.
    Circle {
        /// The centre, plane coordinates.
        center: Point,
        /// The radius, metres; 0 for a point.
        radius: f64,
    },
    /// A thin wall through these points.
    Polyline(Vec<Point>),
    /// The union of the obstacle's pieces, such as the occupied cells of a map.
    Pieces,
}

impl Shape {
    /// Returns the shape moved by `pose`.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        let moved = |points: &[Point]| points.iter().map(|&p| pose.point(p)).collect();
        match self {
            Shape::Polygon(corners) => Shape::Polygon(moved(corners)),
            Shape::Circle { center, radius } => Shape::Circle { center: pose.point(*center), radius: *radius },
            Shape::Polyline(points) => Shape::Polyline(moved(points)),
            Shape::Pieces => Shape::Pieces,
        }
    }

    /// Changes the shape to [`Shape::Pieces`] unless it consists of exactly these pieces. So pictures show the shape
    /// that collision checks use.
    pub fn restrict_to(&mut self, pieces: &[Convex]) {
        let own = match self {
            // Predicates could overflow on larger coordinates. Obstacles with such corners are invalid anyway.
            Shape::Polygon(corners) if are_small(corners.iter().flat_map(|p| [p.x, p.y])) => {
                SimplePolygon::new(corners.clone()).map(|polygon| polygon.convex_pieces()).ok()
            }
            Shape::Circle { center, radius } => Convex::disc(*center, *radius).map(|disc| vec![disc]).ok(),
            Shape::Polyline(points) => walls(points).ok(),
            Shape::Polygon(_) | Shape::Pieces => None,
        };
        if own.is_none_or(|own| own != pieces) {
            *self = Shape::Pieces;
        }
    }
}

/// Returns the shape grown by `distance`, or shrunk, but not beyond its core: rounding leaves no negative radius.
pub(super) fn resized(shape: &Convex, distance: f64) -> Convex {
    shape.grown(distance.max(-shape.radius()))
}

/// Returns the pieces of a thin wall: one segment between each two consecutive points.
fn walls(points: &[Point]) -> Result<Vec<Convex>, ConvexError> {
    match points {
        [] | [_] => Ok(vec![Convex::new(points.to_vec(), 0.0)?]),
        _ => points.windows(2).map(|ends| Convex::segment(ends[0], ends[1])).collect(),
    }
}

/// The growth of an obstacle's pieces beyond its shape. All lengths in metres.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Growth {
    /// Least distance to keep from this obstacle; the workspace's clearance counts if it is larger.
    pub clearance: f64,
    /// Greatest displacement of the obstacle in any direction, relative to the arm.
    pub error: f64,
    /// Distance that covers all other errors. Configurations within this distance need not be collisions.
    pub padding: f64,
    /// The distance by which the pieces have been grown: the clearance beyond the workspace's, the error and the padding.
    pub total: f64,
}

impl Growth {
    /// Returns true if the pieces are as large as the shape for every clearance.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// An object that the arm must not touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// The user's name for the obstacle, or a default such as `obstacle 3`.
    pub name: String,
    /// The shape as the user gave it.
    pub shape: Shape,
    /// Convex pieces whose union is the obstacle, without the workspace's clearance. They are larger than the shape by
    /// [`Growth::total`].
    pub pieces: Vec<Convex>,
    /// Extent along the plane's normal, metres.
    pub heights: Heights,
    /// The growth of the pieces beyond the shape.
    #[serde(default, skip_serializing_if = "Growth::is_none")]
    pub growth: Growth,
}

/// The obstacles, the clearance to keep from them, and the preferred regions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workspace {
    /// The title of the world.
    pub name: String,
    /// The static obstacles, in the order of the file.
    pub obstacles: Vec<Obstacle>,
    /// Least distance to keep from every obstacle, metres. With 0, any proven distance above zero is enough. See
    /// [`Workspace::set_clearance`].
    pub clearance: f64,
    /// Regions that field planners prefer or avoid, in the order of the file. Where several overlap, the last one
    /// counts.
    pub preferences: Vec<Preference>,
}

impl Obstacle {
    /// Creates a simple polygon at all heights from its corners in either orientation, metres.
    ///
    /// # Errors
    /// If the corners make no simple polygon.
    pub fn polygon(name: &str, corners: impl IntoIterator<Item = [f64; 2]>) -> Result<Self, PolygonError> {
        let polygon = SimplePolygon::new(points(corners))?;
        let (shape, pieces) = (Shape::Polygon(polygon.corners().to_vec()), polygon.convex_pieces());
        Ok(Self { name: name.into(), shape, pieces, heights: Heights::ALL, growth: Growth::default() })
    }

    /// Creates a disc at all heights. Centre and radius in metres.
    ///
    /// # Errors
    /// If a number is not finite, or the radius is negative.
    pub fn circle(name: &str, center: [f64; 2], radius: f64) -> Result<Self, ConvexError> {
        let center = Point::from(center);
        let pieces = vec![Convex::disc(center, radius)?];
        let shape = Shape::Circle { center, radius };
        Ok(Self { name: name.into(), shape, pieces, heights: Heights::ALL, growth: Growth::default() })
    }

    /// Creates a thin wall through these points, metres, at all heights. It has no area, but the arm must not touch
    /// it. A single point is allowed.
    ///
    /// # Errors
    /// If there is no point, or a number is not finite.
    pub fn polyline(name: &str, through: impl IntoIterator<Item = [f64; 2]>) -> Result<Self, ConvexError> {
        let points = points(through);
        let pieces = walls(&points)?;
        let shape = Shape::Polyline(points);
        Ok(Self { name: name.into(), shape, pieces, heights: Heights::ALL, growth: Growth::default() })
    }
}

impl Obstacle {
    /// Returns the obstacle moved by `pose`.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        let pieces = self.pieces.iter().map(|piece| piece.at(pose)).collect();
        Self { name: self.name.clone(), shape: self.shape.at(pose), pieces, ..*self }
    }

    /// Returns the pieces at their real size, without any growth.
    pub fn real_pieces(&self) -> Vec<Convex> {
        self.pieces.iter().map(|piece| resized(piece, -self.growth.total)).collect()
    }

    /// Makes the pieces as large as [`Obstacle::growth`] requires in a workspace of this clearance, metres.
    pub fn grow(&mut self, clearance: f64) {
        let growth = &mut self.growth;
        let total = (growth.clearance - clearance).max(0.0) + growth.error + growth.padding;
        if total != growth.total {
            self.pieces.iter_mut().for_each(|piece| *piece = resized(piece, total - growth.total));
            growth.total = total;
        }
    }

    /// Changes the shape in pictures so that it agrees with the pieces that collision checks use. For obstacles that
    /// are read from files.
    pub fn derive_shape_from_pieces(&mut self) {
        self.shape.restrict_to(&self.real_pieces());
    }
}

fn points(coordinates: impl IntoIterator<Item = [f64; 2]>) -> Vec<Point> {
    coordinates.into_iter().map(Point::from).collect()
}

impl Workspace {
    /// Creates a workspace of these obstacles, with clearance 0.
    pub fn new(obstacles: impl IntoIterator<Item = Obstacle>) -> Self {
        let obstacles = obstacles.into_iter().collect();
        Self { name: String::new(), obstacles, clearance: 0.0, preferences: Vec::new() }
    }

    /// Changes the shapes in pictures so that they agree with the pieces that collision checks use. For workspaces that
    /// are read from files.
    pub fn restrict_shapes(&mut self) {
        self.obstacles.iter_mut().for_each(Obstacle::derive_shape_from_pieces);
    }

    /// Returns the greatest clearance that the workspace or one of its obstacles has, metres.
    pub fn greatest_clearance(&self) -> f64 {
        self.obstacles.iter().map(|obstacle| obstacle.growth.clearance).fold(self.clearance, f64::max)
    }

    /// Lowers the clearances of the workspace and of its obstacles to at most this one, metres.
    pub fn limit_clearances(&mut self, clearance: f64) {
        for obstacle in &mut self.obstacles {
            obstacle.growth.clearance = obstacle.growth.clearance.min(clearance);
        }
        self.set_clearance(self.clearance.min(clearance));
    }

    /// Changes the clearance, metres. Obstacles with a clearance of their own keep it if it is larger.
    pub fn set_clearance(&mut self, clearance: f64) {
        self.clearance = clearance;
        self.obstacles.iter_mut().for_each(|obstacle| obstacle.grow(clearance));
    }
}
