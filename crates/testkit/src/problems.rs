//! Problems of motions: those of benchmarks and shipped ones. Also checks claims that there is no motion.

use crate::arms::rr;
use crate::scenes::{q, scene};
use crate::shapes::convex;
use crate::shipped;
use cplan::Problem;
use cplan::check::{CollisionBox, Disconnection, ProofError};
use cplan::geometry::Point;
use cplan::input::{self, InputError, LoadedScene, Overrides, Source};
use cplan::model::{MotionProblem, Scene};
use cplan::space::{Configuration, GoalSet, JointRange};

/// Returns the problem of a motion in a scene. Panics if it is invalid.
pub fn motion_problem(scene: Scene, start: Configuration, goals: impl Into<GoalSet>) -> MotionProblem {
    MotionProblem::new(scene, start, goals).expect("a problem")
}

/// Reads a robot and a world from texts.
///
/// # Errors
/// If a text is invalid.
pub fn scene_of_texts(urdf: &str, world: &str) -> Result<LoadedScene, InputError> {
    input::scene_from(Source::in_memory("arm.urdf", urdf), Source::in_memory("world.toml", world))
}

/// Reads a problem from texts.
///
/// # Errors
/// If a text is invalid, or the problem is.
pub fn problem_of_texts(urdf: &str, world: &str) -> Result<Problem, InputError> {
    Problem::of_scene(scene_of_texts(urdf, world)?, &Overrides::default())
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

/// The benchmark problems with published answers: a 2R arm on the torus among four polygons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Benchmark {
    /// A passage that is 0.070 rad wide; the optimum is 6.4229.
    A,
    /// A passage that is 0.022 rad wide; the optimum is 6.4281.
    B,
    /// Start and goal are proven to be disconnected.
    Inf,
    /// There is no path: two walls, 0.0066 rad wide, block link 1.
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

/// Returns a benchmark problem for the solver.
pub fn problem(which: Benchmark) -> MotionProblem {
    let (scene, start, goal) = benchmark(which);
    motion_problem(scene, start, goal)
}

/// Returns name and problem of each shipped workspace that is stated to have a path.
pub fn shipped_feasible() -> Vec<(String, MotionProblem)> {
    let feasible = shipped::worlds("").into_iter().filter(|world| world.expect == "found");
    let problems: Vec<_> = feasible.map(|world| (world.name.clone(), world.motion())).collect();
    assert!(problems.len() >= 15, "only {} feasible workspaces", problems.len());
    problems
}
