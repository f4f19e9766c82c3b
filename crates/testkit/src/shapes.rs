//! Shapes made from arguments that must be valid.

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

/// Returns the rectangle `[x0, x1] x [y0, y1]`.
pub fn rectangle(x0: f64, x1: f64, y0: f64, y1: f64) -> Convex {
    convex(vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)], 0.0)
}
