//! Configuration space as polygons.

use super::Proves;
use crate::geometry::Point;
use crate::space::Topology;

/// A simple polygon with holes: the outer contour counter-clockwise, holes clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Outer contour.
    pub outer: Vec<Point>,
    /// Contours of the holes.
    pub holes: Vec<Vec<Point>>,
}

/// The part of a C-obstacle that one obstacle contributes, as a simple polygon in unwrapped joint values; on a circle
/// axis its copies shifted by whole turns belong to it. For pictures and as input of the union.
#[derive(Debug, Clone, PartialEq)]
pub struct CObstacle {
    /// Into the workspace's obstacles.
    pub obstacle: usize,
    /// Which link would hit it.
    pub link: usize,
    /// Counter-clockwise, coordinates `(q1, q2)`.
    pub contour: Vec<Point>,
}

/// Free space as polygons over a *window* of the universal cover: on an interval the joint's limits, on a circle some
/// turns around the start, in which obstacles repeat. A planner on a torus is so a planner in the plane, whose goals
/// are all copies of the goal within the window.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    /// Of the configuration space.
    pub topology: Topology,
    /// What free and blocked prove.
    pub proves: Proves,
    /// Lower and upper value of each axis.
    pub window: [(f64, f64); 2],
    /// Each obstacle's contribution, once, not clipped to the window.
    pub obstacles: Vec<CObstacle>,
    /// The window less all obstacles: one polygon a connected component.
    pub free: Vec<Polygon>,
}
