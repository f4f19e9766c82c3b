//! Obstacles in the plane.

use super::Preference;
use super::scene_error::are_small;
use cplan_geometry::{Convex, ConvexError, Point, PolygonError, Pose, SimplePolygon};
use serde::{Deserialize, Serialize};

/// Extent along the plane's normal, metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Heights {
    /// The lower end of the extent.
    #[serde(with = "cplan_text::number")]
    pub lower: f64,
    /// The upper end of the extent.
    #[serde(with = "cplan_text::number")]
    pub upper: f64,
}

/// Rounding of heights, which are sums of products of stated numbers: at least this, metres.
const ROUNDING: f64 = 1e-9;

/// Depth along the plane's normal to which an object may reach into its support without a contact, metres. It is above
/// the rounding of heights that drawings state and stacks add up, and far below the compliance of any gripper.
pub const RESTING_TOLERANCE: f64 = 1e-6;

impl Heights {
    /// The extent that holds all heights.
    pub const ALL: Heights = Heights { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// Returns the extent from the lower of two floors to the higher of two tops.
    #[must_use]
    pub fn and(self, other: Heights) -> Heights {
        Heights { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// Returns true if the two extents may share a height. Touching counts, and so does a gap within rounding.
    #[must_use]
    pub fn meet(self, other: Heights) -> bool {
        self.meet_within(other, ROUNDING)
    }

    /// Returns true if the two extents certainly share a height, by more than rounding.
    #[must_use]
    pub fn definitely_meet(self, other: Heights) -> bool {
        self.meet_within(other, -ROUNDING)
    }

    /// Returns true if an object at these heights may be in contact with something at others. Same as
    /// [`Heights::meet`], but an object rests on a surface that its bottom touches to within [`RESTING_TOLERANCE`].
    #[must_use]
    pub fn object_may_meet(self, other: Heights) -> bool {
        self.meet(other) && !self.is_above(other, RESTING_TOLERANCE - ROUNDING)
    }

    /// Returns true if an object at these heights certainly shares a height with something at others, by more than
    /// rounding, and does not rest on it.
    #[must_use]
    pub fn object_definitely_meets(self, other: Heights) -> bool {
        self.definitely_meet(other) && !self.is_above(other, RESTING_TOLERANCE + ROUNDING)
    }

    /// Returns the heights of an object at these heights, lifted by anything from `least` to `most`.
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

/// An obstacle's shape as given by the user, for pictures and messages.
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
    /// A thin wall.
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

    /// Keeps the shape if it consists of exactly these pieces. Otherwise the pieces become the shape, because pictures
    /// must show the outline that is judged.
    pub fn restrict_to(&mut self, pieces: &[Convex]) {
        let own = match self {
            // Predicates would overflow on other polygons, which have no valid pieces.
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

/// Returns the pieces of a thin wall.
fn walls(points: &[Point]) -> Result<Vec<Convex>, ConvexError> {
    match points {
        [] | [_] => Ok(vec![Convex::new(points.to_vec(), 0.0)?]),
        _ => points.windows(2).map(|ends| Convex::segment(ends[0], ends[1])).collect(),
    }
}

/// An object that the arm must not touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// The user's name for it, or `obstacle 3`.
    pub name: String,
    /// The shape as given by the user.
    pub shape: Shape,
    /// The obstacle as a union of convex pieces, without any clearance.
    pub pieces: Vec<Convex>,
    /// Extent along the plane's normal.
    pub heights: Heights,
}

/// The obstacles, the distance to keep from them, and the preferred regions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workspace {
    /// The title of the world.
    pub name: String,
    /// Static obstacles, in the order of the file.
    pub obstacles: Vec<Obstacle>,
    /// Least distance to keep from every obstacle, metres. With 0 any proven distance above zero is enough.
    pub clearance: f64,
    /// Regions that field planners may prefer or avoid, in the order of the file; where several apply, the last one
    /// counts.
    pub preferences: Vec<Preference>,
}

impl Obstacle {
    /// Creates a simple polygon of either orientation, at all heights. Corners in metres, in order around the shape.
    ///
    /// # Errors
    /// Corners of no simple polygon.
    pub fn polygon(name: &str, corners: impl IntoIterator<Item = [f64; 2]>) -> Result<Self, PolygonError> {
        let polygon = SimplePolygon::new(points(corners))?;
        let (shape, pieces) = (Shape::Polygon(polygon.corners().to_vec()), polygon.convex_pieces());
        Ok(Self { name: name.into(), shape, pieces, heights: Heights::ALL })
    }

    /// Creates a disc, metres.
    ///
    /// # Errors
    /// Numbers that are not finite, and a negative radius.
    pub fn circle(name: &str, center: [f64; 2], radius: f64) -> Result<Self, ConvexError> {
        let center = Point::from(center);
        let pieces = vec![Convex::disc(center, radius)?];
        Ok(Self { name: name.into(), shape: Shape::Circle { center, radius }, pieces, heights: Heights::ALL })
    }

    /// Creates a thin wall through these points, metres. It has no area, but is solid; with one point it is a point.
    ///
    /// # Errors
    /// No point at all, and numbers that are not finite.
    pub fn polyline(name: &str, through: impl IntoIterator<Item = [f64; 2]>) -> Result<Self, ConvexError> {
        let points = points(through);
        let pieces = walls(&points)?;
        Ok(Self { name: name.into(), shape: Shape::Polyline(points), pieces, heights: Heights::ALL })
    }
}

impl Obstacle {
    /// Returns the obstacle moved by `pose`.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        let pieces = self.pieces.iter().map(|piece| piece.at(pose)).collect();
        Self { name: self.name.clone(), shape: self.shape.at(pose), pieces, heights: self.heights }
    }

    /// Makes the displayed shape agree with the pieces that are judged. For obstacles that are read as data.
    pub fn hold_shape(&mut self) {
        self.shape.restrict_to(&self.pieces);
    }
}

fn points(coordinates: impl IntoIterator<Item = [f64; 2]>) -> Vec<Point> {
    coordinates.into_iter().map(Point::from).collect()
}

impl Workspace {
    /// Creates a workspace of these obstacles, without a clearance to keep.
    #[must_use]
    pub fn new(obstacles: impl IntoIterator<Item = Obstacle>) -> Self {
        let obstacles = obstacles.into_iter().collect();
        Self { name: String::new(), obstacles, clearance: 0.0, preferences: Vec::new() }
    }

    /// Makes the displayed shapes agree with the pieces that are judged. For workspaces that are read as data.
    pub fn restrict_shapes(&mut self) {
        self.obstacles.iter_mut().for_each(Obstacle::hold_shape);
    }
}
