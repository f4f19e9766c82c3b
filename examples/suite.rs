//! Draws the suite of problems, solves it, has every certificate checked, and writes all into a folder
//! (docs/suite.md).
//!
//! ```text
//! cargo run --release --example suite -- FOLDER [FOUND INFEASIBLE]
//! ```
//!
//! The two numbers are those of problems for each kind of arm and of world, with a path and without one.

use cplan::PlanOutput as _;
use cplan_check_files::check;
use cplan_testkit::suite::{QUOTAS, Rejection, classes, draws};
use std::error::Error;
use std::fs::{create_dir_all, write};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = PathBuf::from(arguments.first().ok_or("usage: suite FOLDER [FOUND INFEASIBLE]")?);
    let quotas = match &arguments[1..] {
        [found, infeasible] => [found.parse()?, infeasible.parse()?],
        _ => QUOTAS,
    };
    for name in ["robots", "worlds", "certificates", "pictures"] {
        create_dir_all(folder.join(name))?;
    }
    let (mut lines, mut listed) = (String::new(), "name = \"suite\"\n".to_owned());
    for (kind, world) in classes() {
        let (mut count, mut rejections) = (0, Vec::new());
        for answered in draws(kind, world, quotas) {
            let answered = match answered {
                Ok(answered) => answered,
                Err(rejection) => {
                    rejections.push(rejection);
                    continue;
                }
            };
            let (problem, id) = (&answered.problem, answered.problem.id());
            let (urdf, world) = (problem.urdf(), problem.toml(true));
            check(&urdf, &world, &answered.certificate).map_err(|error| format!("{id}: {error}"))?;
            write(folder.join(format!("robots/{id}.urdf")), urdf)?;
            write(folder.join(format!("worlds/{id}.toml")), world)?;
            write(folder.join(format!("certificates/{id}.json")), &answered.certificate)?;
            if count == 0 {
                write(folder.join(format!("pictures/{id}.svg")), answered.plan.svg())?;
            }
            lines += &format!("{}\n", answered.json());
            listed += &format!("\n[[problem]]\nrobot = \"robots/{id}.urdf\"\nworld = \"worlds/{id}.toml\"\n");
            count += 1;
        }
        let rejected = |reason| rejections.iter().filter(|rejection| **rejection == reason).count();
        println!(
            "{kind} {world}: {count} problems; rejected: {} easy, {} unknown, {} with a weak bound, {} beyond the quota",
            rejected(Rejection::Easy),
            rejected(Rejection::Unknown),
            rejected(Rejection::WeakBound),
            rejected(Rejection::Full),
        );
    }
    write(folder.join("suite.schema.json"), include_str!("../docs/suite.schema.json"))?;
    write(folder.join("suite.jsonl"), lines)?;
    write(folder.join("suite.toml"), listed)?;
    Ok(())
}
