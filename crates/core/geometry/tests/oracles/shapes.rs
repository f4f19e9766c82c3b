//! Shapes that must be valid, for all tests.

use cplan_geometry::{Convex, Point};

/// Returns a convex polygon grown by a radius. The arguments must be valid.
pub fn convex(core: Vec<Point>, radius: f64) -> Convex {
    Convex::new(core, radius).expect("a convex shape")
}

/// Returns a disc, or a point if the radius is 0.
pub fn disc(center: Point, radius: f64) -> Convex {
    Convex::disc(center, radius).expect("a disc")
}

/// Returns a wall without thickness.
pub fn wall(a: Point, b: Point) -> Convex {
    Convex::segment(a, b).expect("a wall")
}
