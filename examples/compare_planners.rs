//! Asks every planner the same question and prints what each one is good for.
//!
//! ```text
//! cargo run --release --example compare_planners -- robots/planar_2r.urdf workspaces/shelf.toml
//! ```

use cplan::engine::{Effort, Method, Verdict, solve};
use cplan::input::{self, Overrides};
use cplan::motion::{Limits, time};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1).map(PathBuf::from);
    let urdf = args.next().unwrap_or_else(|| "robots/planar_2r.urdf".into());
    let world = args.next().unwrap_or_else(|| "workspaces/shelf.toml".into());
    let problem = input::load(&urdf, &world, &Overrides::default())?.problem;

    for method in Method::ALL {
        let answer = solve(&problem, method, &Effort::default(), &mut |text| eprintln!("{text}"));
        match &answer.verdict {
            Verdict::Found(certified) => {
                let limits = Limits::from(&problem.scene().arm().joints);
                let trajectory = time(certified.clone(), &limits, 0.01)?.trajectory;
                println!(
                    "{method:<11} length {:.4}, proven clearance {:.4} m, motion {:.2} s; built in {:.1?}, asked in {:.1?}",
                    certified.path().length(),
                    certified.clearance(),
                    trajectory.duration(),
                    answer.stages.build,
                    answer.stages.query,
                );
            }
            Verdict::Infeasible(proof) => {
                println!("{method:<11} no path: {} stuck boxes separate start and goal", proof.stuck().len());
            }
            Verdict::Unknown(why) => println!("{method:<11} unknown: {why}"),
        }
    }
    Ok(())
}
