//! Two revolute joints for oxmpl: the torus with the Euclidean metric, and a collision check by parry2d.

use crate::Result;
use crate::scenes::{self, Bars};
use oxmpl::base::error::StateSamplingError;
use oxmpl::base::goal::{Goal, GoalRegion, GoalSampleableRegion};
use oxmpl::base::space::StateSpace;
use oxmpl::base::state::State;
use oxmpl::base::validity::StateValidityChecker;
use parry2d_f64::math::{Pose, Rotation, Vector};
use parry2d_f64::query::details::intersection_test_support_map_support_map as meet;
use parry2d_f64::shape::ConvexPolygon;
use rand::{Rng, RngExt};
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// Joint values, radians.
#[derive(Debug, Clone, Copy)]
pub struct Joints(pub [f64; 2]);

impl State for Joints {}

/// The set of all pairs of angles.
pub struct Torus;

/// Returns the angle in `[-pi, pi)`.
fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

impl StateSpace for Torus {
    type StateType = Joints;

    fn distance(&self, a: &Joints, b: &Joints) -> f64 {
        wrapped(a.0[0] - b.0[0]).hypot(wrapped(a.0[1] - b.0[1]))
    }

    fn interpolate(&self, from: &Joints, to: &Joints, t: f64, out: &mut Joints) {
        out.0 = [0, 1].map(|k| wrapped(from.0[k] + t * wrapped(to.0[k] - from.0[k])));
    }

    fn enforce_bounds(&self, state: &mut Joints) {
        state.0 = state.0.map(wrapped);
    }

    fn satisfies_bounds(&self, state: &Joints) -> bool {
        state.0.iter().all(|angle| (-PI..=PI).contains(angle))
    }

    fn sample_uniform(&self, rng: &mut impl Rng) -> std::result::Result<Joints, StateSamplingError> {
        Ok(Joints([0, 1].map(|_| rng.random_range(-PI..PI))))
    }

    /// Returns a length of which oxmpl takes a tenth as the step between collision checks. With this value, it checks
    /// every 0.01 rad.
    fn get_longest_valid_segment_length(&self) -> f64 {
        0.1
    }
}

/// A goal of exactly one configuration.
pub struct Target(pub Joints);

impl Goal<Joints> for Target {
    fn is_satisfied(&self, state: &Joints) -> bool {
        self.distance_goal(state) <= 1e-12
    }
}

impl GoalRegion<Joints> for Target {
    fn distance_goal(&self, state: &Joints) -> f64 {
        Torus.distance(state, &self.0)
    }
}

impl GoalSampleableRegion<Joints> for Target {
    fn sample_goal(&self, _: &mut impl Rng) -> std::result::Result<Joints, StateSamplingError> {
        Ok(self.0)
    }
}

/// A polygon, and a disc that contains it.
struct Solid {
    shape: ConvexPolygon,
    center: Vector,
    radius: f64,
}

impl Solid {
    fn new(corners: &[[f64; 2]]) -> Self {
        let points: Vec<Vector> = corners.iter().map(|p| Vector::new(p[0], p[1])).collect();
        let center = points.iter().sum::<Vector>() / points.len() as f64;
        let radius = points.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        let shape = ConvexPolygon::from_convex_polyline_unmodified(points).expect("obstacles and links have an area");
        Self { shape, center, radius }
    }

    fn hits(&self, pose: &Pose, obstacle: &Solid) -> bool {
        let reach = self.radius + obstacle.radius;
        pose.transform_point(self.center).distance_squared(obstacle.center) <= reach * reach
            && meet(&pose.inverse(), &self.shape, &obstacle.shape)
    }
}

/// The collision checker for the peer's planners.
pub struct Checker {
    links: [Solid; 2],
    elbow: f64,
    obstacles: Vec<Solid>,
}

impl Checker {
    pub fn new(bars: &Bars, obstacles: &[Vec<[f64; 2]>]) -> Self {
        Self {
            links: [Solid::new(&bars.links[0]), Solid::new(&bars.links[1])],
            elbow: bars.elbow,
            obstacles: obstacles.iter().map(|corners| Solid::new(corners)).collect(),
        }
    }

    /// Returns true if the arm touches an obstacle at a configuration.
    pub fn collides(&self, [q1, q2]: [f64; 2]) -> bool {
        let first = Pose::from_parts(Vector::ZERO, Rotation { re: q1.cos(), im: q1.sin() });
        let elbow = first.transform_point(Vector::new(self.elbow, 0.0));
        let second = Pose::from_parts(elbow, Rotation { re: (q1 + q2).cos(), im: (q1 + q2).sin() });
        self.obstacles.iter().any(|o| self.links[0].hits(&first, o) || self.links[1].hits(&second, o))
    }
}

impl StateValidityChecker<Joints> for Checker {
    fn is_valid(&self, state: &Joints) -> bool {
        !self.collides(state.0)
    }
}

/// Reads configurations from standard input, and prints the checker's verdicts. This is for the harness's test of its
/// checkers.
pub fn answer_standard_input(urdf: &str, world: &str) -> Result<Value> {
    let scene = scenes::scene(urdf, world)?;
    let checker = Checker::new(&scenes::bars(&scene)?, &scenes::obstacles(&scene));
    let text = std::io::read_to_string(std::io::stdin())?;
    let numbers = text.split_whitespace().map(str::parse).collect::<std::result::Result<Vec<f64>, _>>()?;
    Ok(json!(numbers.chunks_exact(2).map(|q| checker.collides([q[0], q[1]])).collect::<Vec<_>>()))
}
