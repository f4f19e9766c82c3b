//! Shapes that must be valid, for all tests.

use cplan_geometry::{Convex, Point};

/// A convex polygon grown by a radius, which must be one.
pub fn convex(core: Vec<Point>, radius: f64) -> Convex {
    Convex::new(core, radius).expect("a convex shape")
}

/// A disc; with radius 0 a point.
pub fn disc(center: Point, radius: f64) -> Convex {
    Convex::disc(center, radius).expect("a disc")
}

/// A wall without thickness.
pub fn wall(a: Point, b: Point) -> Convex {
    Convex::segment(a, b).expect("a wall")
}
