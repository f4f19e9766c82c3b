//! Arms made in code.

use crate::shapes::{convex, disc, rectangle};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{Arm, Heights, Joint, JointType, Link, OutlineSource, Part};
use cplan::space::JointRange;
use std::f64::consts::FRAC_PI_2;

/// Returns a link with these convex parts, which all have the same heights.
pub fn link(name: &str, shapes: Vec<Convex>) -> Link {
    let parts = shapes
        .into_iter()
        .map(|shape| Part {
            shape,
            inner: None,
            padding: 0.0,
            number: 0,
            is_visual: false,
            heights: Heights { lower: 0.0, upper: 0.1 },
            body: name.into(),
        })
        .collect();
    Link { name: name.into(), parts, source: OutlineSource::Collision }
}

/// Returns a joint with a speed of at most 1 and an acceleration of at most 4.
pub fn joint(name: &str, joint_type: JointType, range: JointRange) -> Joint {
    Joint { name: name.into(), joint_type, range, velocity: 1.0, acceleration: 4.0, jerk: None }
}

/// Returns an arm with its base at the origin, and its second joint at `offset` from the first one.
pub fn arm(joints: [Joint; 2], links: [Link; 2], offset: Vector, tip: Point) -> Arm {
    Arm { name: "test arm".into(), offset, tip, ..Arm::new(joints, links, [0.0; 2]) }
}

/// Returns an arm with two bars, 1.0 and 0.8 m long and 0.1 m wide, and the joint ranges `axes`.
pub fn rr(axes: [JointRange; 2]) -> Arm {
    let turn = JointType::Revolute { sign: 1.0 };
    arm(
        [joint("shoulder", turn, axes[0]), joint("elbow", turn, axes[1])],
        [link("upper", vec![rectangle(0.0, 1.0, -0.05, 0.05)]), link("fore", vec![rectangle(0.0, 0.8, -0.05, 0.05)])],
        Vector::new(1.0, 0.0),
        Point::new(0.8, 0.0),
    )
}

/// Returns an arm with two prismatic joints in directions at these angles, with a common range. The second one carries the shapes
/// of a tool.
pub fn slides(angles: [f64; 2], [lower, upper]: [f64; 2], tool: Vec<Convex>) -> Arm {
    let slide = |name, angle: f64| {
        // Right angles have exact directions.
        let direction = Vector::new(angle.cos(), angle.sin()).map(|c| if c.abs() < 1e-15 { 0.0 } else { c });
        joint(name, JointType::Prismatic { direction }, JointRange::Interval { lower, upper })
    };
    let links = [link("bridge", Vec::new()), link("tool", tool)];
    arm([slide("x", angles[0]), slide("y", angles[1])], links, Vector::zeros(), Point::zeros())
}

/// Returns an arm that slides along x and y.
pub fn gantry(range: [f64; 2], tool: Vec<Convex>) -> Arm {
    slides([0.0, FRAC_PI_2], range, tool)
}

/// Returns one arm of every kind. Some axes are reversed or oblique, and some outlines are beside the joints.
pub fn all_kinds() -> Vec<Arm> {
    let turn = |sign| JointType::Revolute { sign };
    let slide = |x: f64, y: f64| JointType::Prismatic { direction: Vector::new(x, y).normalize() };
    let range = |lower, upper| JointRange::Interval { lower, upper };
    let first = || link("first", vec![rectangle(-0.1, 0.6, -0.05, 0.04), disc(Point::new(0.6, 0.0), 0.07)]);
    let second = || {
        link(
            "second",
            vec![rectangle(-0.05, 0.5, -0.03, 0.05), convex(vec![Point::new(0.5, -0.1), Point::new(0.5, 0.2)], 0.02)],
        )
    };
    let make = |one, two| arm([one, two], [first(), second()], Vector::new(0.6, 0.05), Point::new(0.5, 0.0));
    vec![
        rr([JointRange::Circle, JointRange::Circle]),
        make(joint("a", turn(-1.0), range(-4.0, 3.5)), joint("b", turn(1.0), JointRange::Circle)),
        make(joint("a", turn(1.0), JointRange::Circle), joint("b", slide(1.0, 0.3), range(-0.2, 0.9))),
        make(joint("a", slide(0.2, 1.0), range(-1.0, 1.0)), joint("b", turn(-1.0), range(-2.5, 2.5))),
        make(joint("a", slide(1.0, 0.0), range(-1.0, 1.0)), joint("b", slide(0.3, 1.0), range(-0.8, 0.8))),
    ]
}
