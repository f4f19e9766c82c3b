//! One run of a planner of oxmpl.

use crate::torus::{Checker, Joints, Target, Torus};
use crate::{Result, scenes};
use oxmpl::base::planner::{Planner, PlannerConfig};
use oxmpl::base::problem_definition::ProblemDefinition;
use oxmpl::geometric::{RRT, RRTConnect, RRTStar};
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Greatest length of a branch. As by default in OMPL, it is a fifth of the greatest distance on the torus.
const BRANCH: f64 = 0.89;

/// Fraction of samples that are the goal itself. It is OMPL's default.
const GOAL_BIAS: f64 = 0.05;

pub fn run(urdf: &str, world: &str, planner: &str, seed: u64, limit: f64) -> Result<Value> {
    let config = PlannerConfig { seed: Some(seed) };
    let mut planner: Box<dyn Planner<Joints, Torus, Target>> = match planner {
        "RRT" => Box::new(RRT::new(BRANCH, GOAL_BIAS, &config)),
        "RRTConnect" => Box::new(RRTConnect::new(BRANCH, GOAL_BIAS, &config)),
        "RRT*" => Box::new(RRTStar::new(BRANCH, GOAL_BIAS, BRANCH, &config)),
        other => return Err(format!("{other} is no planner of oxmpl that runs here").into()),
    };
    let problem = scenes::problem(urdf, world)?;
    let joints = |q: cplan::space::Configuration| Joints([q[0], q[1]]);
    let (bars, obstacles) = (scenes::bars(problem.scene())?, scenes::obstacles(problem.scene()));
    let definition = Arc::new(ProblemDefinition {
        space: Arc::new(Torus),
        start_states: vec![joints(problem.start())],
        goal: Arc::new(Target(joints(problem.goals().points().next().expect("a single goal")))),
    });
    let checker = Arc::new(Checker::new(&bars, &obstacles));
    let start = Instant::now();
    planner.setup(definition, checker);
    let answer = planner.solve(Duration::from_secs_f64(limit));
    let ms = start.elapsed().as_secs_f64() * 1e3;
    Ok(match answer {
        Ok(path) => json!({"status": "found", "ms": ms, "path": path.0.iter().map(|q| q.0).collect::<Vec<_>>()}),
        Err(error) => json!({"status": error.to_string(), "ms": ms}),
    })
}
