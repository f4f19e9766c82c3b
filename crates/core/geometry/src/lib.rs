//! Plane geometry: exact predicates, convex shapes, Minkowski differences, sets of intervals, and the angles or
//! displacements at which a moving convex shape meets a fixed one.
//!
//! Lengths are metres, angles radians. Polygons are counter-clockwise lists of corners without repetition of the first.
//! Every *sign* (of a side, of a contact) comes from adaptive exact arithmetic. Every *measure* (distance, depth) is a
//! plain `f64`. Touching counts as contact everywhere.
//!
//! ```
//! use cplan_geometry::{Convex, Point, penetration_depth, shapes_meet};
//!
//! let square = |x: f64| Convex::new([[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]].map(Point::from).to_vec(), 0.0);
//! let (a, b) = (square(0.0)?, square(0.75)?);
//! // `b` meets `a` after a move by any vector inside the Minkowski difference of the two.
//! assert_eq!(a.minkowski_difference(&b).area(), 4.0);
//! assert!(shapes_meet(&a, &b));
//! assert_eq!(penetration_depth(&a, &b), 0.25);
//! # Ok::<(), cplan_geometry::ConvexError>(())
//! ```

mod box_tree;
mod convex;
mod decompose;
mod inset_union;
mod erosion;
mod galloping;
mod hull;
mod inset;
mod intervals;
mod meet;
mod minkowski;
mod open_list;
mod ordered;
mod penetration;
pub mod planar;
mod polygon;
mod pose;
mod predicates;
mod rings;
mod separation;
mod simple_test;
mod sliding;
mod turning;

pub use box_tree::{Bounds, BoxTree};
pub use convex::{Convex, ConvexError, reach};
pub use decompose::{MAX_CORNERS, decompose};
pub use galloping::farthest;
pub use hull::hull;
pub use inset::{common, inset};
pub use inset_union::{can_inset_union, inset_union};
pub use intervals::{Interval, merge_in_place};
pub use meet::shapes_meet;
pub use minkowski::{minkowski_difference, penetration_depth};
pub use open_list::OpenList;
pub use ordered::OrderedF64;
pub use penetration::{
    CornerInside, Location, PointPenetration, PolygonTest, point_penetration, polygon_test, signed_distance,
};
pub use polygon::{PolygonError, SimplePolygon};
pub use pose::Pose;
pub use predicates::{Orientation, in_circle, orientation, point_on_segment, segments_cross, segments_meet};
pub use rings::{Polygon, RingError, RingSide};
pub use separation::{Separation, gap_along, separation, separation_at};
pub use simple_test::{SimpleDifference, simple_difference, simple_polygon_test};
pub use sliding::{along_and_across, sliding, sliding_tracks};
pub use turning::{Features, Hits, ROUNDING, normalized, product, turning, turning_from};

/// A displacement in the plane, metres.
pub type Vector = nalgebra::Vector2<f64>;
/// A position in the plane, metres, given as its displacement from the origin. The type is that of [`Vector`], so no
/// conversions are needed. Signatures state which of the two is meant.
pub type Point = Vector;

/// Returns `v` rotated by a quarter turn counter-clockwise.
pub fn perpendicular(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// Returns the z component of the cross product. It is positive if `b` lies counter-clockwise of `a`.
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}
