//! Obstacles in the plane.

use super::Preference;
use crate::geometry::{Convex, Point, Pose};

/// Extent along the plane's normal, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heights {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

impl Heights {
    /// All heights.
    pub const ALL: Heights = Heights { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// Whether the two extents share a height; touching counts.
    #[must_use]
    pub fn meet(self, other: Heights) -> bool {
        self.lower <= other.upper && other.lower <= self.upper
    }
}

/// An obstacle's shape as the user gave it, for pictures and messages.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Corners of a simple polygon, counter-clockwise.
    Polygon(Vec<Point>),
    /// A disc.
    Circle {
        /// Its centre.
        center: Point,
        /// Its radius, metres; 0 for a point.
        radius: f64,
    },
    /// A thin wall.
    Polyline(Vec<Point>),
    /// The union of the obstacle's pieces, such as the occupied cells of a map.
    Pieces,
}

impl Shape {
    /// The shape moved by `pose`.
    #[must_use]
    pub fn at(&self, pose: &Pose) -> Self {
        let moved = |points: &[Point]| points.iter().map(|p| pose * p).collect();
        match self {
            Shape::Polygon(corners) => Shape::Polygon(moved(corners)),
            Shape::Circle { center, radius } => Shape::Circle { center: pose * center, radius: *radius },
            Shape::Polyline(points) => Shape::Polyline(moved(points)),
            Shape::Pieces => Shape::Pieces,
        }
    }
}

/// Something the arm must not touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// The user's name for it, or `obstacle 3`.
    pub name: String,
    /// As given.
    pub shape: Shape,
    /// The same as a union of convex pieces, without any clearance.
    pub pieces: Vec<Convex>,
    /// Where it is along the plane's normal.
    pub heights: Heights,
}

/// The obstacles, the distance to keep from them, and where to be rather than elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Workspace {
    /// Title.
    pub name: String,
    /// In the order of the file.
    pub obstacles: Vec<Obstacle>,
    /// Least distance to keep from every obstacle, metres. With 0 any proven distance above zero will do.
    pub clearance: f64,
    /// Regions that field planners may prefer or avoid, in the order of the file; of several that hold the last counts.
    pub preferences: Vec<Preference>,
}
