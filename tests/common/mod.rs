//! Arms and scenes made in code, for tests and benchmarks.
#![allow(dead_code, reason = "every test and benchmark uses some of it")]

pub mod reference;
pub mod roadmap;
#[path = "../../crates/core/geometry/tests/oracles/shapes.rs"]
mod shapes;

#[allow(unused_imports, reason = "tests use it, benchmarks do not")]
pub use cplan_cases as random;
pub use cplan_cases::dice;
pub use shapes::{convex, disc, wall};

use cplan::check::{CollisionBox, Disconnection, ProofError};
use cplan::geometry::{Convex, Point, Vector};
use cplan::input::{self, Overrides};
use cplan::model::{
    Arm, Heights, Joint, JointType, Link, MotionProblem, Obstacle, OutlineSource, Part, Plane, Scene, Shape, Workspace,
};
use cplan::space::{Configuration, GoalSet, JointRange};
use nalgebra::Vector3;

pub fn q(a: f64, b: f64) -> Configuration {
    Configuration::new(a, b)
}

/// Checks the claim that boxes separate the start from all goals, and returns the verdict.
pub fn recheck(
    stuck: &[CollisionBox],
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
) -> Result<(), ProofError> {
    Disconnection::new(stuck.to_vec()).checked(scene, start, goals, clearance).map(drop)
}

/// Returns the rectangle `[x0, x1] x [y0, y1]`.
pub fn rectangle(x0: f64, x1: f64, y0: f64, y1: f64) -> Convex {
    convex(vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)], 0.0)
}

pub fn link(name: &str, shapes: Vec<Convex>) -> Link {
    let parts = shapes
        .into_iter()
        .map(|shape| Part {
            shape,
            inner: None,
            number: 0,
            is_visual: false,
            heights: Heights { lower: 0.0, upper: 0.1 },
            body: name.into(),
        })
        .collect();
    Link { name: name.into(), parts, source: OutlineSource::Collision }
}

pub fn joint(name: &str, joint_type: JointType, range: JointRange) -> Joint {
    Joint { name: name.into(), joint_type, range, velocity: 1.0, acceleration: 4.0, jerk: None }
}

pub fn arm(joints: [Joint; 2], links: [Link; 2], offset: Vector, tip: Point) -> Arm {
    Arm {
        name: "test arm".into(),
        joints,
        links,
        base: Point::zeros(),
        offset,
        tip,
        tip_name: "tip".into(),
        plane: Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() },
        dynamics: None,
        self_obstacles: Vec::new(),
    }
}

/// Returns an arm with two bars, 1.0 and 0.8 m long and 0.1 m wide. Its joints have the ranges `axes`.
pub fn rr(axes: [JointRange; 2]) -> Arm {
    let turn = JointType::Revolute { sign: 1.0 };
    arm(
        [joint("shoulder", turn, axes[0]), joint("elbow", turn, axes[1])],
        [link("upper", vec![rectangle(0.0, 1.0, -0.05, 0.05)]), link("fore", vec![rectangle(0.0, 0.8, -0.05, 0.05)])],
        Vector::new(1.0, 0.0),
        Point::new(0.8, 0.0),
    )
}

/// Returns one arm of every kind. Some axes are reversed or oblique, and outlines are beside the joints.
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

/// Returns a polygon, a triangle, a disc and a thin wall, within reach of all arms of [`all_kinds`].
pub fn clutter() -> Vec<Convex> {
    vec![
        rectangle(0.7, 0.9, 0.4, 0.8),
        disc(Point::new(-0.5, 0.6), 0.15),
        wall(Point::new(-0.9, -0.4), Point::new(-0.3, -0.9)),
        convex(vec![Point::new(0.3, -0.9), Point::new(0.8, -0.7), Point::new(0.4, -0.5)], 0.0),
    ]
}

pub fn obstacle(name: &str, piece: Convex) -> Obstacle {
    let shape = match piece.core() {
        [center] => Shape::Circle { center: *center, radius: piece.radius() },
        [a, b] => Shape::Polyline(vec![*a, *b]),
        corners => Shape::Polygon(corners.to_vec()),
    };
    Obstacle { name: name.into(), shape, pieces: vec![piece], heights: Heights::ALL }
}

/// Returns the scene of an arm in a workspace. Panics if either is invalid.
pub fn placed(arm: Arm, workspace: Workspace) -> Scene {
    Scene::new(arm, workspace).expect("a scene")
}

/// Returns the problem of a motion in a scene. Panics if it is invalid.
pub fn motion_problem(scene: Scene, start: Configuration, goals: impl Into<GoalSet>) -> MotionProblem {
    MotionProblem::new(scene, start, goals).expect("a problem")
}

pub fn scene(arm: Arm, pieces: Vec<Convex>) -> Scene {
    let obstacles = pieces.into_iter().enumerate().map(|(i, p)| obstacle(&format!("o{i}"), p)).collect();
    placed(arm, Workspace { name: "test".into(), obstacles, clearance: 0.0, preferences: Vec::new() })
}

/// The benchmark problems whose answers are published: a 2R arm on the torus among four polygons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Benchmark {
    /// A passage that is 0.070 rad wide; the optimum is 6.4229.
    A,
    /// A passage that is 0.022 rad wide; the optimum is 6.4281.
    B,
    /// Start and goal are proven to be disconnected.
    Inf,
    /// There is no path: two walls, which block link 1, are 0.0066 rad wide.
    T,
}

/// Returns scene, start and goal of a benchmark problem.
pub fn benchmark(which: Benchmark) -> (Scene, Configuration, Configuration) {
    let mut polygons = [
        vec![(-0.21, -0.85), (-0.03, -1.20), (0.22, -1.21), (0.44, -0.93), (0.27, -0.62), (-0.09, -0.65)],
        vec![(0.99, -0.17), (1.14, -0.35), (1.38, -0.27), (1.42, -0.16), (1.28, 0.07), (1.04, 0.0)],
        vec![(0.11, 1.33), (0.27, 1.12), (0.53, 1.19), (0.51, 1.51), (0.20, 1.53)],
        vec![(-1.02, 0.33), (-0.89, 0.12), (-0.63, 0.32), (-0.85, 0.51)],
    ];
    let shifted = match which {
        Benchmark::B => Some((0, 0.04)),
        Benchmark::T => Some((1, -0.0036)),
        _ => None,
    };
    if let Some((index, by)) = shifted {
        polygons[index].iter_mut().for_each(|p| p.0 += by);
    }
    let pieces = polygons.map(|p| convex(p.into_iter().map(|(x, y)| Point::new(x, y)).collect(), 0.0)).to_vec();
    let goal = if which == Benchmark::Inf { q(-2.8, 0.4) } else { q(1.75, 0.5) };
    (scene(rr([JointRange::Circle, JointRange::Circle]), pieces), q(-0.7, 0.0), goal)
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

/// Returns the benchmark for building configuration spaces, W20: two bars on the torus among 20 polygons on a spiral.
pub fn w20() -> Scene {
    scene(rr([JointRange::Circle, JointRange::Circle]), spiral(20))
}

/// Returns a benchmark problem for the solver.
pub fn problem(which: Benchmark) -> MotionProblem {
    let (scene, start, goal) = benchmark(which);
    motion_problem(scene, start, goal)
}

/// Returns the configuration at these fractions `u` and `v` of the joints' ranges.
pub fn configuration_at_fractions(scene: &Scene, (u, v): (f64, f64)) -> Configuration {
    let at = |k: usize, t: f64| {
        let (lower, upper) = scene.arm().topology().ranges[k].domain();
        lower + t * (upper - lower)
    };
    q(at(0, u), at(1, v))
}

/// Returns the name and problem of each shipped workspace that states that there is a path.
pub fn shipped_feasible() -> Vec<(String, MotionProblem)> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<_> =
        std::fs::read_dir(root.join("workspaces")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    let problems: Vec<_> = files
        .iter()
        .filter_map(|file| {
            let text = std::fs::read_to_string(file).unwrap();
            let line = |key: &str| text.lines().find_map(|l| l.strip_prefix(key).map(str::trim).map(str::to_owned));
            (line("# expect:")? == "found").then(|| {
                let urdf = root.join("robots").join(format!("{}.urdf", line("# robot:").unwrap()));
                let loaded = input::load(&urdf, file, &Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
                (file.file_stem().unwrap().to_str().unwrap().to_owned(), loaded.problem)
            })
        })
        .collect();
    assert!(problems.len() >= 15, "only {} feasible workspaces", problems.len());
    problems
}
