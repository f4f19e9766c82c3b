//! parry2d as an oracle, and the conversions to its types.

use cplan_geometry::{Convex, Point};
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::SharedShape;

fn vector(p: &Point) -> Vector {
    Vector::new(p.x, p.y)
}

/// Returns the core as a shape of parry. `None` if parry refuses a sliver.
fn core(shape: &Convex) -> Option<(Pose, SharedShape)> {
    Some(match shape.core() {
        [p] => (Pose::from_translation(vector(p)), SharedShape::ball(0.0)),
        [p, q] => (Pose::identity(), SharedShape::segment(vector(p), vector(q))),
        corners => (Pose::identity(), SharedShape::convex_polyline_unmodified(corners.iter().map(vector).collect())?),
    })
}

/// Returns the distance between the cores of two shapes, 0 if they meet. `None` if parry cannot represent them.
pub fn core_distance(a: &Convex, b: &Convex) -> Option<f64> {
    let ((p, a), (q, b)) = (core(a)?, core(b)?);
    query::distance(&p, a.as_ref(), &q, b.as_ref()).ok().map(|found| found.distance)
}
