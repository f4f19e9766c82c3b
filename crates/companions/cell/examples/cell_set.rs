//! Writes a set of a hundred cells and their answers to a folder: `cargo run --release -p cplan-cell --example cell_set -- FOLDER`.
//! The set is the same in every run. `workspaces/cells/answers.csv` has the answers, too.

use cplan_cases::cells::{CellCase, ROBOTS, cell_set};
use cplan_cell::{Cell, CellPlan, Refutation, Settings, plan_cell};
use cplan_model::Outcome;
use cplan_robot::Source;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Head of the table of answers.
const HEAD: &str = "cell,kind,answer,proof,blocked,cycle [s],bound [s]\n";

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("the folder is missing")?);
    std::fs::create_dir_all(folder.join("robots"))?;
    let robots = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../robots"));
    for robot in ROBOTS {
        std::fs::copy(robots.join(robot), folder.join("robots").join(robot))?;
    }
    let mut answers = HEAD.to_owned();
    for case in cell_set("robots") {
        let path = folder.join(format!("{}.toml", case.name));
        std::fs::write(&path, &case.text)?;
        let cell = Cell::load(&Source::read(&path)?, &Source::read, None)?;
        let plan = plan_cell(&cell, &Settings::default(), &mut |_| ())?;
        let row = row(&case, &plan);
        print!("{row}");
        answers += &row;
    }
    std::fs::write(folder.join("answers.csv"), answers)?;
    Ok(())
}

fn row(case: &CellCase, plan: &CellPlan) -> String {
    let proof = match &plan.outcome {
        Outcome::Infeasible(Refutation::Alone { .. } | Refutation::Step { .. }) => "alone",
        Outcome::Infeasible(Refutation::Starts { .. }) => "starts",
        Outcome::Infeasible(Refutation::Goals { .. }) => "goals",
        Outcome::Infeasible(Refutation::Boxes(_)) => "boxes",
        Outcome::Found(_) | Outcome::Unknown(_) => "",
    };
    let is_blocked = plan.tried.first().is_some_and(|first| first.contains("deadlock"));
    let seconds = |seconds: Option<f64>| seconds.map(|seconds| format!("{seconds:.3}")).unwrap_or_default();
    format!(
        "{},{},{},{proof},{},{},{}\n",
        case.name,
        case.kind,
        plan.status().name(),
        if is_blocked { "yes" } else { "" },
        seconds(plan.outcome.found().map(|found| found.duration)),
        seconds(plan.outcome.found().and(plan.lower_bound))
    )
}
