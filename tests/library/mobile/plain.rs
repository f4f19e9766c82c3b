//! Distances by formulas of the tests: from segments and discs, and whether a place is inside a polygon.

use cplan::Point;
use cplan::model::{Scene, Shape};
use cplan_cases::plane;

/// Radius of the robot's body, `robots/mobile_robot.urdf`, metres.
pub const RADIUS: f64 = 0.25;

/// Returns the distance between a point and a segment: to the foot of the perpendicular if that is on the segment,
/// otherwise to the nearer end.
pub fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    plane::distance_to_segment(p.into(), [a.into(), b.into()])
}

/// Returns the distance between the robot's body and a shape of the world file. It is not positive if they meet.
fn to_shape(p: Point, shape: &Shape) -> f64 {
    let open = |corners: &[Point]| corners.windows(2).map(|w| to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min);
    let distance = match shape {
        Shape::Circle { center, radius } => (p.x - center.x).hypot(p.y - center.y) - radius,
        Shape::Polyline(points) => open(points),
        Shape::Polygon(corners) => {
            let corners: Vec<plane::Point> = corners.iter().map(|&corner| corner.into()).collect();
            plane::polygon_distance(&[p.into()], &corners)
        }
        Shape::Pieces => panic!("no world here has such obstacles"),
    };
    distance - RADIUS
}

/// Returns the distance between a robot's body at a place and the nearest obstacle.
pub fn gap(scene: &Scene, p: Point) -> f64 {
    scene.workspace().obstacles.iter().map(|obstacle| to_shape(p, &obstacle.shape)).fold(f64::INFINITY, f64::min)
}

/// Returns the least distance between the robot's body and obstacles along a path whose points are close together.
pub fn least_gap(scene: &Scene, way: &[Point]) -> f64 {
    way.iter().map(|&p| gap(scene, p)).fold(f64::INFINITY, f64::min)
}
