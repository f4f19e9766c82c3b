//! Arms and obstacles for tests and benchmarks.

use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{Arm, Heights, Joint, Link, Motion, Obstacle, OutlineSource, Part, Plane, Scene, Shape, Workspace};
use cplan::space::Axis;

/// A joint with limits on speed and acceleration of 1.
pub fn joint(name: &str, motion: Motion, axis: Axis) -> Joint {
    Joint { name: name.into(), motion, axis, velocity: 1.0, acceleration: 1.0 }
}

/// An arm in the xy plane with one convex part list a link.
pub fn arm(base: Point, offset: Vector, joints: [Joint; 2], outlines: [Vec<Convex>; 2]) -> Arm {
    let mut names = ["upper", "lower"].into_iter();
    let links = outlines.map(|shapes| {
        let name: String = names.next().unwrap_or_default().into();
        let part = |shape| Part { shape, heights: Heights::ALL, body: name.clone() };
        Link { parts: shapes.into_iter().map(part).collect(), source: OutlineSource::Collision, name: name.clone() }
    });
    let plane = Plane { u: [1.0, 0.0, 0.0].into(), v: [0.0, 1.0, 0.0].into(), normal: [0.0, 0.0, 1.0].into() };
    let tip = Point::new(1.0, 0.0);
    Arm { name: "arm".into(), joints, links, base, offset, tip, tip_name: "tip".into(), plane }
}

/// One obstacle a convex shape.
pub fn scene(arm: Arm, pieces: Vec<Convex>) -> Scene {
    let obstacle = |(i, piece): (usize, Convex)| Obstacle {
        name: format!("obstacle {i}"),
        shape: Shape::Polygon(piece.core().to_vec()),
        pieces: vec![piece],
        heights: Heights::ALL,
    };
    let obstacles = pieces.into_iter().enumerate().map(obstacle).collect();
    Scene::new(arm, Workspace { name: "scene".into(), obstacles, clearance: 0.0 })
}

/// A bar along x from the origin.
pub fn bar(length: f64, half_width: f64) -> Convex {
    let corner = |x: f64, y: f64| Point::new(x * length, y * half_width);
    Convex::new(vec![corner(0.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(0.0, 1.0)], 0.0)
}

/// The benchmark problem W20: two bars on the torus among 20 small regular polygons on a spiral.
pub fn w20() -> Scene {
    let turning = || Motion::Revolute { sign: 1.0 };
    let joints = [joint("j1", turning(), Axis::Circle), joint("j2", turning(), Axis::Circle)];
    let arm = arm(Point::origin(), Vector::new(1.0, 0.0), joints, [vec![bar(1.0, 0.05)], vec![bar(0.8, 0.05)]]);
    let pieces = (0..20u8).map(|i| {
        let (index, corners) = (f64::from(i), 4 + i % 4);
        let angle = 2.399_963 * index;
        let radius = 0.55 + 1.15 * ((index + 0.5) / 20.0).sqrt();
        let center = Vector::new(radius * angle.cos(), radius * angle.sin());
        let corner = |k: u8| {
            let turn = 0.7 * index + std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            Point::from(center + 0.08 * Vector::new(turn.cos(), turn.sin()))
        };
        Convex::new((0..corners).map(corner).collect(), 0.0)
    });
    scene(arm, pieces.collect())
}
