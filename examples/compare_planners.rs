//! Plans the same problem with every planner and compares the results.
//!
//! ```text
//! cargo run --release --example compare_planners -- robots/planar_2r.urdf workspaces/shelf.toml
//! ```

use cplan::engine::Method;
use cplan::{Options, Outcome, Problem, Refutation, plan};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1).map(PathBuf::from);
    let urdf = args.next().unwrap_or_else(|| "robots/planar_2r.urdf".into());
    let world = args.next().unwrap_or_else(|| "workspaces/shelf.toml".into());
    let problem = Problem::load(urdf, world)?;

    for method in Method::ALL {
        let plan = plan(&problem, &Options::from(method))?;
        match plan.outcome() {
            Outcome::Found(trajectory) => {
                println!(
                    "{method:<11} length {:.4}, proven clearance {:.4} m, motion {:.2} s",
                    plan.length().unwrap_or_default(),
                    plan.clearance().unwrap_or(f64::INFINITY),
                    trajectory.duration(),
                );
            }
            Outcome::Infeasible(Refutation::Motion(proof)) => {
                println!("{method:<11} no path: {} stuck boxes separate start and goal", proof.collision_boxes().len());
            }
            Outcome::Infeasible(Refutation::Step(failed)) => {
                println!("{method:<11} step {} cannot be done", failed.step.number);
            }
            Outcome::Unknown(why) => println!("{method:<11} unknown: {why}"),
        }
    }
    Ok(())
}
