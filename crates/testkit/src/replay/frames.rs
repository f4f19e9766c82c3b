//! Frames of links and objects.

use crate::moving::obstacle_at;
use crate::shapes::disc;
use crate::solid::{V, add, rotate, sub};
use cplan::geometry::Point;
use cplan::model::{Arm, Growth, Heights, JointType, MovingObstacle, Object, Obstacle, Shape};

/// A frame: cosine and sine of its angle, and its origin.
pub type Frame = (V, V);

/// Composes two frames; `b` is stated in the frame `a`.
pub fn compose(a: Frame, b: Frame) -> Frame {
    (rotate(b.0, a.0), add(a.1, rotate(b.1, a.0)))
}

/// Returns the inverse of a frame.
pub(super) fn inverse(a: Frame) -> Frame {
    let back = [a.0[0], -a.0[1]];
    (back, rotate([-a.1[0], -a.1[1]], back))
}

/// Returns the frame that is turned by an angle, at a place.
fn turned(angle: f64, at: V) -> Frame {
    ([angle.cos(), angle.sin()], at)
}

/// Returns the frames of both links, and the tip.
pub fn frames(arm: &Arm, q: V) -> ([Frame; 2], V) {
    let joint = |k: usize| match arm.joints[k].joint_type {
        JointType::Revolute { sign } => turned(sign * q[k], [0.0; 2]),
        JointType::Prismatic { direction } => ([1.0, 0.0], [direction.x * q[k], direction.y * q[k]]),
    };
    let first = compose(([1.0, 0.0], [arm.base.x, arm.base.y]), joint(0));
    let second = compose(compose(first, ([1.0, 0.0], [arm.offset.x, arm.offset.y])), joint(1));
    let tip = compose(second, ([1.0, 0.0], [arm.tip.x, arm.tip.y])).1;
    ([first, second], tip)
}

/// Returns the frame of an object on its trajectory, from its stops, or where it lies initially.
pub fn pose_on_trajectory(object: &Object, time: f64) -> Frame {
    let Some(trajectory) = object.trajectory.clone() else {
        return turned(object.at.rotation.angle(), [object.at.translation.x, object.at.translation.y]);
    };
    // Two points of the object determine its pose.
    let pieces = vec![disc(Point::zeros(), 0.1), disc(Point::new(1.0, 0.0), 0.1)];
    let points = Obstacle {
        name: String::new(),
        shape: Shape::Pieces,
        pieces,
        heights: Heights::ALL,
        growth: Growth::default(),
    };
    let placed = obstacle_at(&MovingObstacle { obstacle: points, trajectory }, time).pieces;
    let [origin, beside] = [0, 1].map(|k| [placed[k].core()[0].x, placed[k].core()[0].y]);
    (sub(beside, origin), origin)
}
