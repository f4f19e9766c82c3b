//! Scenes for the tests of this crate: one shape on the second link of an arm, and one obstacle.

use cplan_geometry::{Convex, Point, Vector};
use cplan_model::space::JointRange;
use cplan_model::{Arm, Growth, Heights, Joint, JointType, Obstacle, Part, Scene, Shape, Workspace};

pub fn scene(turns: [bool; 2], ranges: [JointRange; 2], offset: Vector, part: Convex, piece: Convex) -> Scene {
    let joint = |k: usize| {
        let slides = JointType::Prismatic { direction: Vector::new(0.6, 0.8) };
        let joint_type = if turns[k] { JointType::Revolute { sign: -1.0 } } else { slides };
        Joint { name: "joint".into(), joint_type, range: ranges[k], velocity: 1.0, acceleration: 1.0, jerk: None }
    };
    let part = Part {
        shape: part,
        inner: None,
        padding: 0.0,
        number: 0,
        is_visual: false,
        heights: Heights::ALL,
        body: "body".into(),
    };
    let mut arm = Arm::rr([1.0; 2], 0.1).expect("an arm");
    (arm.joints, arm.base, arm.offset, arm.tip) = ([joint(0), joint(1)], Point::new(0.1, -0.2), offset, Point::zeros());
    (arm.links[0].parts, arm.links[1].parts) = (vec![], vec![part]);
    let shape = Shape::Polygon(piece.core().to_vec());
    let obstacle =
        Obstacle { name: "o".into(), shape, pieces: vec![piece], heights: Heights::ALL, growth: Growth::default() };
    Scene::trusted(arm, Workspace::new([obstacle]))
}
