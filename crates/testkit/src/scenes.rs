//! Scenes made in code, and configurations of their arms.

use crate::arms::rr;
use crate::shapes::{convex, disc, rectangle, wall};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{Arm, Growth, Heights, Obstacle, Scene, Shape, Workspace};
use cplan::space::{Configuration, JointRange};
use cplan_cases::dice::Dice;
use std::f64::consts::PI;

/// Returns the configuration with these joint values.
pub fn q(a: f64, b: f64) -> Configuration {
    Configuration::new(a, b)
}

/// Returns an obstacle of one piece.
pub fn obstacle(name: &str, piece: Convex) -> Obstacle {
    let shape = match piece.core() {
        [center] => Shape::Circle { center: *center, radius: piece.radius() },
        [a, b] => Shape::Polyline(vec![*a, *b]),
        corners => Shape::Polygon(corners.to_vec()),
    };
    Obstacle { name: name.into(), shape, pieces: vec![piece], heights: Heights::ALL, growth: Growth::default() }
}

/// Returns the scene of an arm in a workspace. Panics if either is invalid.
pub fn placed(arm: Arm, workspace: Workspace) -> Scene {
    Scene::new(arm, workspace).expect("a scene")
}

/// Returns the scene of an arm among these obstacles, without a required clearance.
pub fn scene(arm: Arm, pieces: Vec<Convex>) -> Scene {
    let obstacles = pieces.into_iter().enumerate().map(|(i, p)| obstacle(&format!("o{i}"), p)).collect();
    placed(arm, Workspace { name: "test".into(), obstacles, clearance: 0.0, preferences: Vec::new() })
}

/// Returns a polygon, a triangle, a disc and a thin wall within reach of all arms of [`all_kinds`](crate::arms::all_kinds).
pub fn clutter() -> Vec<Convex> {
    vec![
        rectangle(0.7, 0.9, 0.4, 0.8),
        disc(Point::new(-0.5, 0.6), 0.15),
        wall(Point::new(-0.9, -0.4), Point::new(-0.3, -0.9)),
        convex(vec![Point::new(0.3, -0.9), Point::new(0.8, -0.7), Point::new(0.4, -0.5)], 0.0),
    ]
}

/// Returns small regular polygons with 4 to 7 corners on a spiral.
pub fn spiral(count: u8) -> Vec<Convex> {
    let polygon = |i: u8| {
        let (index, corners) = (f64::from(i), 4 + i % 4);
        let angle = 2.399_963 * index;
        let radius = 0.55 + 1.15 * ((index + 0.5) / f64::from(count)).sqrt();
        let center = Vector::new(radius * angle.cos(), radius * angle.sin());
        let corner = |k: u8| {
            let turn = 0.7 * index + std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            center + 0.08 * Vector::new(turn.cos(), turn.sin())
        };
        convex((0..corners).map(corner).collect(), 0.0)
    };
    (0..count).map(polygon).collect()
}

/// Returns W20, the benchmark for building configuration spaces: two bars on the torus among 20 polygons on a spiral.
pub fn w20() -> Scene {
    scene(rr([JointRange::Circle, JointRange::Circle]), spiral(20))
}

/// Draws a configuration within the ranges of the joints.
pub fn anywhere(dice: &mut Dice, arm: &Arm) -> Configuration {
    Configuration::from_fn(|k, _| {
        let (lower, upper) = arm.joints[k].range.domain();
        dice.within(lower, upper)
    })
}

/// Draws discs and walls at distances from `nearest` to `farthest` from the origin.
pub fn discs_and_walls(dice: &mut Dice, count: u64, [nearest, farthest]: [f64; 2]) -> Vec<Convex> {
    let mut piece = || {
        let (r, angle) = (dice.within(nearest, farthest), dice.within(-PI, PI));
        let at = Point::new(r * angle.cos(), r * angle.sin());
        let along = dice.within(-PI, PI);
        let end = at + Vector::new(along.cos(), along.sin()) * dice.within(0.1, 0.9);
        if dice.below(3) == 0 { disc(at, dice.within(0.02, 0.15)) } else { wall(at, end) }
    };
    (0..count).map(|_| piece()).collect()
}

/// Returns the configuration at these fractions `u` and `v` of the joints' ranges.
pub fn configuration_at_fractions(scene: &Scene, (u, v): (f64, f64)) -> Configuration {
    let at = |k: usize, t: f64| {
        let (lower, upper) = scene.arm().topology().ranges[k].domain();
        lower + t * (upper - lower)
    };
    q(at(0, u), at(1, v))
}
