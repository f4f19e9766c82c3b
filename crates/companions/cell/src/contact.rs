//! The change of the distance of two shapes while the joints of an arm move.

use cplan_geometry::{Convex, Point, Separation, Vector, perpendicular};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};

/// Difference of two lengths, metres, below which corners count as equally far.
const EQUAL: f64 = 1e-9;

/// Returns a point of the first shape at which it is nearest to the second, or deepest in it. If sides face each other, it is in
/// the middle of their common part.
pub(crate) fn contact_point(a: &Convex, b: &Convex, here: Separation) -> Point {
    let n = here.direction;
    let along = perpendicular(n);
    // Returns the range of the farthest corners across the direction, and how far they are.
    let side = |shape: &Convex, sign: f64| {
        let far = |p: &Point| sign * n.dot(p);
        let most = shape.core().iter().map(far).fold(f64::NEG_INFINITY, f64::max);
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for p in shape.core().iter().filter(|p| far(p) >= most - EQUAL) {
            range = [range[0].min(along.dot(p)), range[1].max(along.dot(p))];
        }
        (range, most)
    };
    let ((one, far), (two, _)) = (side(a, 1.0), side(b, -1.0));
    let common = [one[0].max(two[0]), one[1].min(two[1])];
    let across = if common[0] <= common[1] {
        f64::midpoint(common[0], common[1])
    } else if two[0] > one[1] {
        one[1]
    } else {
        one[0]
    };
    n * (far + a.radius()) + along * across
}

/// Returns the speed along `direction` of the point of a link (numbered as in [`cplan_model::Pair::link`]) that is at `at`, per unit of each joint's
/// speed.
pub(crate) fn rates(arm: &Arm, link: usize, q: Configuration, at: Point, direction: Vector) -> [f64; 2] {
    let first = match arm.joints[0].joint_type {
        _ if link == 2 => 0.0,
        JointType::Revolute { sign } => sign * direction.dot(&perpendicular(at - arm.base)),
        JointType::Prismatic { direction: axis } => direction.dot(&axis),
    };
    let q1 = if link == 2 { 0.0 } else { q[0] };
    let second = match arm.joints[1].joint_type {
        _ if link == 0 => 0.0,
        JointType::Revolute { sign } => sign * direction.dot(&perpendicular(at - arm.elbow_at(q1))),
        JointType::Prismatic { direction: axis } => {
            direction.dot(&arm.pose(0, Configuration::new(q1, 0.0)).direction(axis))
        }
    };
    [first, second]
}
