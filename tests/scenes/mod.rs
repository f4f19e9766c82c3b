//! Arms and obstacles for tests and benchmarks.
#![allow(dead_code, reason = "every test and benchmark uses some of it")]

use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{
    Arm, Goal, Heights, Joint, Link, Motion, Obstacle, OutlineSource, Part, Plane, Problem, Scene, Shape, Workspace,
};
use cplan::space::{Axis, Configuration};

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

/// Two bars of 1.0 m and 0.8 m, 0.1 m wide, whose joints both have this axis.
pub fn bars(axis: Axis) -> Arm {
    let turning = |name| joint(name, Motion::Revolute { sign: 1.0 }, axis);
    arm(
        Point::origin(),
        Vector::new(1.0, 0.0),
        [turning("j1"), turning("j2")],
        [vec![bar(1.0, 0.05)], vec![bar(0.8, 0.05)]],
    )
}

/// The obstacles of benchmark problem A: four of them leave a passage 0.070 rad wide.
pub fn narrow_passage() -> Vec<Convex> {
    let polygon = |corners: &[(f64, f64)]| Convex::new(corners.iter().map(|&(x, y)| Point::new(x, y)).collect(), 0.0);
    vec![
        polygon(&[(-0.21, -0.85), (-0.03, -1.20), (0.22, -1.21), (0.44, -0.93), (0.27, -0.62), (-0.09, -0.65)]),
        polygon(&[(0.99, -0.17), (1.14, -0.35), (1.38, -0.27), (1.42, -0.16), (1.28, 0.07), (1.04, 0.0)]),
        polygon(&[(0.11, 1.33), (0.27, 1.12), (0.53, 1.19), (0.51, 1.51), (0.20, 1.53)]),
        polygon(&[(-1.02, 0.33), (-0.89, 0.12), (-0.63, 0.32), (-0.85, 0.51)]),
    ]
}

/// Small regular polygons with 4 to 7 corners on a spiral.
pub fn spiral(count: u8) -> Vec<Convex> {
    let polygon = |i: u8| {
        let (index, corners) = (f64::from(i), 4 + i % 4);
        let angle = 2.399_963 * index;
        let radius = 0.55 + 1.15 * ((index + 0.5) / f64::from(count)).sqrt();
        let center = Vector::new(radius * angle.cos(), radius * angle.sin());
        let corner = |k: u8| {
            let turn = 0.7 * index + std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            Point::from(center + 0.08 * Vector::new(turn.cos(), turn.sin()))
        };
        Convex::new((0..corners).map(corner).collect(), 0.0)
    };
    (0..count).map(polygon).collect()
}

/// The benchmark problem W20: two bars on the torus among 20 polygons on a spiral.
pub fn w20() -> Scene {
    scene(bars(Axis::Circle), spiral(20))
}

/// The benchmark problem A: two bars on the torus and a narrow passage between start and goal.
pub fn problem_a() -> Problem {
    let goal = Configuration::new(1.75, 0.5);
    Problem {
        scene: scene(bars(Axis::Circle), narrow_passage()),
        start: Configuration::new(-0.7, 0.0),
        goal: Goal::Joints(goal),
        goals: vec![goal],
    }
}
